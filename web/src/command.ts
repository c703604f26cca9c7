// SPDX-License-Identifier: Apache-2.0
// A view as a command that renders it.
import { toJsonString } from "@bufbuild/protobuf";
import type { Camera } from "./camera/camera";
import { defaultLook } from "./look";
import { LookSchema } from "./protocol/gen/eyrie/v1/look_pb";
import { lookMessage } from "./protocol/messages";
import type { SharedView } from "./share";
import { shadingName } from "./share";
import type { Size } from "./view/size";

/** As `eyrie render --camera` reads it. */
export function cameraJson({ eye, target, up, fovyDegrees }: Camera): string {
  return JSON.stringify({ eye, target, up, fovyDegrees });
}

/** What to type in a shell for the same picture; SCENE stands for the files that are served. */
export function renderCommand(view: SharedView, { width, height }: Size): string {
  const look = { ...view.look, frozen: null, underground: false };
  const isUsual = JSON.stringify(look) === JSON.stringify(defaultLook);
  const files = [`cat > camera.json <<'CAMERA'\n${cameraJson(view.camera)}\nCAMERA`];
  if (!isUsual)
    files.push(`cat > look.json <<'LOOK'\n${toJsonString(LookSchema, lookMessage(look))}\nLOOK`);
  const options = [
    "--camera camera.json",
    `--size ${width}x${height}`,
    `--tau ${view.tau}`,
    `--shading ${shadingName(view.shading)}`,
    ...(isUsual ? [] : ["--look look.json"]),
    "-o view.png",
  ];
  return `${files.join("\n")}\neyrie render SCENE ${options.join(" ")}\n`;
}
