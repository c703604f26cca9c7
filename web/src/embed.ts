// SPDX-License-Identifier: Apache-2.0
// What pages of others need to show a scene: no panel, no style, no element but their canvas.
// public/examples/embed.js is one.
export type { Bounds } from "./camera/standard";
export type { Camera, Vec3 } from "./camera/camera";
export { cameraAt } from "./flight/flight";
export { flightJson, flightOfJson } from "./flight/file";
export type { Flight, FlightKey } from "./flight/flight";
export { defaultLook } from "./look";
export type { Look } from "./look";
export { usualOutput } from "./output";
export type { Output } from "./output";
export { Shading } from "./protocol/messages";
export type { SessionState, Shown, View } from "./protocol/messages";
export { Socket } from "./protocol/socket";
export type { SocketEvents } from "./protocol/socket";
export { State, Value } from "./state";
export type { Connection, Numbers, Pick, PickedPoint } from "./state";
export { PictureCanvas } from "./view/canvas";
export type { CanvasEvents } from "./view/canvas";
export { Viewer } from "./viewer";
