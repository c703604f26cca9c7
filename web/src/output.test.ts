// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it, vi } from "vitest";
import { isPacked, misreadOutput, outputOf, queryOf, usualOutput } from "./output";

describe("the picture that an address names", () => {
  it("is the first canvas where nothing is said", () => {
    expect(outputOf("")).toEqual(usualOutput);
    expect(queryOf(usualOutput)).toBe("");
  });

  it("is the first in browsers that do not say how many fields a query has, too", () => {
    const size = vi.spyOn(URLSearchParams.prototype, "size", "get");
    size.mockReturnValue(undefined as never);
    expect(queryOf(usualOutput)).toBe("");
    size.mockRestore();
  });

  it("comes back from its own query, whatever the names", () => {
    const output = {
      canvas: "Wand & Tür",
      segment: "links=1",
      eye: "right",
      stereo: "side-by-side",
    } as const;
    expect(outputOf(queryOf(output))).toEqual(output);
  });

  it("leaves alone what else the address says", () => {
    const before = "?session=review&eye=left";
    expect(queryOf(usualOutput, before)).toBe("?session=review");
    expect(queryOf({ ...usualOutput, eye: "right" }, before)).toBe("?session=review&eye=right");
  });

  it("leaves out what it does not understand, and says so", () => {
    expect(outputOf("?eye=third&stereo=quad&segment=a")).toEqual({ ...usualOutput, segment: "a" });
    expect(misreadOutput("?eye=left&stereo=anaglyph&segment=a")).toBe("");
    expect(misreadOutput("?eye=Left")).toBe(
      "The address says eye=Left, which is none of cyclop, left, right",
    );
    expect(misreadOutput("?stereo=quad")).toContain("side-by-side");
  });

  it("is of two eyes where it shows both, one beside the other", () => {
    expect(isPacked({ ...usualOutput, stereo: "side-by-side" })).toBe(true);
    expect(isPacked({ ...usualOutput, stereo: "top-bottom" })).toBe(true);
    expect(isPacked({ ...usualOutput, stereo: "side-by-side", eye: "left" })).toBe(false);
    expect(isPacked({ ...usualOutput, stereo: "anaglyph" })).toBe(false);
  });
});
