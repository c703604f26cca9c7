// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { project } from "./camera/camera";
import { groundHeights, homeOf, objectBounds, wholeBounds } from "./drawn_bounds";
import { SessionStateSchema } from "./protocol/gen/eyrie/v1/viewer_pb";

const box = (low: number, high: number) => ({
  min: { x: 0, y: 0, z: low },
  max: { x: 20_000, y: 20_000, z: high },
});
const heights = (low: number, high: number) => ({ min: { z: low }, max: { z: high } });
const terrain = { bounds: box(500, 4400), heights: heights(500, 4400) };
const mesh = { bounds: box(400, 900) };
const sceneOf = (...objects: object[]) =>
  create(SessionStateSchema, {
    objects,
    sceneBounds: box(400, 4400),
    home: { eye: [-9000, -9000, 12_000], target: [10_000, 10_000, 2400], fovyDegrees: 45 },
  });

describe("The whole scene, as it is drawn", () => {
  const scene = sceneOf(terrain, mesh);

  it.each([1, 10, 0.1, -2])("is in the first view with heights exaggerated by %d", (by) => {
    const heights = [500 * by, 4400 * by, 400, 900];
    for (const aspect of [0.5, 1, 16 / 9]) {
      // The server's own view, of pictures that wide, is the server's to frame.
      const home = by === 1 && aspect > 1 ? undefined : homeOf(scene, by, aspect);
      if (home === undefined) continue;
      for (const x of [0, 20_000])
        for (const y of [0, 20_000])
          for (const z of heights)
            for (const share of project(home, [x, y, z], aspect) ?? [-1]) {
              expect(share).toBeGreaterThanOrEqual(0);
              expect(share).toBeLessThanOrEqual(1);
            }
    }
  });

  it("reaches as high as its terrain does, and its meshes as they are", () => {
    expect(wholeBounds(scene, 10)).toEqual({ min: [0, 0, 400], max: [20_000, 20_000, 44_000] });
    expect(wholeBounds(scene, -1)).toEqual({ min: [0, 0, -4400], max: [20_000, 20_000, 900] });
    expect(wholeBounds(sceneOf(), 10)?.max[2]).toBe(4400);
    expect(objectBounds(scene.objects[0], 10)?.min[2]).toBe(5000);
    expect(objectBounds(scene.objects[1], 10)?.min[2]).toBe(400);
  });

  it("reaches as high as terrain does that its scene moves, scales and turns", () => {
    const raised = sceneOf({ bounds: box(2000, 9800), heights: heights(1000, 8800) });
    expect(objectBounds(raised.objects[0], 10)).toEqual({
      min: [0, 0, 11_000],
      max: [20_000, 20_000, 89_000],
    });
    expect(wholeBounds(raised, -1)).toEqual({
      min: [0, 0, 1000 - 8800],
      max: [20_000, 20_000, 0],
    });
    const onItsSide = { min: { x: -300 }, max: { x: -100 } };
    const leaning = sceneOf({ bounds: box(0, 50), heights: onItsSide }).objects[0];
    expect(objectBounds(leaning, 2)).toEqual({ min: [-300, 0, 0], max: [19_900, 20_000, 50] });
  });

  it("without terrain is seen from where the server shows it", () => {
    expect(homeOf(sceneOf(mesh), 10, 16 / 9)).toEqual(homeOf(scene, 1, 16 / 9));
  });
});

describe("The ground", () => {
  it("is that of all terrains, whatever stands above or lies below; without one, of the scene", () => {
    const lower = { bounds: box(-70, 30), heights: heights(-70, 30) };
    expect(groundHeights(sceneOf(terrain, mesh))).toEqual([500, 4400]);
    expect(groundHeights(sceneOf(mesh, terrain, lower))).toEqual([-70, 4400]);
    expect(groundHeights(sceneOf(mesh))).toEqual([400, 4400]);
    expect(groundHeights(create(SessionStateSchema, {}))).toBeUndefined();
  });
});
