// SPDX-License-Identifier: Apache-2.0
// The view that another viewer leads to, from its message: the inverse of messages.ts.
import type { Colouring, Look, ObjectLook, Primitive, Shape } from "../look";
import { defaultLook } from "../look";
import type { Output } from "../output";
import type { SharedView } from "../share";
import type { Look as LookMessage, ObjectLook as ObjectLookMessage } from "./gen/eyrie/v1/look_pb";
import { HeightUnit, PrimitiveShape } from "./gen/eyrie/v1/look_pb";
import type { ShownPicture, ViewRequest } from "./gen/eyrie/v1/viewer_pb";
import { ShownEye, ShownStereo } from "./gen/eyrie/v1/viewer_pb";
import { cameraOf } from "./messages";

/** What another viewer wants to see, and thereby this one. */
export interface LedView extends SharedView {
  output: Output;
}

const shapes: Record<PrimitiveShape, Shape> = {
  [PrimitiveShape.UNSPECIFIED]: "blend",
  [PrimitiveShape.BLEND]: "blend",
  [PrimitiveShape.BOX]: "box",
  [PrimitiveShape.TENT]: "tent",
  [PrimitiveShape.SMOOTH]: "smooth",
};

function objectLookOf({ object, colour, shading }: ObjectLookMessage): ObjectLook {
  const [red, green = 0, blue = 0] = colour;
  return {
    object,
    colour: red === undefined ? null : [red, green, blue],
    shading: shading ?? null,
  };
}

function lookOf(message: LookMessage | undefined, underground: boolean): Look {
  if (message === undefined) return { ...defaultLook, underground };
  const { transfer, contours } = message;
  const isBare = transfer?.primitives.length === 0;
  const colouring: Colouring = transfer === undefined ? "tints" : isBare ? "bare" : "edited";
  const primitives = transfer?.primitives.map(({ shape, centre, width, colour, opacity }) => {
    const [red = 0, green = 0, blue = 0] = colour;
    const primitive: Primitive = {
      shape: shapes[shape],
      centre,
      width,
      colour: [red, green, blue],
      opacity: opacity ?? 1,
    };
    return primitive;
  });
  const isEdited = colouring === "edited";
  return {
    exaggeration: message.exaggeration ?? defaultLook.exaggeration,
    colouring,
    primitives: isEdited && primitives ? primitives : defaultLook.primitives,
    unit: isEdited && transfer?.unit === HeightUnit.METRES ? "metres" : "relative",
    slopeShading: message.slopeShading ?? defaultLook.slopeShading,
    saturation: message.saturation ?? defaultLook.saturation,
    contourMetres: contours?.intervalMetres ?? 0,
    contourPixels: contours?.widthPixels ?? defaultLook.contourPixels,
    tileBounds: message.tileBounds,
    pageBounds: message.pageBounds,
    levelTint: message.levelTint,
    rangeTint: message.rangeTint,
    frozen: cameraOf(message.cutCamera) ?? null,
    underground,
    sun:
      message.sun === undefined
        ? null
        : { azimuth: message.sun.azimuthDegrees, elevation: message.sun.elevationDegrees },
    hidden: message.hiddenObjects,
    objects: message.objects.map(objectLookOf),
  };
}

const eyes = {
  [ShownEye.UNSPECIFIED]: "",
  [ShownEye.CYCLOP]: "cyclop",
  [ShownEye.LEFT]: "left",
  [ShownEye.RIGHT]: "right",
} as const;
const stereos = {
  [ShownStereo.UNSPECIFIED]: "",
  [ShownStereo.ANAGLYPH]: "anaglyph",
  [ShownStereo.SIDE_BY_SIDE]: "side-by-side",
  [ShownStereo.TOP_BOTTOM]: "top-bottom",
} as const;

const outputOf = (shown: ShownPicture | undefined): Output => ({
  canvas: shown?.canvas ?? "",
  segment: shown?.segment ?? "",
  eye: eyes[shown?.eye ?? ShownEye.UNSPECIFIED],
  stereo: stereos[shown?.stereo ?? ShownStereo.UNSPECIFIED],
});

/** Undefined where it has no camera. */
export function ledViewOf(message: ViewRequest): LedView | undefined {
  const camera = cameraOf(message.camera);
  if (camera === undefined) return undefined;
  return {
    camera,
    tau: message.tauPixels,
    budget: message.budgetMilliseconds ?? null,
    shading: message.shading,
    look: lookOf(message.look, message.underground),
    output: outputOf(message.shown),
  };
}
