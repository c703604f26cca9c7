// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { aimAt, middleOf } from "./aim";
import type { Camera, Vec3 } from "./camera/camera";
import { add, axesOf, distance, scale } from "./camera/camera";
import { pan, zoom } from "./camera/orbit";
import { appearance } from "./pick";
import { SightSchema } from "./protocol/gen/eyrie/v1/frame_pb";
import { SeenAreaSchema } from "./protocol/gen/eyrie/v1/viewer_pb";
import type { Shown } from "./protocol/messages";

const camera: Camera = { eye: [3, -10, 5], target: [0, 1, 0], up: [0, 0, 1], fovyDegrees: 45 };
const canvas = { width: 800, height: 300 };
const limits = { min: 1e-3, max: 1e6 };
const area = (x: number, width: number, sight: object) =>
  create(SeenAreaSchema, { x, y: 0, width, height: 1, sight: create(SightSchema, sight) });
const picture = (...seen: ReturnType<typeof area>[]): Shown => ({
  camera,
  width: 1600,
  height: 600,
  exaggeration: 1,
  hidden: [],
  seen,
  isPacked: true,
});

const eye = (x: number) => ({
  eye: [x, 0, 0],
  frustum: { left: -0.6 - x / 20, right: 0.6 - x / 20, bottom: -0.4, top: 0.4 },
});
const stereo = picture(area(0, 0.5, eye(-0.3)), area(0.5, 0.5, eye(0.3)));

const cosine = Math.cos(0.6);
const sine = Math.sin(0.6);
const turned = {
  viewFromCamera: [cosine, 0, sine, 0, 1, 0, -sine, 0, cosine],
  frustum: { left: -0.2, right: 0.7, bottom: -0.1, top: 0.5 },
};
/** A corner of two walls, and nothing between them. */
const walls = picture(
  area(0, 0.4, { frustum: { left: -0.9, right: 0.3, bottom: -0.4, top: 0.5 } }),
  area(0.6, 0.4, turned),
);

/** A point at the target's distance by its place in pixels of the canvas, of a camera of these pixels. */
function pointAt({ x, y }: { x: number; y: number }): Vec3 {
  const { right, up } = axesOf(camera);
  const metres = (2 * distance(camera) * Math.tan(Math.PI / 8)) / canvas.height;
  return add(camera.target, add(scale(right, x * metres), scale(up, -y * metres)));
}

/** Where it is seen on the canvas. */
function seenAt(shown: Shown, by: Camera, point: Vec3): [number, number] {
  const [x = Number.NaN, y = Number.NaN] = appearance({ ...shown, camera: by }, point) ?? [];
  return [x * canvas.width, y * canvas.height];
}

describe("an aim", () => {
  it("is none in a picture of the camera's own", () => {
    expect(aimAt({ ...stereo, seen: null }, { x: 9, y: 9 }, canvas, 45)).toBeUndefined();
    expect(aimAt(null, { x: 9, y: 9 }, canvas, 45)).toBeUndefined();
  });

  it("is at what is seen there, through whatever wall", () => {
    for (const at of [
      { x: 60, y: 40 },
      { x: 300, y: 250 },
      { x: 520, y: 100 },
      { x: 700, y: 200 },
    ]) {
      const aim = aimAt(walls, at, canvas, 45);
      if (aim === undefined) throw new Error("no aim");
      const [x, y] = seenAt(walls, camera, pointAt(aim));
      expect(x).toBeCloseTo(at.x, 9);
      expect(y).toBeCloseTo(at.y, 9);
    }
  });

  it("keeps what is under the pointer there when the view is zoomed", () => {
    for (const at of [
      { x: 100, y: 60 },
      { x: 330, y: 200 },
      { x: 470, y: 100 },
    ]) {
      const aim = aimAt(stereo, at, canvas, 45);
      if (aim === undefined) throw new Error("no aim");
      const zoomed = zoom(camera, 0.8, aim.x, aim.y, canvas.height, limits);
      const mono = zoom(camera, 0.8, at.x - 400, at.y - 150, canvas.height, limits);
      const sight = stereo.seen?.[at.x < 400 ? 0 : 1];
      const one = { ...stereo, seen: sight === undefined ? [] : [sight] };
      // The eye is a little beside the camera: what is under the pointer is found from there.
      const offset = (at.x < 400 ? -1 : 1) * 0.3;
      const point = add(pointAt(aim), scale(axesOf(camera).right, offset));
      const [x, y] = seenAt(one, camera, point);
      expect([x, y]).toEqual([expect.closeTo(at.x, 6), expect.closeTo(at.y, 6)]);
      expect(seenAt(one, zoomed, point)).toEqual([
        expect.closeTo(at.x, 6),
        expect.closeTo(at.y, 6),
      ]);
      expect(seenAt(one, mono, point)[0]).not.toBeCloseTo(at.x, 0);
    }
  });

  it("knows how far the scene is to go for a pixel, across and down", () => {
    const { perPixel } = aimAt(stereo, { x: 200, y: 150 }, canvas, 45) ?? {};
    if (perPixel === undefined) throw new Error("no aim");
    const moved = pan(camera, 30 * perPixel.x, -20 * perPixel.y, canvas.height);
    const before = seenAt(stereo, camera, camera.target);
    const after = seenAt(stereo, moved, camera.target);
    // Of the target, which the left eye has in the left half.
    expect(after[0] - before[0]).toBeCloseTo(30, 6);
    expect(after[1] - before[1]).toBeCloseTo(-20, 6);
  });

  it("between walls, and at what is beside the eye, is straight ahead", () => {
    const beside = picture(area(0, 1, { ...turned, viewFromCamera: [0, 0, 1, 0, 1, 0, -1, 0, 0] }));
    for (const shown of [walls, beside]) {
      const { x = 1, y = 1 } = aimAt(shown, { x: 400, y: 10 }, canvas, 45) ?? {};
      expect(Math.hypot(x, y)).toBe(0);
    }
  });
});

describe("the middle", () => {
  it("is the canvas's, or that of the first of several views", () => {
    expect(middleOf(null, canvas)).toEqual({ x: 400, y: 150 });
    expect(middleOf({ ...stereo, seen: null }, canvas)).toEqual({ x: 400, y: 150 });
    expect(middleOf(stereo, canvas)).toEqual({ x: 200, y: 150 });
  });
});
