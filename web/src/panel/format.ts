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

/** Pixels of error with two digits after the point where they matter. */
export function pixels(value: number): string {
  if (!Number.isFinite(value)) return "∞ px";
  return `${value >= 9.995 ? value.toFixed(1) : value.toFixed(2)} px`;
}

/** Of half a turn at most: "7.5°", "27°". */
export function degrees(value: number): string {
  return `${value >= 9.95 ? value.toFixed(0) : value.toFixed(1)}°`;
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

/** Metres in the unit that people would use, to three digits: "2.5 mm", "1.23 km". */
export function lengthText(value: number, plus = ""): string {
  const units = [
    [1000, "km"],
    [1, "m"],
    [1e-3, "mm"],
    [1e-6, "µm"],
    [1e-9, "nm"],
  ] as const;
  const size = Math.abs(value);
  // 999.6 m is 1 km, not 1.00e+3 m.
  const [unit, name] = units.find(([one]) => size >= one * 0.9995) ?? ([1e-9, "nm"] as const);
  const digits = Number((size / unit).toPrecision(3));
  return `${value < 0 ? "−" : plus}${digits} ${name}`;
}

/** As many digits after the point as an error leaves, 6 at most. */
export function coordinate(value: number, error: number): string {
  const digits = error > 0 ? Math.ceil(-Math.log10(error)) : 6;
  return value.toFixed(Math.min(6, Math.max(0, digits)));
}

/** A factor: "× 2.5", "× 10", "true" for 1. */
export function times(factor: number): string {
  if (Math.abs(factor - 1) < 1e-9) return "true";
  return `× ${factor >= 9.95 ? factor.toFixed(0) : factor.toFixed(factor < 0.995 ? 2 : 1)}`;
}
