// SPDX-License-Identifier: Apache-2.0
// A view as what others render it by: `eyrie render`, and requests to the server that shows it.
import { toJson } from "@bufbuild/protobuf";
import type { JsonValue } from "@bufbuild/protobuf";
import type { Camera } from "./camera/camera";
import { defaultLook } from "./look";
import { LookSchema } from "./protocol/gen/eyrie/v1/look_pb";
import { ShownPictureSchema } from "./protocol/gen/eyrie/v1/viewer_pb";
import type { Output } from "./output";
import { queryOf } from "./output";
import { lookMessage, shownMessage } from "./protocol/messages";
import type { SharedView } from "./share";
import { shadingName } from "./share";
import type { Size } from "./view/size";

/** As `eyrie render --camera` reads it. */
export function cameraJson({ eye, target, up, fovyDegrees }: Camera): string {
  return JSON.stringify({ eye, target, up, fovyDegrees });
}

/** Nothing where it changes nothing; what a picture at rest cannot hold is left out. */
function lookJson(view: SharedView): { look?: JsonValue } {
  const look = { ...view.look, frozen: null, underground: false };
  const isUsual = JSON.stringify(look) === JSON.stringify(defaultLook);
  return isUsual ? {} : { look: toJson(LookSchema, lookMessage(look)) };
}

/** For a shell: nothing of it is the shell's. */
const quoted = (text: string): string => `'${text.replaceAll("'", "'\\''")}'`;

/** Of one picture among those that a configuration has. */
const optionsOf = (output: Output & { layout: string }): string[] =>
  Object.entries(output)
    .filter(([, value]) => value !== "")
    .map(([name, value]) => `--${name} ${quoted(value as string)}`);

/** Of a configuration that somebody made, by which a picture is seen. */
export interface Configured {
  /** That its canvas shows; "": it has no other. */
  layout: string;
}

/**
 * What to type in a shell for the same picture; SCENE stands for the files that are served, CONFIG
 * for the configuration's, of which the page knows no more. `configured`: null where it is made of the
 * renderers there are, which has one canvas with one screen.
 */
export function renderCommand(
  view: SharedView,
  { width, height }: Size,
  output: Output,
  configured: Configured | null,
): string {
  const { look } = lookJson(view);
  const files = [`cat > camera.json <<'CAMERA'\n${cameraJson(view.camera)}\nCAMERA`];
  if (look !== undefined) files.push(`cat > look.json <<'LOOK'\n${JSON.stringify(look)}\nLOOK`);
  const options = [
    "--camera camera.json",
    `--size ${width}x${height}`,
    `--tau ${view.tau}`,
    `--shading ${shadingName(view.shading)}`,
    ...(look === undefined ? [] : ["--look look.json"]),
    ...(configured === null ? [] : ["--config CONFIG"]),
    ...optionsOf(
      configured === null
        ? { ...output, canvas: "", segment: "", layout: "" }
        : { ...output, ...configured },
    ),
    "-o view.png",
  ];
  return `${files.join("\n")}\neyrie render SCENE ${options.join(" ")}\n`;
}

/** The body of POST /api/v1/image: eyrie.v1.RenderImageRequest as JSON. */
export interface ImageRequest {
  camera: Camera;
  width: number;
  height: number;
  tauPixels: number;
  shading: string;
  look?: JsonValue;
  shown?: JsonValue;
}

export function imageRequest(
  view: SharedView,
  { width, height }: Size,
  output: Output,
): ImageRequest {
  return {
    camera: view.camera,
    width,
    height,
    tauPixels: view.tau,
    shading: `SHADING_${shadingName(view.shading).toUpperCase()}`,
    ...lookJson(view),
    ...(queryOf(output) === "" ? {} : { shown: toJson(ShownPictureSchema, shownMessage(output)) }),
  };
}

/** Where the server of a page draws pictures for programs. */
export const imageAddress = (page: string): string => new URL("api/v1/image", page).href;

/** For a shell with curl; a server with tokens takes one from EYRIE_TOKEN. */
export function curlCommand(request: ImageRequest, page: string): string {
  return [
    "curl --fail-with-body --silent --show-error -o view.png",
    '  ${EYRIE_TOKEN:+--header "Authorization: Bearer $EYRIE_TOKEN"}',
    "  --header 'Content-Type: application/json' --header 'Accept: image/png'",
    `  --data ${quoted(JSON.stringify(request))}`,
    `  ${quoted(imageAddress(page))}\n`,
  ].join(" \\\n");
}

/** For Python 3, with nothing but its standard library. */
export function pythonScript(request: ImageRequest, page: string): string {
  return `import os, urllib.request

view = r"""${JSON.stringify(request)}"""
headers = {"Content-Type": "application/json", "Accept": "image/png"}
if "EYRIE_TOKEN" in os.environ:
    headers["Authorization"] = "Bearer " + os.environ["EYRIE_TOKEN"]
request = urllib.request.Request(${JSON.stringify(imageAddress(page))}, view.encode(), headers)
with urllib.request.urlopen(request) as answer, open("view.png", "wb") as file:
    file.write(answer.read())
    print("view.png: error at most", answer.headers["Eyrie-Tau-Achieved"], "pixels")
`;
}
