// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import type { Camera, Vec3 } from "../camera/camera";
import { add, length, scale, subtract } from "../camera/camera";
import type { Bounds } from "../camera/standard";
import { cameraAt } from "./flight";
import { pathOf } from "./paths";

/** A model of 8 m, so that eqPly's unit is 4 m; its middle is (10, 20, 30). */
const bounds: Bounds = { min: [6, 18, 29], max: [14, 22, 31] };
const centre: Vec3 = [10, 20, 30];
const read = (text: string) => pathOf(text, "path", bounds, 45);

const aheadOf = ({ eye, target }: Camera): Vec3 => {
  const ahead = subtract(target, eye);
  return scale(ahead, 1 / length(ahead));
};
const expectNear = (found: Vec3 | undefined, wanted: Vec3): void => {
  expect(length(subtract(found ?? [9e9, 9e9, 9e9], wanted))).toBeLessThan(1e-9);
};

describe("An eqPly path", () => {
  it("without rotations looks along -z at the model's middle, in units of half its size", () => {
    const { flight } = read("0 0 0\n1 0 0 -4  0 0 0\n60 1 0 -2  0 0 0\n");
    const [first] = flight.keys;
    expectNear(first?.camera.eye, add(centre, [0, 0, 16]));
    expectNear(aheadOf(first?.camera as Camera), [0, 0, -1]);
    expectNear(first?.camera.up, [0, 1, 0]);
    const last = flight.keys[flight.keys.length - 1];
    expectNear(last?.camera.eye, add(centre, [-4, 0, 8]));
    expect(last?.seconds).toBe(2);
  });

  it("turns the model before it moves it", () => {
    const { flight } = read("90 0 0\n1 0 0 -4  0 0 0\n1 0 0 -4 0 0 0\n");
    // The model's z is up in the picture reversed: y of the view is -z of the model.
    expectNear(flight.keys[0]?.camera.eye, add(centre, [0, 16, 0]));
    expectNear(aheadOf(flight.keys[0]?.camera as Camera), [0, -1, 0]);
    expectNear(flight.keys[0]?.camera.up, [0, 0, -1]);
  });

  it("turns the view by heading, pitch and roll, about the eye", () => {
    const at = (turn: string) => read(`0 0 0\n1 0 0 0 ${turn}\n1 0 0 0 ${turn}`).flight.keys[0];
    expectNear(at("90 0 0")?.camera.eye, centre);
    expectNear(aheadOf(at("90 0 0")?.camera as Camera), [1, 0, 0]);
    expectNear(aheadOf(at("0 90 0")?.camera as Camera), [0, 1, 0]);
    expectNear(at("0 0 90")?.camera.up, [1, 0, 0]);
  });

  it("goes straight between its steps", () => {
    const { flight } = read("0 0 0\n1 0 0 -4  0 0 0\n300 1 0 -2  90 0 0\n300 5 5 5 0 0 0");
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

describe("A path of eyes, ups and normals", () => {
  const eyes = [0, 1, 2].map((x) => `${x} 0 30  0 0 1`);

  it("has a camera in every line, 30 a second", () => {
    const { flight, note } = read(eyes.map((line) => `${line}  0 1 0`).join("\n"));
    expect(flight.keys.map(({ seconds }) => seconds)).toEqual([0, 1 / 30, 2 / 30]);
    expectNear(flight.keys[2]?.camera.eye, [2, 0, 30]);
    expectNear(aheadOf(flight.keys[2]?.camera as Camera), [0, 1, 0]);
    expect(note).toContain("point ahead");
  });

  it("looks at the scene whichever way its normals point", () => {
    const { flight, note } = read(eyes.map((line) => `${line}  0 -1 0`).join("\n"));
    expectNear(aheadOf(flight.keys[1]?.camera as Camera), [0, 1, 0]);
    expect(note).toContain("at the eye");
  });
});

it.each([
  ["", /a path has/],
  ["1 2 3", /a path has/],
  ["1 2 3\n1 2 3 4 5 6", /a path has/],
  ["0 0 0\n1 0 0 x 0 0 0", /line 2 has something else/],
  ["0 0 30 0 0 1 0 0 1\n0 0 30 0 0 1 0 0 1", /camera of key 1 spans no picture/],
])("A text that is no path is refused: %j", (text, why) => {
  expect(() => read(text)).toThrow(why);
});
