// SPDX-License-Identifier: Apache-2.0
// The messages of viewer.proto, to and from bytes.
import { create, fromBinary, toBinary } from "@bufbuild/protobuf";
import type { Camera, Vec3 } from "../camera/camera";
import type { Bounds } from "../camera/standard";
import { CameraSchema } from "./gen/eyrie/v1/camera_pb";
import { Vector3Schema } from "./gen/eyrie/v1/geometry_pb";
import type { Sight } from "./gen/eyrie/v1/frame_pb";
import { Shading } from "./gen/eyrie/v1/shading_pb";
import type { Look } from "../look";
import type { Output } from "../output";
import {
  ContourLinesSchema,
  HeightUnit,
  LookSchema,
  ObjectLookSchema,
  PrimitiveShape,
  SunSchema,
  TransferFunctionSchema,
} from "./gen/eyrie/v1/look_pb";
import type { Look as LookMessage } from "./gen/eyrie/v1/look_pb";
import { PickRequestSchema } from "./gen/eyrie/v1/pick_pb";
import {
  FrameAckSchema,
  ObjectKind,
  RendererCondition,
  ShownEye,
  ShownPictureSchema,
  ShownStereo,
  ViewerAbilitiesSchema,
  ViewerLeadSchema,
  ViewerPickSchema,
  ViewerProfileSchema,
  ViewerReadySchema,
  ViewerRequestSchema,
  ViewerResponseSchema,
  ViewerScreenSchema,
  ViewerSwitchSchema,
  ViewRequestSchema,
} from "./gen/eyrie/v1/viewer_pb";
import type {
  CanvasState,
  Frame,
  FramePart,
  ObjectState,
  RendererState,
  SeenArea,
  SessionState,
  ViewerPicked,
  ViewerPlace,
  ViewerProfiled,
  ViewerRequest,
  ViewerResponse,
} from "./gen/eyrie/v1/viewer_pb";
import type { PartStatistics } from "./gen/eyrie/v1/statistics_pb";

export { ObjectKind, RendererCondition, Shading };
export type {
  CanvasState,
  Frame,
  FramePart,
  ObjectState,
  PartStatistics,
  RendererState,
  SeenArea,
  SessionState,
  Sight,
  ViewerPicked,
  ViewerPlace,
  ViewerProfiled,
  ViewerResponse,
};

/** What the viewer wants to see. */
export interface View {
  sequence: number;
  camera: Camera;
  /** Picture size in pixels. */
  width: number;
  height: number;
  tauPixels: number;
  /** A frame time to hold while the view moves; null: tau is kept. */
  budgetMilliseconds: number | null;
  shading: Shading;
  look: Look;
  output: Output;
}

/** What a picture shows a scene with. */
export interface Shown {
  camera: Camera;
  /** In pixels. */
  width: number;
  height: number;
  exaggeration: number;
  /** Objects that are not in it. */
  hidden: readonly number[];
  /**
   * By which sights, later ones above earlier: through walls, or by eyes beside the camera. Null: the
   * picture is the camera's own.
   */
  seen: readonly SeenArea[] | null;
  /** Two eyes in one picture: it fills the canvas whatever its shape, each eye a half. */
  isPacked: boolean;
}

/** A place in what one sight spans, in pixels from its lower left corner, y upwards. */
export interface Place {
  x: number;
  y: number;
  width: number;
  height: number;
  /** Undefined: the camera's own. */
  sight: Sight | undefined;
}

/** A buffer of its own, as toBinary makes it. */
function bytesOf(request: ViewerRequest["request"]): Uint8Array<ArrayBuffer> {
  const message = create(ViewerRequestSchema, { request });
  return toBinary(ViewerRequestSchema, message) as Uint8Array<ArrayBuffer>;
}

const cameraMessage = ({ eye, target, up, fovyDegrees }: Camera) =>
  create(CameraSchema, { eye: [...eye], target: [...target], up: [...up], fovyDegrees });

const shapes = {
  blend: PrimitiveShape.BLEND,
  box: PrimitiveShape.BOX,
  tent: PrimitiveShape.TENT,
  smooth: PrimitiveShape.SMOOTH,
} as const;

function transferMessage(look: Look) {
  if (look.colouring === "tints") return {};
  const primitives = look.colouring === "bare" ? [] : look.primitives;
  const transfer = create(TransferFunctionSchema, {
    unit: look.unit === "metres" ? HeightUnit.METRES : HeightUnit.RELATIVE,
    primitives: primitives.map((primitive) => ({
      ...primitive,
      shape: shapes[primitive.shape],
      colour: [...primitive.colour],
    })),
  });
  return { transfer };
}

export function lookMessage(look: Look): LookMessage {
  return create(LookSchema, {
    exaggeration: look.exaggeration,
    ...transferMessage(look),
    slopeShading: look.slopeShading,
    saturation: look.saturation,
    ...(look.contourMetres > 0
      ? {
          contours: create(ContourLinesSchema, {
            intervalMetres: look.contourMetres,
            widthPixels: look.contourPixels,
          }),
        }
      : {}),
    tileBounds: look.tileBounds,
    pageBounds: look.pageBounds,
    levelTint: look.levelTint,
    rangeTint: look.rangeTint,
    ...(look.frozen === null ? {} : { cutCamera: cameraMessage(look.frozen) }),
    ...(look.sun === null
      ? {}
      : {
          sun: create(SunSchema, {
            azimuthDegrees: look.sun.azimuth,
            elevationDegrees: look.sun.elevation,
          }),
        }),
    hiddenObjects: [...look.hidden],
    objects: look.objects.map(({ object, colour, shading }) =>
      create(ObjectLookSchema, {
        object,
        colour: colour === null ? [] : [...colour],
        ...(shading === null ? {} : { shading }),
      }),
    ),
  });
}

