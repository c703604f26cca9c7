// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { Vec3 } from "../camera/camera";
import { add, length, scale, subtract } from "../camera/camera";
import type { Bounds } from "../camera/standard";
import vectors from "../../../tests/proto/fabric/data/camera_paths.json";
import { cameraAt } from "./flight";
import { pathOf } from "./paths";

const vec = ([x = 0, y = 0, z = 0]: readonly number[]): Vec3 => [x, y, z];

/** Of a model of 8 m, so that eqPly's unit is 4 m; its middle is (10, 20, 30). */
const bounds: Bounds = { min: vec(vectors.bounds.min), max: vec(vectors.bounds.max) };
const centre: Vec3 = [10, 20, 30];
const readPath = (text: string) => pathOf(text, "path", bounds, vectors.fovyDegrees);

const expectNear = (found: Vec3 | undefined, wanted: Vec3): void => {
  expect(length(subtract(found ?? [9e9, 9e9, 9e9], wanted))).toBeLessThan(1e-9);
};

// The same file is a test of fabric/camera_path.h.
describe("A camera path has the cameras that the C++ side reads:", () => {
  it.each(vectors.paths)("$name", ({ text, note, count, keys }) => {
    const read = readPath(text);
    expect(read.note).toContain(note);
    expect(read.flight.keys).toHaveLength(count);
    for (const { key, seconds, eye, ahead, up, distance } of keys) {
      const found = read.flight.keys[key];
      expect(found?.seconds).toBeCloseTo(seconds, 12);
      expectNear(found?.camera.eye, vec(eye));
      expectNear(found?.camera.target, add(vec(eye), scale(vec(ahead), distance)));
      expectNear(found?.camera.up, vec(up));
      expect(found?.camera.fovyDegrees).toBe(vectors.fovyDegrees);
    }
  });

  it.each(vectors.refused)("none in $text", ({ text, says }) => {
    expect(() => readPath(text)).toThrow(says);
  });
});

describe("An eqPly path", () => {
  it("goes straight between its steps", () => {
    const { flight } = readPath("0 0 0\n1 0 0 -4  0 0 0\n300 1 0 -2  90 0 0\n300 5 5 5 0 0 0");
    for (let i = 0; i <= 100; ++i) {
      const share = i / 100;
      const wanted = add(centre, scale([share, 0, 2 * share - 4], -4));
      const { eye, target } = cameraAt(flight, 10 * share);
      expect(length(subtract(eye, wanted))).toBeLessThan(0.01 * 9); // of the way
      const angle = Math.atan2(target[0] - eye[0], eye[2] - target[2]);
      expect(angle).toBeCloseTo((share * Math.PI) / 2, 1);
    }
  });
});
