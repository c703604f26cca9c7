// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { changeOf, fields, modes, reportText } from "../panel/equalizers";
import { compoundsOf } from "./configuration";

const fieldOf = (key: string) => fields.find((field) => field.key === key) ?? fields[0]!;

describe("a configuration", () => {
  const answer = {
    configuration: {
      compounds: [
        {
          channel: { destination: { layout: { name: "2D" }, view: { index: 0 } } },
          equalizers: [{ load: { damping: 0.25 } }, { framerate: {} }],
          compounds: [
            { viewport: [0, 0, 0.5, 1], equalizers: [{ dfr: { framerate: 20 } }] },
            { name: "right", range: [0.25, 1 / 3] },
          ],
        },
        { equalizers: [{ tile: { size: [32, 32] } }], period: 2, phase: 1 },
      ],
    },
    state: {
      equalizers: [
        { on: true, frozen: false, damping: 0.75 },
        { equalizer: 2, on: false, frozen: true },
      ],
    },
    equalizers: [{ imbalance: 1.125 }, { framesPerSecond: 42 }, { framesPerSecond: 19, zoom: 0.7 }],
  };

  it("is trees of compounds, whose equalizers count from parents to children", () => {
    const [first, second] = compoundsOf(answer);
    expect(first?.name).toBe("2D");
    expect(first?.equalizers.map(({ kind, position }) => [kind, position])).toEqual([
      ["load", 0],
      ["framerate", 1],
    ]);
    expect(first?.compounds.map(({ name, share }) => [name, share])).toEqual([
      ["compound", "viewport 0 0 0.5 1"],
      ["right", "range 0.25 0.333"],
    ]);
    expect(first?.compounds[0]?.equalizers[0]).toEqual({
      position: 2,
      kind: "dfr",
      isOn: false,
      isFrozen: true,
      settings: { framerate: 20 },
      report: { framesPerSecond: 19, zoom: 0.7 },
    });
    expect(second?.share).toBe("frames 1 of 2");
    expect(second?.equalizers[0]).toMatchObject({ position: 3, settings: { tileSize: [32, 32] } });
  });

  it("has what was changed in the place of what was written", () => {
    expect(compoundsOf(answer)[0]?.equalizers[0]?.settings).toEqual({ damping: 0.75 });
  });

  it("says what its equalizers have come to", () => {
    const [load, framerate] = compoundsOf(answer)[0]!.equalizers;
    expect(reportText(load!)).toBe("the longest takes 1.13 times the mean");
    expect(reportText(framerate!)).toBe("at most 42.0 frames a second");
    expect(reportText({ kind: "dfr", report: { framesPerSecond: 19, zoom: 0.7 } })).toBe(
      "19.0 frames a second · 0.70 of the pixels of a side",
    );
    expect(reportText({ kind: "tile", report: {} })).toBe("");
  });

  it("may have nothing", () => {
    expect(compoundsOf({})).toEqual([]);
  });
});

describe("what is typed for an equalizer", () => {
  it("is a number, or two", () => {
    expect(changeOf(fieldOf("damping"), " 0.25 ")).toEqual({ damping: 0.25 });
    expect(changeOf(fieldOf("boundary"), "8, 16")).toEqual({ boundary: [8, 16] });
  });

  it("is otherwise refused, saying what is wanted", () => {
    for (const [key, text] of [
      ["damping", ""],
      ["damping", "1 2"],
      ["damping", "fast"],
      ["tileSize", "64"],
      ["tileSize", "64 NaN"],
    ] as const)
      expect(changeOf(fieldOf(key), text)).toContain(fieldOf(key).name);
  });
});

describe("the settings of equalizers", () => {
  it("call stripes by how they lie beside each other", () => {
    const names = new Map<string, string>(modes);
    expect(names.get("SPLIT_MODE_HORIZONTAL")).toBe("One above another");
    expect(names.get("SPLIT_MODE_VERTICAL")).toBe("Side by side");
  });

  it("say of each kind what damping does to it", () => {
    const titleFor = (kind: "load" | "tree" | "dfr") =>
      fields.find(({ key, kinds }) => key === "damping" && kinds.includes(kind))?.title;
    expect(titleFor("load")).toContain("How little");
    expect(titleFor("tree")).toBe(titleFor("load"));
    expect(titleFor("dfr")).toContain("1 all");
  });
});
