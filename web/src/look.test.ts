// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import type { Camera } from "./camera/camera";
import {
  defaultLook,
  defaultPrimitives,
  evaluate,
  exaggerationAt,
  fromHex,
  nextInterval,
  ofScene,
  placeOf,
  shapeAt,
  suggestedInterval,
  toHex,
} from "./look";
import type { Primitive, Shape } from "./look";
import { metres, times } from "./panel/format";
import { edited, groundOf, heightTyped, stripPixels, typedHeight } from "./panel/transfer";
import { HeightUnit, PrimitiveShape } from "./protocol/gen/eyrie/v1/look_pb";
import { SessionStateSchema } from "./protocol/gen/eyrie/v1/viewer_pb";
import { lookMessage, Shading } from "./protocol/messages";
import { State } from "./state";

const shapes: readonly Shape[] = ["blend", "box", "tent", "smooth"];
const red: Primitive = { shape: "box", centre: 0.25, width: 0.25, colour: [1, 0, 0], opacity: 0.5 };

describe("a transfer function", () => {
  it("has shapes that are full at the centre and end at the width", () => {
    for (const shape of shapes) {
      expect(shapeAt(shape, 0)).toBe(1);
      expect(shapeAt(shape, 1)).toBe(0);
      for (let d = 0; d < 1; d += 0.05)
        expect(shapeAt(shape, d)).toBeGreaterThanOrEqual(shapeAt(shape, d + 0.05));
    }
  });

  it("is the mean colour by opacity, and the largest opacity", () => {
    expect(evaluate([], 0.5)).toEqual([0, 0, 0, 0]);
    expect(evaluate([red], 0.3)).toEqual([1, 0, 0, 0.5]);
    expect(evaluate([red], 0.6)[3]).toBe(0);
    const blue: Primitive = { ...red, colour: [0, 0, 1], opacity: 1 };
    const [r, g, b, a] = evaluate([red, blue], 0.25);
    expect([r ** 2, g, b ** 2, a]).toEqual([expect.closeTo(1 / 3), 0, expect.closeTo(2 / 3), 1]);
  });

  it("starts as opaque ramps", () => {
    for (let i = 0; i <= 100; ++i) expect(evaluate(defaultPrimitives, i / 100)[3]).toBeCloseTo(1);
    const [low, middle, high] = [0, 0.1, 0.2].map((h) => evaluate(defaultPrimitives, h)[1] ** 2);
    expect(middle).toBeCloseTo(((low ?? 0) + (high ?? 0)) / 2);
  });

  it("shows in the strip what is opaque over bare ground", () => {
    const pixels = stripPixels([{ ...red, opacity: 1 }], 101, [0, 1]);
    expect([...pixels.slice(4 * 25, 4 * 25 + 4)]).toEqual([255, 0, 0, 255]);
    expect(pixels[4 * 90 + 1]).toBeGreaterThan(100);
  });

  it("shows marks in the strip however narrow they are", () => {
    for (const centre of [0, 0.2501, 0.255, 0.9999]) {
      const mark: Primitive = { ...red, shape: "box", centre, width: 1e-4, opacity: 1 };
      const pixels = stripPixels([mark], 101, [0, 1]);
      const isRed = (x: number) => pixels[4 * x] === 255 && pixels[4 * x + 1] === 0;
      const drawn = [...Array(101).keys()].filter(isRed);
      expect(drawn.length).toBeGreaterThan(0);
      expect(drawn.length).toBeLessThanOrEqual(3);
    }
  });

  it("in metres shows in the strip from the lowest to the highest ground", () => {
    const state = new State();
    const session = create(SessionStateSchema, {
      sceneBounds: { min: { z: 200 }, max: { z: 1200 } },
    });
    state.session.set(session);
    expect(groundOf(state)).toEqual([0, 1]);
    state.look.set({ ...defaultLook, unit: "metres" });
    expect(groundOf(state)).toEqual([200, 1200]);
    const snow: Primitive = { ...red, centre: 1200, width: 100, opacity: 1 };
    const pixels = stripPixels([snow], 101, groundOf(state));
    expect([...pixels.slice(4 * 95, 4 * 95 + 4)]).toEqual([255, 0, 0, 255]);
    expect(pixels[4 * 85 + 1]).toBeGreaterThan(100);
  });

  it("has heights typed in as its unit has them, within what the server takes", () => {
    expect([typedHeight(0.254, "relative"), typedHeight(512.345678, "metres")]).toEqual([
      "25",
      "512.3",
    ]);
    expect(heightTyped("25", "relative", 0)).toBe(0.25);
    expect(["-5", "250"].map((text) => heightTyped(text, "relative", 0))).toEqual([0, 1]);
    expect(["-5", "250", "1e9"].map((text) => heightTyped(text, "metres", -1e6))).toEqual([
      -5, 250, 1e6,
    ]);
    expect(["", "x"].map((text) => heightTyped(text, "metres", 0))).toEqual([undefined, undefined]);
  });

  it("is edited without touching the one before", () => {
    const before = [red, red];
    expect(edited(before, 1, { centre: 0.9 })).toEqual([red, { ...red, centre: 0.9 }]);
    expect(edited(before, 0)).toEqual([red]);
    expect(before).toEqual([red, red]);
  });

  it("keeps its colours as the browser spells them", () => {
    for (const hex of ["#000000", "#0a80ff", "#ffffff"]) expect(toHex(fromHex(hex))).toBe(hex);
  });
});

