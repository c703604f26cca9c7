// SPDX-License-Identifier: Apache-2.0
// Small charts as SVG: drawn anew from a few numbers, without a library.

const namespace = "http://www.w3.org/2000/svg";

export const chartWidth = 264;
export const chartHeight = 64;

export function svg<K extends keyof SVGElementTagNameMap>(
  tag: K,
  attributes: Readonly<Record<string, string | number>>,
): SVGElementTagNameMap[K] {
  const element = document.createElementNS(namespace, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  return element;
}

/** From numbers to a chart's units, `low` at 0; a range without width is in the middle. */
export function axis(low: number, high: number, size: number): (value: number) => number {
  const width = high - low;
  return (value) => (width !== 0 ? ((value - low) / width) * size : size / 2);
}

/** The same by orders of magnitude; what is beyond an end, such as infinity, is at that end. */
export function logAxis(low: number, high: number, size: number): (value: number) => number {
  const linear = axis(Math.log(low), Math.log(high), size);
  return (value) => linear(Math.log(Math.min(Math.max(value, low), high)));
}

/** "M0,1L2,3" of points, with tenths of a unit. */
export function pathOf(points: readonly (readonly [number, number])[]): string {
  return points
    .map(([x, y], i) => `${i === 0 ? "M" : "L"}${x.toFixed(1)},${y.toFixed(1)}`)
    .join("");
}

/** The area between two lines of the same places. */
export function bandOf(
  upper: readonly (readonly [number, number])[],
  lower: readonly (readonly [number, number])[],
): string {
  return `${pathOf(upper)}${pathOf([...lower].reverse()).replace("M", "L")}Z`;
}

/** The largest of a list, and at least `least`. */
export const largest = (values: Iterable<number>, least: number): number => {
  let most = least;
  for (const value of values) if (Number.isFinite(value)) most = Math.max(most, value);
  return most;
};
