// SPDX-License-Identifier: Apache-2.0
import { create, fromBinary } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { add, axesOf, project } from "./camera/camera";
import type { Camera } from "./camera/camera";
import { clickAfter } from "./camera/controls";
import { lookAt } from "./camera/orbit";
import { coordinate, lengthAtMost, lengthText } from "./panel/format";
import { markOf, textOf } from "./panel/pick";
import { appearance, coverOf, pickOf, placeOf, seenPlace } from "./pick";
import { SightSchema } from "./protocol/gen/eyrie/v1/frame_pb";
import {
  SeenAreaSchema,
  ViewerPickedSchema,
  ViewerRequestSchema,
} from "./protocol/gen/eyrie/v1/viewer_pb";
import { encodePick } from "./protocol/messages";

const camera: Camera = { eye: [0, -10, 5], target: [0, 0, 0], up: [0, 0, 1], fovyDegrees: 45 };
const shown = {
  camera,
  width: 640,
  height: 480,
  exaggeration: 1,
  hidden: [2],
  seen: null,
  isPacked: false,
};

const answer = create(ViewerPickedSchema, {
  sequence: 3n,
  point: {
    object: 1,
    position: { x: 1, y: 2, z: 3 },
    error: 0.02,
    distance: 12,
    nearest: 11.5,
    farthest: 14,
    elevation: 1234.567,
    elevationError: 0.03,
  },
});

describe("a click", () => {
  it("ends where the pointer goes farther than a hand shakes", () => {
    const at = { x: 100, y: 50 };
    expect(clickAfter(at, { x: 102, y: 52 })).toEqual(at);
    expect(clickAfter(at, { x: 105, y: 50 })).toBeUndefined();
    expect(clickAfter(undefined, at)).toBeUndefined();
  });

  it("is a place of the picture, counted from its lower left corner", () => {
    const canvas = { width: 320, height: 240 };
    expect(placeOf({ x: 0, y: 240 }, canvas, shown)).toEqual({ x: 0, y: 0 });
    expect(placeOf({ x: 80, y: 60 }, canvas, shown)).toEqual({ x: 160, y: 360 });
    expect(placeOf({ x: 400, y: -5 }, canvas, shown)).toEqual({ x: 640, y: 480 });
  });

  it("in a window of another shape is at the same place of the scene as in the picture's own", () => {
    const tall = { width: 240, height: 480 };
    expect(coverOf(tall, shown)).toEqual({ x: -200, y: 0, width: 640, height: 480 });
    expect(placeOf({ x: 120, y: 240 }, tall, shown)).toEqual({ x: 320, y: 240 });
    expect(placeOf({ x: 0, y: 480 }, tall, shown)).toEqual({ x: 200, y: 0 });
    const flat = { width: 1280, height: 240 };
    expect(coverOf(flat, shown)).toEqual({ x: 0, y: -360, width: 1280, height: 960 });
    expect(placeOf({ x: 1280, y: 0 }, flat, shown)).toEqual({ x: 640, y: 300 });
  });

  it("in a picture of two eyes is at the same share of it, which is all there", () => {
    const canvas = { width: 320, height: 240 };
    const packed = { ...shown, width: 1280, isPacked: true };
    expect(coverOf(canvas, packed)).toEqual({ x: 0, y: 0, ...canvas });
    expect(placeOf({ x: 80, y: 60 }, canvas, packed)).toEqual({ x: 320, y: 360 });
  });

  it("is asked with what the picture shows", () => {
    const place = seenPlace(shown, { x: 5, y: 6 });
    if (place === undefined) throw new Error("no place");
    const { request } = fromBinary(ViewerRequestSchema, encodePick(7, shown, place));
    if (request.case !== "pick") throw new Error("no pick");
    expect(request.value.sequence).toBe(7n);
    expect(request.value.request).toMatchObject({ viewWidth: 640, viewHeight: 480, x: 5, y: 6 });
    expect(request.value.request?.hiddenObjects).toEqual([2]);
    expect(request.value.request?.camera?.eye).toEqual([0, -10, 5]);
    expect(request.value.request?.sight).toBeUndefined();
  });

  it("through a wall is asked with the sight of where it falls", () => {
    const sight = (left: number) =>
      create(SightSchema, { eye: [left, 0, 0], frustum: { left, right: 1, bottom: -1, top: 1 } });
    const area = (x: number, width: number, left: number) =>
      create(SeenAreaSchema, { x, y: 0.25, width, height: 0.5, sight: sight(left) });
    const seen = { ...shown, seen: [area(0, 0.5, -1), area(0.25, 0.75, -2)] };
    // Of the first area, by itself; of both, where the second lies above; of neither.
    expect(seenPlace(seen, { x: 80, y: 240 })).toEqual({
      x: 80,
      y: 120,
      width: 320,
      height: 240,
      sight: sight(-1),
    });
    expect(seenPlace(seen, { x: 280, y: 360 })).toMatchObject({
      x: 120,
      y: 240,
      width: 480,
      sight: sight(-2),
    });
    expect(seenPlace(seen, { x: 280, y: 361 })).toBeUndefined();
    const place = seenPlace(seen, { x: 80, y: 240 });
    if (place === undefined) throw new Error("no place");
    const { request } = fromBinary(ViewerRequestSchema, encodePick(1, seen, place));
    if (request.case !== "pick") throw new Error("no pick");
    expect(request.value.request).toMatchObject({ viewWidth: 320, viewHeight: 240, x: 80, y: 120 });
    expect(request.value.request?.sight?.eye).toEqual([-1, 0, 0]);
  });
});

