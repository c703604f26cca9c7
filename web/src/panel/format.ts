// SPDX-License-Identifier: Apache-2.0

/** 1740000 as "1.74 M": three digits, whatever the size. */
export function count(value: number): string {
  const units = ["", " k", " M", " G", " T"];
  let unit = 0;
  while (value >= 999.5 && unit < units.length - 1) {
    value /= 1000;
    unit += 1;
  }
  return `${unit === 0 ? String(Math.round(value)) : value.toPrecision(3)}${units[unit] ?? ""}`;
}

/** What is left out of sight when numbers are rounded up. */
const sameAs = 1 - 1e-6;

/** Pixels of error with two digits after the point where they matter, rounded up as bounds are. */
export function pixels(value: number): string {
  if (!Number.isFinite(value)) return "∞ px";
  const hundredths = Math.ceil(value * 100 * sameAs);
  return `${hundredths >= 1000 ? (Math.ceil(value * 10 * sameAs) / 10).toFixed(1) : (hundredths / 100).toFixed(2)} px`;
}

/** Of half a turn at most: "7.5°", "27°"; rounded up as bounds are. */
export function degrees(value: number): string {
  const tenths = Math.ceil(value * 10 * sameAs);
  return `${tenths >= 100 ? Math.ceil(value * sameAs) : (tenths / 10).toFixed(1)}°`;
}

export function milliseconds(value: number): string {
  if (Number.isNaN(value)) return "–";
  return `${value >= 9.95 ? value.toFixed(0) : value.toFixed(1)} ms`;
}

/** "llvmpipe" of "llvmpipe (LLVM 15.0.6, 256 bits)": what people call the device. */
export function deviceName(renderer: string): string {
  return (
    renderer
      .replace(/\(.*$/, "")
      .replace(/\/PCIe.*$/, "")
      .trim() || "unknown device"
  );
}

/** "1 renderer", "2 renderers". */
export function plural(number: number, word: string): string {
  return `${number} ${word}${number === 1 ? "" : "s"}`;
}

/** "250 m", "1 km". */
export function metres(value: number): string {
  return value >= 1000 ? `${value / 1000} km` : `${value} m`;
}

/** Sizes and names, the largest first. */
type Units = readonly (readonly [number, string])[];

const lengthUnits: Units = [
  [1000, "km"],
  [1, "m"],
  [1e-3, "mm"],
  [1e-6, "µm"],
  [1e-9, "nm"],
];

const areaUnits: Units = [
  [1e6, "km²"],
  [1, "m²"],
  [1e-6, "mm²"],
  [1e-12, "µm²"],
];

/** The one that people would use: 999.6 m is 1 km, not 1.00e+3 m. */
const unitOf = (size: number, units: Units): readonly [number, string] =>
  units.find(([one]) => size >= one * 0.9995) ?? (units[units.length - 1] as Units[number]);

function textIn(units: Units, value: number, plus = ""): string {
  const [unit, name] = unitOf(Math.abs(value), units);
  const digits = Number((Math.abs(value) / unit).toPrecision(3));
  return `${value < 0 ? "−" : plus}${digits} ${name}`;
}

/** Metres in the unit that people would use, to three digits: "2.5 mm", "1.23 km". */
export const lengthText = (value: number, plus = ""): string => textIn(lengthUnits, value, plus);

/** No less than `value`, which may be below 0, in three digits. */
export function roundedUp(value: number): number {
  if (value === 0 || !Number.isFinite(value)) return value;
  const step = 10 ** (Math.floor(Math.log10(Math.abs(value))) - 2);
  const slack = Math.abs(value / step) * 1e-12; // 0.7 is 700 thousandths, not 701
  return Number((Math.ceil(value / step - slack) * step).toPrecision(3));
}

/** The longest that something may be: "500 mm" of 0.4998. */
export const lengthAtMost = (value: number, plus = ""): string =>
  lengthText(roundedUp(value), plus);

/** How many digits after the point an error leaves, 9 at most: the last is a tenth of it or less. */
export const digitsOf = (error: number): number =>
  error > 0 ? Math.min(9, Math.max(0, Math.ceil(1 - Math.log10(error)))) : 6;

export const coordinate = (value: number, error: number): string => value.toFixed(digitsOf(error));

/** How far what is written is from `value`. */
export const lostOf = (written: string, value: number): number => Math.abs(Number(written) - value);

function withError(value: number, error: number, units: Units): string {
  // Of nothing, give or take nothing, the unit is the one that all others are of.
  const size = Math.max(Math.abs(value), error) || 1;
  const [unit, name] = unitOf(size, units);
  const text = coordinate(value / unit, error / unit);
  const off = roundedUp(error + unit * lostOf(text, value / unit));
  return `${Number(text) < 0 ? "−" : ""}${text.replace("-", "")} ${name} ± ${textIn(units, off)}`;
}

/** "12.346 m ± 5.2 mm", which holds of what is written, too. */
export const lengthWithError = (value: number, error: number): string =>
  withError(value, error, lengthUnits);

export const areaWithError = (value: number, error: number): string =>
  withError(value, error, areaUnits);

/** A factor: "× 2.5", "× 10", "true" for 1. */
export function times(factor: number): string {
  if (Math.abs(factor - 1) < 1e-9) return "true";
  return `× ${factor >= 9.95 ? factor.toFixed(0) : factor.toFixed(factor < 0.995 ? 2 : 1)}`;
}