const eyes = {
  "": ShownEye.UNSPECIFIED,
  cyclop: ShownEye.CYCLOP,
  left: ShownEye.LEFT,
  right: ShownEye.RIGHT,
} as const;
const stereos = {
  "": ShownStereo.UNSPECIFIED,
  anaglyph: ShownStereo.ANAGLYPH,
  "side-by-side": ShownStereo.SIDE_BY_SIDE,
  "top-bottom": ShownStereo.TOP_BOTTOM,
} as const;

export const shownMessage = ({ canvas, segment, eye, stereo }: Output) =>
  create(ShownPictureSchema, { canvas, segment, eye: eyes[eye], stereo: stereos[stereo] });

export function encodeView(view: View): Uint8Array<ArrayBuffer> {
  const value = create(ViewRequestSchema, {
    sequence: BigInt(view.sequence),
    camera: cameraMessage(view.camera),
    width: view.width,
    height: view.height,
    tauPixels: view.tauPixels,
    ...(view.budgetMilliseconds === null ? {} : { budgetMilliseconds: view.budgetMilliseconds }),
    shading: view.shading,
    look: lookMessage(view.look),
    shown: shownMessage(view.output),
    underground: view.look.underground,
  });
  return bytesOf({ case: "view", value });
}

/** Has a canvas show another of its layouts. */
export function encodeSwitch(canvas: string, layout: string): Uint8Array<ArrayBuffer> {
  return bytesOf({ case: "switchLayout", value: create(ViewerSwitchSchema, { canvas, layout }) });
}

/** Takes the lead of the session. */
export function encodeLead(): Uint8Array<ArrayBuffer> {
  return bytesOf({ case: "lead", value: create(ViewerLeadSchema) });
}

/** What can be shown beside JPEG and PNG. */
export function encodeAbilities(h264: boolean): Uint8Array<ArrayBuffer> {
  const value = create(ViewerAbilitiesSchema, { h264, tiles: true });
  return bytesOf({ case: "abilities", value });
}

/** Which picture this viewer shows, whoever leads; null: what the leader asks for. */
export function encodeScreen(output: Output | null): Uint8Array<ArrayBuffer> {
  const shown = output === null ? {} : { shown: shownMessage(output) };
  return bytesOf({ case: "screen", value: create(ViewerScreenSchema, shown) });
}

/** The picture with that swap has been decoded. */
export function encodeReady(swap: bigint): Uint8Array<ArrayBuffer> {
  return bytesOf({ case: "ready", value: create(ViewerReadySchema, { swap }) });
}

/** `decodeMilliseconds`: from a picture's arrival until it was drawn. */
export function encodeAck(frameNumber: number, decodeMilliseconds = 0): Uint8Array<ArrayBuffer> {
  const value = create(FrameAckSchema, { frameNumber: BigInt(frameNumber), decodeMilliseconds });
  return bytesOf({ case: "frameAck", value });
}

/** So much of a picture that comes in parts has arrived. */
export function encodePartAck(frameNumber: bigint, bytes: number): Uint8Array<ArrayBuffer> {
  const value = create(FrameAckSchema, { frameNumber, receivedBytes: BigInt(bytes) });
  return bytesOf({ case: "frameAck", value });
}

export function encodePick(
  sequence: number,
  shown: Shown,
  { x, y, width, height, sight }: Place,
): Uint8Array<ArrayBuffer> {
  const request = create(PickRequestSchema, {
    camera: cameraMessage(shown.camera),
    viewWidth: width,
    viewHeight: height,
    x,
    y,
    exaggeration: shown.exaggeration,
    hiddenObjects: [...shown.hidden],
    ...(sight === undefined ? {} : { sight }),
  });
  return bytesOf({
    case: "pick",
    value: create(ViewerPickSchema, { sequence: BigInt(sequence), request }),
  });
}

/** Heights at `samples` places from one point to the other. */
export function encodeProfile(
  sequence: number,
  from: Vec3,
  to: Vec3,
  samples: number,
  hidden: readonly number[],
): Uint8Array<ArrayBuffer> {
  const vector = ([x, y, z]: Vec3) => create(Vector3Schema, { x, y, z });
  const value = create(ViewerProfileSchema, {
    sequence: BigInt(sequence),
    from: vector(from),
    to: vector(to),
    samples,
    hiddenObjects: [...hidden],
  });
  return bytesOf({ case: "profile", value });
}

/** Throws when `bytes` is no ViewerResponse. */
export function decodeResponse(bytes: ArrayBuffer): ViewerResponse {
  return fromBinary(ViewerResponseSchema, new Uint8Array(bytes));
}

/** The box of a message, or undefined when it lacks something. */
export function boundsOf(message: SessionState["sceneBounds"]): Bounds | undefined {
  const { min, max } = message ?? {};
  if (min === undefined || max === undefined) return undefined;
  return { min: [min.x, min.y, min.z], max: [max.x, max.y, max.z] };
}

/** The camera of a message, or undefined when it lacks something. */
export function cameraOf(message: SessionState["home"]): Camera | undefined {
  const [ex, ey, ez] = message?.eye ?? [];
  const [tx, ty, tz] = message?.target ?? [];
  const [ux = 0, uy = 0, uz = 1] = message?.up ?? [];
  if (ex === undefined || ey === undefined || ez === undefined) return undefined;
  if (tx === undefined || ty === undefined || tz === undefined) return undefined;
  return {
    eye: [ex, ey, ez],
    target: [tx, ty, tz],
    up: [ux, uy, uz],
    fovyDegrees: message?.fovyDegrees || 45,
  };
}
