// SPDX-License-Identifier: Apache-2.0
import { fromBinary } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { defaultLook, defaultPrimitives } from "../look";
import type { Look } from "../look";
import { usualOutput } from "../output";
import { ViewerRequestSchema } from "./gen/eyrie/v1/viewer_pb";
import { ledViewOf } from "./led_view";
import { encodeView, Shading } from "./messages";

const camera = { eye: [1, 2, 3], target: [4, 5, 6], up: [0, 0, 1], fovyDegrees: 40 } as const;
const view = {
  camera: { ...camera, eye: [1, 2, 3], target: [4, 5, 6], up: [0, 0, 1] },
  tauPixels: 2,
  budgetMilliseconds: 33,
  shading: Shading.FLAT,
  look: defaultLook,
  output: usualOutput,
} as const;

/** As it comes back from the server to those who watch. */
function led(look: Look) {
  const sent = { sequence: 1, width: 640, height: 480, ...view, look };
  const { request } = fromBinary(
    ViewerRequestSchema,
    encodeView(sent as unknown as Parameters<typeof encodeView>[0]),
  );
  return request.case === "view" ? ledViewOf(request.value) : undefined;
}

describe("a view that another leads to", () => {
  it("is what that one asked for", () => {
    expect(led(defaultLook)).toEqual({
      camera: view.camera,
      tau: 2,
      budget: 33,
      shading: Shading.FLAT,
      look: defaultLook,
      output: usualOutput,
    });
  });

  it("looks as there, whatever that is", () => {
    const edited: Look = {
      ...defaultLook,
      exaggeration: 0,
      colouring: "edited",
      primitives: [{ ...defaultPrimitives[0]!, shape: "tent", opacity: 0.5, colour: [0.5, 0, 1] }],
      unit: "metres",
      slopeShading: 0,
      saturation: 0,
      contourMetres: 50,
      contourPixels: 4,
      tileBounds: true,
      rangeTint: true,
      frozen: view.camera as unknown as Look["frozen"],
      underground: true,
      sun: { azimuth: 120, elevation: 0 },
      hidden: [0, 3],
      objects: [
        { object: 1, colour: [0, 0.25, 1], shading: Shading.GOURAUD },
        { object: 2, colour: null, shading: Shading.WIREFRAME },
      ],
    };
    expect(led(edited)?.look).toEqual(edited);
    // By their texts it is known whether two looks are the same.
    expect(JSON.stringify(led(edited)?.look)).toBe(JSON.stringify(edited));
    expect(led({ ...defaultLook, colouring: "bare" })?.look.colouring).toBe("bare");
  });
});
