// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { Camera } from "./camera/camera";
import { look } from "./camera/fly";
import type { Ground } from "./camera/walk";
import { usualEyeHeight } from "./camera/walk";
import { Walker } from "./walker";

const hill = (x: number, y: number): number => 100 + 5 * Math.sin(x / 7) + 3 * Math.cos(y / 5);
const above: Camera = { eye: [0, -300, 400], target: [0, 0, 90], up: [0, 0, 1], fovyDegrees: 45 };
const isLand = (x: number): boolean => Math.abs(x) < 60;

/** A walker whose ground is answered after so many steps. */
function walking(delay = 0) {
  const drawn = { exaggeration: 1, isShown: true };
  const cameras: Camera[] = [];
  const waiting: { steps: number; answer: () => void }[] = [];
  const failures: boolean[] = [];
  const walker = new Walker({
    moved: (camera) => cameras.push(camera),
    failed: (isAnswered) => failures.push(isAnswered),
    ask: (from, to, samples, answered) => {
      const heights = Array.from({ length: samples }, (_, i) => {
        const share = i / (samples - 1);
        const [x, y] = [0, 1].map((k) => (from[k] ?? 0) + ((to[k] ?? 0) - (from[k] ?? 0)) * share);
        const isGround = drawn.isShown && isLand(x ?? 0);
        return isGround ? drawn.exaggeration * hill(x ?? 0, y ?? 0) : undefined;
      });
      const ground: Ground = { from, to, heights };
      if (delay === 0) queueMicrotask(() => answered(ground));
      else waiting.push({ steps: delay, answer: () => answered(ground) });
      return true;
    },
  });
  const step = async (...keys: string[]): Promise<void> => {
    walker.walk(new Set(keys), false, 1 / 60, 0);
    for (const one of waiting) one.steps -= 1;
    while (waiting[0] !== undefined && waiting[0].steps <= 0) waiting.shift()?.answer();
    await Promise.resolve();
  };
  const last = (): Camera => cameras[cameras.length - 1] ?? above;
  return { walker, drawn, cameras, step, last, failures };
}

describe("A walk", () => {
  it("begins where the view looks at, level, at eye height", async () => {
    const { walker, last } = walking();
    walker.begin(above);
    await Promise.resolve();
    expect(last().eye).toEqual([0, 0, hill(0, 0) + usualEyeHeight]);
    expect(last().target[2]).toBe(last().eye[2]);
    expect(last().target[1]).toBeGreaterThan(0);
  });

  it.each([0, 5])("stays at eye height above the ground, answers %d steps late", async (delay) => {
    const { walker, cameras, step, last } = walking(delay);
    walker.begin(above);
    for (let i = 0; i < 900; ++i) {
      if (i % 90 === 45) {
        const turned = look(last(), 0.7, 0);
        walker.turned(turned);
      }
      await step("KeyW", ...(i > 600 ? ["KeyD"] : []));
    }
    const steps = cameras.slice(1).map(({ eye }, i) => {
      const [x = 0, y = 0] = cameras[i]?.eye ?? [];
      return Math.hypot(eye[0] - x, eye[1] - y);
    });
    expect(steps.reduce((sum, one) => sum + one, 0)).toBeGreaterThan(45);
    // Between samples and beside the line it is as far off as the hill is curved there.
    for (const { eye } of cameras)
      expect(Math.abs(eye[2] - usualEyeHeight - hill(eye[0], eye[1]))).toBeLessThan(0.6);
  });

  it("ends where the ground does, and can turn back", async () => {
    const { walker, step, last } = walking();
    walker.begin({ ...above, eye: [-300, 0, 400], target: [55, 0, 90] });
    await Promise.resolve();
    for (let i = 0; i < 600; ++i) await step("KeyW");
    const [edge] = last().eye;
    expect(edge).toBeGreaterThan(58);
    expect(edge).toBeLessThan(60);
    for (let i = 0; i < 60; ++i) await step("KeyS");
    expect(last().eye[0]).toBeLessThan(edge - 1);
  });

  it("does not begin where there is none", async () => {
    const { walker, cameras, failures } = walking();
    walker.begin({ ...above, target: [99, 0, 90] });
    await Promise.resolve();
    expect(failures).toEqual([true]);
    expect(cameras).toEqual([]);
  });

  it("stands on the ground as it is drawn, however often that changes", async () => {
    const { walker, drawn, step, last, failures } = walking();
    walker.begin(above);
    await Promise.resolve();
    for (const exaggeration of [3, 2]) {
      drawn.exaggeration = exaggeration;
      walker.groundChanged();
    }
    await Promise.resolve();
    expect(last().eye).toEqual([0, 0, 2 * hill(0, 0) + usualEyeHeight]);
    expect(last().target[2]).toBe(last().eye[2]);
    for (let i = 0; i < 20; ++i) await step("KeyW");
    const [x, y, z] = last().eye;
    expect(y).toBeGreaterThan(1);
    expect(Math.abs(z - usualEyeHeight - 2 * hill(x, y))).toBeLessThan(0.6);
    drawn.isShown = false;
    walker.groundChanged();
    await Promise.resolve();
    expect(failures).toEqual([true]);
  });

  it("that has ended moves nothing, whatever is answered then", async () => {
    const { walker, cameras, failures } = walking();
    walker.begin(above);
    walker.end();
    walker.begin({ ...above, target: [99, 0, 90] });
    walker.end();
    await Promise.resolve();
    expect(cameras).toEqual([]);
    expect(failures).toEqual([]);
    walker.begin(above);
    await Promise.resolve();
    expect(cameras.length).toBe(1);
  });

  it("from above a map looks to what is up in it", async () => {
    const { walker, last } = walking();
    walker.begin({ ...above, eye: [0, 0, 400], up: [0, 1, 0] });
    await Promise.resolve();
    const [x, y] = last().target;
    expect(x).toBeCloseTo(0, 9);
    expect(y).toBeCloseTo(10 * usualEyeHeight, 9);
  });

  it("does not take it that there is none where nobody answers", () => {
    const failures: boolean[] = [];
    const walker = new Walker({
      moved: () => {},
      failed: (isAnswered) => failures.push(isAnswered),
      ask: () => false,
    });
    walker.begin(above);
    expect(failures).toEqual([false]);
  });

  it("is faster and higher for larger walkers", async () => {
    const { walker, step, last } = walking();
    walker.begin(above);
    await Promise.resolve();
    walker.scale(4, 0);
    const before = last().eye;
    expect(before[2]).toBeCloseTo(hill(0, 0) + 4 * usualEyeHeight, 9);
    await step("KeyW");
    await step("KeyW");
    expect(last().eye[1] - before[1]).toBeGreaterThan((3 * 4 * usualEyeHeight) / 60 - 1e-9);
  });
});