describe("the message", () => {
  it("of the default asks for nothing", () => {
    const message = lookMessage(defaultLook);
    expect(message.transfer).toBeUndefined();
    expect(message.contours).toBeUndefined();
    expect(message.cutCamera).toBeUndefined();
    expect(message.sun).toBeUndefined();
    expect(message.hiddenObjects).toEqual([]);
    expect([message.exaggeration, message.saturation]).toEqual([1, 1]);
  });

  it("holds what the panel chose", () => {
    const frozen: Camera = { eye: [1, 2, 3], target: [4, 5, 6], up: [0, 0, 1], fovyDegrees: 45 };
    const message = lookMessage({
      ...defaultLook,
      colouring: "edited",
      primitives: [red],
      contourMetres: 25,
      frozen,
      pageBounds: true,
      rangeTint: true,
      sun: { azimuth: 90, elevation: 30 },
      hidden: [1, 4],
      objects: [
        { object: 0, colour: [0, 0.5, 1], shading: null },
        { object: 2, colour: null, shading: Shading.WIREFRAME },
      ],
    });
    expect(message.objects).toMatchObject([
      { object: 0, colour: [0, 0.5, 1] },
      { object: 2, colour: [], shading: Shading.WIREFRAME },
    ]);
    expect(message.objects[0]?.shading).toBeUndefined();
    expect(message.sun).toMatchObject({ azimuthDegrees: 90, elevationDegrees: 30 });
    expect(message.hiddenObjects).toEqual([1, 4]);
    expect(message.transfer?.unit).toBe(HeightUnit.RELATIVE);
    expect(message.transfer?.primitives[0]).toMatchObject({
      shape: PrimitiveShape.BOX,
      centre: 0.25,
      width: 0.25,
      colour: [1, 0, 0],
      opacity: 0.5,
    });
    expect(message.contours?.intervalMetres).toBe(25);
    expect(message.cutCamera?.eye).toEqual([1, 2, 3]);
    expect([message.pageBounds, message.tileBounds]).toEqual([true, false]);
    expect([message.rangeTint, message.levelTint]).toEqual([true, false]);
    expect(lookMessage({ ...defaultLook, colouring: "bare" }).transfer?.primitives).toEqual([]);
  });
});

describe("the panel's values", () => {
  it("find the true height in the slider's middle", () => {
    expect([-1, 0, 1].map(exaggerationAt)).toEqual([0.1, 1, 10]);
    for (const place of [-1, -0.3, 0, 0.45, 1])
      expect(placeOf(exaggerationAt(place))).toBeCloseTo(place);
  });

  it("step through sensible contour intervals and end at none", () => {
    expect(suggestedInterval(3000)).toBe(100);
    expect(suggestedInterval(10)).toBe(1);
    expect(suggestedInterval(1e9)).toBe(1000);
    expect(nextInterval(100, 1)).toBe(200);
    expect(nextInterval(100, -1)).toBe(50);
    expect(nextInterval(1, -1)).toBe(0);
    expect(nextInterval(0, -1)).toBe(0);
    expect(nextInterval(1000, 1)).toBe(1000);
    // Of programs and links.
    expect([nextInterval(30, 1), nextInterval(30, -1)]).toEqual([50, 25]);
    expect([nextInterval(0.5, 1), nextInterval(0.5, -1)]).toEqual([1, 0]);
    expect([nextInterval(5000, 1), nextInterval(5000, -1)]).toEqual([5000, 1000]);
  });

  it("are short", () => {
    expect([1, 2.5, 10, 0.25].map(times)).toEqual(["true", "× 2.5", "× 10", "× 0.25"]);
    expect([5, 250, 1000].map(metres)).toEqual(["5 m", "250 m", "1 km"]);
  });
});

describe("a look of another scene", () => {
  it("says nothing of objects that this one lacks", () => {
    const own = { object: 1, colour: null, shading: Shading.FLAT };
    const look = { ...defaultLook, hidden: [0, 7], objects: [own, { ...own, object: 9 }] };
    expect(ofScene(look, 2)).toEqual({ ...defaultLook, hidden: [0], objects: [own] });
    expect(ofScene(look, 10)).toBe(look);
  });
});
