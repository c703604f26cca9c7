// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { Camera, Vec3 } from "./camera";
import { axesOf, distance, dot, isUsable, length, project as shareOf, subtract } from "./camera";
import { fly, flyDirection, look } from "./fly";
import { distanceLimits, orbit, pan, zoom } from "./orbit";
import type { Bounds } from "./standard";
import { directionOfView, homeIn } from "./standard";
import { pinch } from "./touch";

const camera: Camera = { eye: [0, -10, 5], target: [0, 0, 0], up: [0, 0, 1], fovyDegrees: 45 };
const limits = distanceLimits(20);
const height = 720;

/** Where a world point appears, in pixels from the centre, y downwards. */
function project(by: Camera, point: Vec3): { x: number; y: number } {
  const [x, y] = shareOf(by, point, 1) ?? [NaN, NaN];
  return { x: (x - 0.5) * height, y: (y - 0.5) * height };
}

/** Links, flights with roll and programs bring such; a map's is from above, with north up. */
const map: Camera = { ...camera, eye: [0, 0, 10], up: [0, 1, 0] };
const cameras = [
  camera,
  map,
  { ...camera, up: [1, 0, 0] },
  { ...camera, up: [1, -2, -3] },
] as const;

describe("orbit", () => {
  it("keeps the distance and the target", () => {
    const turned = orbit(camera, 0.7, -0.3);
    expect(distance(turned)).toBeCloseTo(distance(camera), 9);
    expect(turned.target).toEqual(camera.target);
  });

  it("keeps a map's north up as it leaves it", () => {
    const turned = orbit(map, 0, -0.3);
    expect(turned.up).toEqual([0, 0, 1]);
    expect(axesOf(turned).right[0]).toBeCloseTo(1, 9);
    expect(turned.eye[1]).toBeCloseTo(-10 * Math.sin(0.3), 9);
  });

  it("comes back after a full turn", () => {
    const turned = orbit(camera, 2 * Math.PI, 0);
    expect(length(subtract(turned.eye, camera.eye))).toBeLessThan(1e-9);
  });

  it("never flips over a pole", () => {
    let turned = camera;
    for (let i = 0; i < 100; ++i) turned = orbit(turned, 0, 0.5);
    expect(axesOf(turned).up[2]).toBeGreaterThan(0);
    expect(axesOf(turned).right[0]).toBeCloseTo(1, 6);
    for (let i = 0; i < 100; ++i) turned = orbit(turned, 0, -0.5);
    expect(axesOf(turned).up[2]).toBeGreaterThan(0);
    expect(axesOf(turned).right[0]).toBeCloseTo(1, 6);
  });
});

describe("pan", () => {
  it.each(cameras)("keeps the target under the pointer, up as it may be ($up)", (by) => {
    const moved = pan(by, 30, -20, height);
    const seen = project(moved, by.target);
    expect(seen.x).toBeCloseTo(30, 6);
    expect(seen.y).toBeCloseTo(-20, 6);
    expect(moved.up).toEqual(by.up);
  });

  it("moves a map east where it is drawn to the west", () => {
    const { eye } = pan(map, -100, 0, height);
    expect(eye[0]).toBeGreaterThan(1);
    expect(eye[1]).toBeCloseTo(0, 9);
  });
});

describe("zoom", () => {
  it.each(cameras)("keeps what is under the pointer there, up as it may be ($up)", (by) => {
    const point = pan(by, -200, -100, height).target; // shows at (200, 100)
    expect(project(by, point).x).toBeCloseTo(200, 6);
    for (const factor of [0.5, 0.9, 1.1, 1.8]) {
      const zoomed = zoom(by, factor, 200, 100, height, limits);
      const seen = project(zoomed, point);
      expect(seen.x).toBeCloseTo(200, 6);
      expect(seen.y).toBeCloseTo(100, 6);
      expect(distance(zoomed)).toBeCloseTo(distance(by) * factor, 6);
    }
  });

  it("out from beyond the largest distance stays there, and comes back from it", () => {
    const far: Camera = { ...camera, eye: [0, -3 * limits.max, 0] };
    const out = zoom(far, 1.2, 100, 50, height, limits);
    expect(length(subtract(out.eye, far.eye))).toBeLessThan(1e-9 * limits.max);
    expect(distance(zoom(far, 0.9, 100, 50, height, limits))).toBeCloseTo(2.7 * limits.max, 6);
  });

  it("in from nearer than the smallest distance goes ahead, never back, and out goes on from there", () => {
    const near: Camera = { ...camera, eye: [0, -limits.min / 5, 0] };
    const { forward } = axesOf(near);
    const ahead = zoom(near, 0.8, 100, 50, height, limits);
    expect(dot(subtract(ahead.eye, near.eye), forward)).toBeCloseTo(distance(near) * 0.2, 9);
    expect(distance(ahead)).toBeCloseTo(distance(near), 9);
    expect(distance(zoom(near, 1.2, 100, 50, height, limits))).toBeCloseTo(distance(near) * 1.2, 9);
  });

  it("goes on ahead at the smallest distance, and stops at the largest", () => {
    let near = camera;
    for (let i = 0; i < 200; ++i) near = zoom(near, 0.8, 0, 0, height, limits);
    expect(distance(near)).toBeCloseTo(limits.min, 9);
    const further = zoom(near, 0.8, 0, 0, height, limits);
    expect(length(subtract(further.eye, near.eye))).toBeGreaterThan(0);
    let far = camera;
    for (let i = 0; i < 200; ++i) far = zoom(far, 1.3, 0, 0, height, limits);
    expect(distance(far)).toBeCloseTo(limits.max, 6);
  });
});

