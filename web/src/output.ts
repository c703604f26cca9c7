// SPDX-License-Identifier: Apache-2.0
// Which picture of the configuration the page shows, as the query of its address:
// "?canvas=wall&segment=left&eye=right". Each screen of a wall has an address of its own.

export type Eye = "" | "cyclop" | "left" | "right";
export type Stereo = "" | "anaglyph" | "side-by-side" | "top-bottom";

export interface Output {
  /** Names, or positions from 0 on. "": the first. */
  canvas: string;
  /** "": the whole canvas. */
  segment: string;
  /** "": what the view shows. */
  eye: Eye;
  /** How two eyes are put into one picture; "": as configured. */
  stereo: Stereo;
}

/** Two eyes in one picture, which so has twice the width or the height of the view. */
export const isPacked = ({ eye, stereo }: Output): boolean =>
  eye === "" && (stereo === "side-by-side" || stereo === "top-bottom");

export const usualOutput: Output = { canvas: "", segment: "", eye: "", stereo: "" };

const eyes: readonly Eye[] = ["cyclop", "left", "right"];
const stereos: readonly Stereo[] = ["anaglyph", "side-by-side", "top-bottom"];

/** What is not understood is as usual; misreadOutput says so. */
export function outputOf(query: string): Output {
  const fields = new URLSearchParams(query);
  const one = <T extends string>(name: string, known: readonly T[]): T | "" =>
    known.find((value) => value === fields.get(name)) ?? "";
  return {
    canvas: fields.get("canvas") ?? "",
    segment: fields.get("segment") ?? "",
    eye: one("eye", eyes),
    stereo: one("stereo", stereos),
  };
}

/** What of the query names no eye or stereo, for the user to read; "" where all is understood. */
export function misreadOutput(query: string): string {
  const fields = new URLSearchParams(query);
  const other = (name: string, known: readonly string[]): string => {
    const value = fields.get(name) ?? "";
    return value === "" || known.includes(value)
      ? ""
      : `The address says ${name}=${value}, which is none of ${known.join(", ")}`;
  };
  return other("eye", eyes) || other("stereo", stereos);
}

/** With its "?", and with what else `before` says; "" where all is as usual. */
export function queryOf(output: Output, before = ""): string {
  const fields = new URLSearchParams(before);
  for (const [name, value] of Object.entries(output)) {
    if (value === "") fields.delete(name);
    else fields.set(name, value as string);
  }
  const text = fields.toString(); // its size is not known before Chrome 113 and Safari 17
  return text === "" ? "" : `?${text}`;
}
