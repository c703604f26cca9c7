// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { directionOfView, standardCamera } from "../camera/standard";
import { objectLook, withHidden, withObjectLook } from "../look";
import { PartStatisticsSchema } from "../protocol/gen/eyrie/v1/statistics_pb";
import { ObjectStateSchema } from "../protocol/gen/eyrie/v1/viewer_pb";
import { ObjectKind, Shading } from "../protocol/messages";
import { hasPlaces, hasRanges, rangeColour, sharesOf } from "./renderers";
import { alone, objectText } from "./objects";
import { azimuthPlace, azimuthText } from "./scene";

describe("objects of a scene", () => {
  it("are hidden and shown one by one, in order", () => {
    expect(withHidden([3], 1, true)).toEqual([1, 3]);
    expect(withHidden([1, 3], 1, true)).toEqual([1, 3]);
    expect(withHidden([1, 3], 3, false)).toEqual([1]);
    expect(withHidden([], 3, false)).toEqual([]);
  });

  it("are shown alone, and all again", () => {
    expect(alone([], 1, 3)).toEqual([0, 2]);
    expect(alone([0, 2], 1, 3)).toEqual([]);
    expect(alone([0, 2], 0, 3)).toEqual([1, 2]);
    expect(alone([0, 1, 2], 1, 3)).toEqual([0, 2]);
  });

  it("have looks of their own while these say anything", () => {
    const red = { object: 2, colour: [1, 0, 0], shading: null } as const;
    const flat = { object: 0, colour: null, shading: Shading.FLAT } as const;
    const both = withObjectLook(withObjectLook([], red), flat);
    expect(both).toEqual([flat, red]);
    expect(objectLook(both, 2)).toEqual(red);
    expect(objectLook(both, 1)).toEqual({ object: 1, colour: null, shading: null });
    expect(withObjectLook(both, { ...red, colour: null })).toEqual([flat]);
  });

  it("say what they are", () => {
    const hill = create(ObjectStateSchema, { kind: ObjectKind.TERRAIN, triangles: 1_740_000n });
    expect(objectText(hill)).toBe("Terrain · 1.74 M triangles");
    expect(objectText(undefined)).toBe("");
  });

  it("come into view from where one looks", () => {
    const from = { azimuth: 30, elevation: 20 };
    const camera = standardCamera(from, { min: [0, 0, 0], max: [9, 9, 2] }, 1.5, 45);
    const { azimuth, elevation } = directionOfView(camera);
    expect([azimuth, elevation]).toEqual([expect.closeTo(30), expect.closeTo(20)]);
  });
});

describe("the sun", () => {
  it("stands where a compass says", () => {
    expect([0, 90, 315, 350, 360, -90].map(azimuthText)).toEqual([
      "0° N",
      "90° E",
      "315° NW",
      "350° N",
      "0° N",
      "270° W",
    ]);
  });
});

describe("who drew what", () => {
  const part = (by: object) =>
    create(PartStatisticsSchema, { width: 1, height: 1, rangeEnd: 1, ...by });

  it("is told by renderer, whose parts add up", () => {
    const shares = sharesOf([
      part({ renderer: "b", width: 0.5, milliseconds: 4, triangles: 10n }),
      part({ renderer: "a", left: 0.5, width: 0.25, milliseconds: 3, triangles: 5n }),
      part({ renderer: "a", left: 0.75, width: 0.25, milliseconds: 2, triangles: 6n }),
    ]);
    expect(
      shares.map(({ renderer, milliseconds, triangles }) => [renderer, milliseconds, triangles]),
    ).toEqual([
      ["a", 5, 11],
      ["b", 4, 10],
    ]);
    expect(new Set(shares.map(({ colour }) => colour)).size).toBe(2);
  });

  it("is cut by data or by place", () => {
    const byData = [part({ rangeEnd: 0.5 }), part({ rangeBegin: 0.5 })];
    const byPlace = [part({ width: 0.5 }), part({ left: 0.5, width: 0.5 })];
    expect([hasRanges(byData), hasPlaces(byData)]).toEqual([true, false]);
    expect([hasRanges(byPlace), hasPlaces(byPlace)]).toEqual([false, true]);
    expect([hasRanges([]), hasPlaces([])]).toEqual([false, false]);
    expect(sharesOf(byData)[0]?.colour).toBe(rangeColour(0, 0.5));
  });

  it("has the engine's colours", () => {
    // As rangeColour() of renderer/draw/tint.cpp comes out on the screen.
    expect(rangeColour(0, 0.5)).toBe("rgb(140 52 229)");
  });
});

describe("the sun's slider", () => {
  it("shows directions counted the other way, too", () => {
    expect([-360, -45, 0, 315, 360].map(azimuthPlace)).toEqual([0, 315, 0, 315, 360]);
  });
});