describe("fly", () => {
  it("moves eye and target together, along the keys", () => {
    const moved = fly(camera, new Set(["KeyW"]), false, 0.1);
    const step = subtract(moved.eye, camera.eye);
    expect(length(step)).toBeCloseTo(distance(camera) * 0.05, 9);
    expect(length(subtract(step, subtract(moved.target, camera.target)))).toBeLessThan(1e-12);
    expect(dot(step, axesOf(camera).forward)).toBeGreaterThan(0);
  });

  it("is as fast diagonally, and still for opposite keys", () => {
    expect(length(flyDirection(camera, new Set(["KeyW", "KeyD", "KeyE"])))).toBeCloseTo(1, 9);
    expect(flyDirection(camera, new Set(["KeyW", "KeyS"]))).toEqual([0, 0, 0]);
    expect(flyDirection(camera, new Set(["KeyP"]))).toEqual([0, 0, 0]);
  });

  it("does not jump after a pause", () => {
    const moved = fly(camera, new Set(["KeyW"]), true, 60);
    expect(length(subtract(moved.eye, camera.eye))).toBeLessThan(distance(camera) * 0.21);
  });

  it("stands upright once it looks around", () => {
    for (const by of cameras) expect(look(by, 0.1, 0.1).up).toEqual([0, 0, 1]);
  });

  it("looks around without moving the eye, and never over a pole", () => {
    const turned = look(camera, 0.4, 9);
    expect(turned.eye).toEqual(camera.eye);
    expect(distance(turned)).toBeCloseTo(distance(camera), 9);
    expect(axesOf(turned).up[2]).toBeGreaterThan(0);
  });
});

describe("any sequence of moves", () => {
  it("leaves a usable camera", () => {
    let seed = 12345;
    const random = (): number => {
      seed = (seed * 1103515245 + 12345) % 2147483648;
      return seed / 2147483648 - 0.5;
    };
    let moved: Camera = map;
    for (let i = 0; i < 5000; ++i) {
      const pick = Math.floor((random() + 0.5) * 5);
      if (pick === 0) moved = orbit(moved, random() * 4, random() * 4);
      else if (pick === 1) moved = pan(moved, random() * 500, random() * 500, height);
      else if (pick === 2)
        moved = zoom(moved, Math.exp(random() * 3), random() * 900, random() * 700, height, limits);
      else if (pick === 3) moved = look(moved, random() * 4, random() * 4);
      else moved = fly(moved, new Set(["KeyW", "KeyE"]), true, 0.1);
      expect(isUsable(moved)).toBe(true);
      expect(Math.abs(axesOf(moved).forward[2])).toBeLessThan(1);
    }
  });

  it("bears a picture without height and fingers in one place", () => {
    expect(isUsable(pan(camera, 1, 1, 0))).toBe(true);
    const p = { x: 5, y: 5 };
    expect(pinch([p, p], [p, p]).factor).toBe(1);
  });
});

describe("pinch", () => {
  it("tells movement from spreading", () => {
    const before = [
      { x: 0, y: 0 },
      { x: 100, y: 0 },
    ] as const;
    const after = [
      { x: -40, y: 10 },
      { x: 160, y: 10 },
    ] as const;
    expect(pinch(before, after)).toEqual({
      dx: 10,
      dy: 10,
      factor: 0.5,
      turn: 0,
      centre: { x: 60, y: 10 },
    });
  });

  it("tells turning, clockwise as seen", () => {
    const at = (x: number, y: number) => ({ x, y });
    const { turn, factor } = pinch([at(0, 0), at(100, 0)], [at(50, -50), at(50, 50)]);
    expect(turn).toBeCloseTo(Math.PI / 2, 12);
    expect(factor).toBeCloseTo(1, 12);
  });
});

describe("the whole scene", () => {
  const home: Camera = { ...camera, eye: [-60, -60, 55], target: [40, 40, 10] };
  const bounds: Bounds = { min: [0, 0, 0], max: [100, 100, 20] };

  it("is in pictures of every shape, to its corners", () => {
    for (const aspect of [0.2, 0.46, 0.75, 1, 1.3])
      for (const x of [0, 100])
        for (const y of [0, 100])
          for (const z of [0, 20]) {
            const at = project(homeIn(home, bounds, aspect), [x, y, z]);
            expect(Math.abs(at.x)).toBeLessThanOrEqual((aspect * height) / 2);
            expect(Math.abs(at.y)).toBeLessThanOrEqual(height / 2);
          }
  });

  it("is seen from where the server shows it, and just so in wide pictures", () => {
    expect(homeIn(home, bounds, 16 / 9)).toEqual(home);
    const [narrow, wide] = [homeIn(home, bounds, 0.5), home].map(directionOfView);
    expect(narrow?.azimuth).toBeCloseTo(wide?.azimuth ?? NaN, 9);
    expect(narrow?.elevation).toBeCloseTo(wide?.elevation ?? NaN, 9);
  });
});
