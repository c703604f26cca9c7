// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { Camera, Vec3 } from "../camera/camera";
import played from "../../../tests/proto/fabric/data/flight.json";
import { flightJson, flightOfJson } from "./file";
import { fitKeys, offBy } from "./fit";
import type { FlightKey } from "./flight";
import { cameraAt, problemOf, secondsOf, withKey, withoutKey, withTime } from "./flight";
import { isKept, keepFlight, readFlights, removeFlight } from "./store";

const cameraFrom = (eye: Vec3): Camera => ({
  eye,
  target: [eye[0], eye[1] + 10, eye[2] - 1],
  up: [0, 0, 1],
  fovyDegrees: 45,
});
const keyAt = (seconds: number, eye: Vec3): FlightKey => ({ seconds, camera: cameraFrom(eye) });
const keys = [keyAt(3, [0, 0, 5]), keyAt(4, [10, 0, 5]), keyAt(9, [10, 80, 6])];

describe("A flight", () => {
  it("passes through its keys exactly and stands at its ends", () => {
    for (const key of keys) expect(cameraAt({ keys }, key.seconds - 3)).toEqual(key.camera);
    expect(cameraAt({ keys }, -1)).toEqual(keys[0]?.camera);
    expect(cameraAt({ keys }, 99)).toEqual(keys[2]?.camera);
    expect(secondsOf({ keys })).toBe(6);
  });

  it("shows the cameras that the C++ side plays", () => {
    // The same file is a test of fabric/flight.h.
    const read = flightOfJson(JSON.stringify(played.flight), "");
    expect(played.samples.length).toBeGreaterThan(10);
    for (const { seconds, camera } of played.samples) {
      const found = cameraAt(read, seconds);
      for (const part of ["eye", "target", "up"] as const)
        camera[part].forEach((value, i) => expect(found[part][i]).toBeCloseTo(value, 6));
      expect(found.fovyDegrees).toBeCloseTo(camera.fovyDegrees, 9);
    }
  });

  it("comes back from its file as it was", () => {
    const flight = { name: "über den Grat", keys };
    expect(flightOfJson(flightJson(flight), "other")).toEqual(flight);
    expect(flightOfJson(flightJson({ name: "", keys }), "other").name).toBe("other");
  });

  it.each([
    ["{", /JSON/],
    ["[]", /Flight/],
    ['{"keys":[]}', /no keys/],
    ['{"keys":[{"seconds":0}]}', /key 1 has no eye/],
    ['{"keys":[{"secs":0}]}', /secs/],
    ['{"keys":[{"camera":{"eye":[0,0,1],"target":[0,0,1]}}]}', /spans no picture/],
    ['{"keys":[{"camera":{"eye":[0,0,1],"target":[0,0,0]}}]}', /spans no picture/],
  ])("that is none is refused: %s", (text, why) => {
    expect(() => flightOfJson(text, "")).toThrow(why);
  });

  it("refuses times that do not ascend", () => {
    expect(problemOf(keys)).toBeUndefined();
    expect(problemOf([...keys].reverse())).toMatch(/key 2/);
    expect(problemOf([keyAt(Number.NaN, [0, 0, 0])])).toMatch(/no time/);
    expect(problemOf([...keys, keyAt(1e15, [0, 0, 0])])).toBeUndefined();
    expect(problemOf([...keys, keyAt(1e16, [0, 0, 0])])).toMatch(/key 4 is at 10000000000000000 s/);
  });

  it("is edited key by key, and stays in order", () => {
    const times = (of: readonly FlightKey[] | undefined) => of?.map(({ seconds }) => seconds);
    expect(times(withKey(keys, keyAt(7, [1, 1, 1])))).toEqual([3, 4, 7, 9]);
    expect(times(withKey(keys, keyAt(4, [1, 1, 1])))).toEqual([3, 4, 9]);
    expect(times(withoutKey(keys, 1))).toEqual([3, 9]);
    const moved = withTime(keys, 0, 5);
    expect(times(moved)).toEqual([4, 5, 9]);
    expect(moved?.[1]?.camera).toEqual(keys[0]?.camera);
    expect(withTime(keys, 0, 9)).toBeUndefined();
    expect(withTime(keys, 0, Number.NaN)).toBeUndefined();
    expect(withTime(keys, 0, 1e308)).toBeUndefined();
  });

  it("is kept by the browser under its name", () => {
    const held = new Map<string, string>();
    const storage = {
      getItem: (key: string) => held.get(key) ?? null,
      setItem: (key: string, value: string) => void held.set(key, value),
    };
    expect(keepFlight(storage, { name: "b", keys })).toBe(true);
    keepFlight(storage, { name: "a", keys: keys.slice(0, 1) });
    keepFlight(storage, { name: "b", keys: keys.slice(1) });
    expect(readFlights(storage)).toEqual([
      { name: "a", keys: keys.slice(0, 1) },
      { name: "b", keys: keys.slice(1) },
    ]);
    const changed = { name: "b", keys: keys.slice(2) };
    expect(
      [readFlights(storage)[1] ?? changed, changed].map((one) => isKept(storage, one)),
    ).toEqual([true, false]);
    expect(isKept(storage, { name: "", keys: [] })).toBe(true);
    removeFlight(storage, "a");
    expect(readFlights(storage).map(({ name }) => name)).toEqual(["b"]);
    held.set("eyrie.flights", '["{", 3]');
    expect(readFlights(storage)).toEqual([]);
  });
});

describe("fitKeys", () => {
  /** Round about, stopping now and then, as a hand does; far from the origin. */
  const views = Array.from({ length: 600 }, (_, i): FlightKey => {
    const turn = Math.floor(i / 100) + Math.min(1, (i % 100) / 60);
    const [x, y] = [500_000 + 300 * Math.cos(turn), 4_000_000 + 300 * Math.sin(turn)];
    const camera = { eye: [x, y, 900 + 20 * turn] as const, target: [500_000, 4e6, 800] as const };
    return { seconds: i / 60, camera: { ...camera, up: [0, 0, 1], fovyDegrees: 45 } };
  });

  it.each([
    [0.02, 60],
    [0.001, 150],
    [0.0001, 300],
  ])("keeps every view within %d of its distance", (tolerance, mostKeys) => {
    const { keys: few, error } = fitKeys(views, tolerance);
    const worst = Math.max(
      ...views.map(({ seconds, camera }) => offBy(camera, cameraAt({ keys: few }, seconds))),
    );
    expect(worst).toBeLessThanOrEqual(tolerance);
    expect(error).toBe(worst);
    expect(few.length).toBeLessThan(mostKeys);
  });

  it("needs two keys for steady motion and one for a single view", () => {
    const steady = Array.from({ length: 50 }, (_, i) => keyAt(i, [i, 2 * i, 3]));
    expect(fitKeys(steady, 1e-9).keys).toEqual([steady[0], steady[49]]);
    expect(fitKeys(steady.slice(0, 1), 1e-9).keys).toEqual([steady[0]]);
  });
});
