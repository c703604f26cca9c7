// SPDX-License-Identifier: Apache-2.0
// Flights as files: protobuf JSON of eyrie.v1.Flight, which `eyrie bench --flight` plays.
import { create, fromJsonString, toJsonString } from "@bufbuild/protobuf";
import { CameraSchema } from "../protocol/gen/eyrie/v1/camera_pb";
import { FlightSchema } from "../protocol/gen/eyrie/v1/flight_pb";
import { cameraOf } from "../protocol/messages";
import type { Flight } from "./flight";
import { problemOf } from "./flight";

export function flightJson({ name, keys }: Flight): string {
  const message = create(FlightSchema, {
    name,
    keys: keys.map(({ seconds, camera: { eye, target, up, fovyDegrees } }) => ({
      seconds,
      camera: create(CameraSchema, {
        eye: [...eye],
        target: [...target],
        up: [...up],
        fovyDegrees,
      }),
    })),
  });
  return `${toJsonString(FlightSchema, message, { prettySpaces: 1 })}\n`;
}

/** Throws an Error for the user to read where it is no flight that can be played. */
export function flightOfJson(text: string, name: string): Flight {
  const message = fromJsonString(FlightSchema, text);
  const keys = message.keys.map(({ seconds, camera }, i) => {
    const found = cameraOf(camera);
    if (found === undefined) throw new Error(`key ${i + 1} has no eye or no target`);
    return { seconds, camera: found };
  });
  const problem = problemOf(keys);
  if (problem !== undefined) throw new Error(problem);
  return { name: message.name || name, keys };
}