describe("a point", () => {
  const point = [1, 2, 3] as const;
  const half = Math.tan((camera.fovyDegrees * Math.PI) / 360);
  const frustum = { left: -half, right: half, bottom: -half, top: half };
  const area = (x: number, width: number, sight: object) =>
    create(SeenAreaSchema, { x, y: 0, width, height: 1, sight: create(SightSchema, sight) });
  const through = (...seen: ReturnType<typeof area>[]) => ({ ...shown, seen });

  it("appears through a wall where the wall's sight shows it", () => {
    const [x = 0, y = 0] = project(camera, point, 1) ?? [];
    expect(appearance(shown, point)).toEqual(project(camera, point, 640 / 480));
    const [left = 0, top = 0] = appearance(through(area(0.5, 0.5, { frustum })), point) ?? [];
    expect(left).toBeCloseTo(0.5 + x / 2, 12);
    expect(top).toBeCloseTo(y, 12);
    // From an eye to the right it is to the left; a wall that is turned away does not show it.
    const [moved = 1] = appearance(through(area(0, 1, { frustum, eye: [1, 0, 0] })), point) ?? [];
    expect(moved).toBeLessThan(x);
    const back = { frustum, viewFromCamera: [-1, 0, 0, 0, 1, 0, 0, 0, -1] };
    expect(appearance(through(area(0, 1, back)), point)).toBeUndefined();
  });

  it("appears where the topmost of the sights that show it does", () => {
    const [under, over] = [area(0, 1, { frustum }), area(0, 0.5, { frustum })];
    const [x = 0] = appearance(through(under, over), point) ?? [];
    expect(x).toBeCloseTo((project(camera, point, 1)?.[0] ?? 0) / 2, 12);
    const beside = { frustum: { ...frustum, left: -0.01, right: -0.005 } };
    expect(appearance(through(area(0, 1, beside)), point)).toBeUndefined();
  });
});

describe("an answer", () => {
  it("names the object, and gives as many digits as the error leaves", () => {
    const { title, rows } = textOf(pickOf(answer, ["valley", "hill"], 1));
    expect(title).toBe("hill");
    expect(rows.map(([name, value]) => `${name}: ${value}`)).toEqual([
      "Elevation: 1234.567 m ± 30 mm",
      "x, y, z: 1.000, 2.000, 3.000",
      "Off by: 20 mm at most",
      "Distance: 12 m",
      "Along the view: −500 mm to +2 m",
    ]);
  });

  it("says so where the source may be missed, nothing is there, or something went wrong", () => {
    const grazing = pickOf(answer, [], 1);
    if (grazing.kind !== "point") throw new Error("no point");
    const text = textOf({ ...grazing, farthest: Infinity });
    expect(text.rows.at(-1)?.[1]).toContain("may be missed");
    expect(textOf(pickOf(create(ViewerPickedSchema, {}), [], 1)).title).toBe("Nothing there");
    const problem = create(ViewerPickedSchema, { problem: "page 7 is damaged" });
    expect(textOf(pickOf(problem, [], 1)).title).toBe("page 7 is damaged");
  });

  it("is marked where it is seen, and nowhere else", () => {
    const pick = pickOf(answer, [], 1);
    if (pick.kind !== "point") throw new Error("no point");
    const [x, y] = markOf({ ...pick, position: [0, 0, 0] }, shown) ?? [];
    expect(x).toBeCloseTo(0.5, 9);
    expect(y).toBeCloseTo(0.5, 9);
    expect(markOf({ ...pick, position: [0, -20, 5] }, shown)).toBeUndefined();
    expect(markOf({ ...pick, position: [90, 0, 0] }, shown)).toBeUndefined();
    expect(markOf(pick, { ...shown, exaggeration: 2 })).toBeUndefined();
    expect(markOf({ kind: "nothing" }, shown)).toBeUndefined();
  });

  it("that the camera turns to is in the middle", () => {
    const turned = lookAt(camera, [3, 4, 1]);
    expect(turned.eye).toEqual(camera.eye);
    const [x, y] = project(turned, [3, 4, 1], 2) ?? [];
    expect(x).toBeCloseTo(0.5, 9);
    expect(y).toBeCloseTo(0.5, 9);
    const { right } = axesOf(turned);
    const beside = add(turned.target, right);
    expect(project(turned, beside, 2)?.[0]).toBeGreaterThan(0.5);
  });
});

describe("lengths and coordinates", () => {
  it("are written as people would", () => {
    expect(lengthText(0.0025)).toBe("2.5 mm");
    expect(lengthText(1234)).toBe("1.23 km");
    expect(lengthText(999.6)).toBe("1 km");
    expect(lengthText(-3)).toBe("−3 m");
    expect(lengthText(0)).toBe("0 nm");
    expect(coordinate(1234.56789, 0.3)).toBe("1234.57");
    expect(coordinate(1234.56789, 30)).toBe("1235");
    expect(coordinate(1.23456789, 1e-8)).toBe("1.234567890");
  });

  it("are off by what is said of them, as they are written", () => {
    expect(lengthAtMost(0.4998)).toBe("500 mm");
    expect(lengthAtMost(0.50001)).toBe("501 mm");
    const near = pickOf(answer, [], 1);
    if (near.kind !== "point") throw new Error("no point");
    const rows = textOf({
      ...near,
      position: [-0.0107003449, 0.00469949, 1.5],
      elevation: undefined,
      error: 5.15e-8,
      nearest: 12 - 0.30021,
      farthest: 12 + 0.40011,
    }).rows.map(([, value]) => value);
    expect(rows).toEqual([
      "-0.010700345, 0.004699490, 1.500000000",
      "51.6 nm at most",
      "12 m",
      "−301 mm to +401 mm",
    ]);
  });
});
