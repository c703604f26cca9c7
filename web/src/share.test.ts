// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it, vi } from "vitest";
import { addBookmark, readBookmarks, removeBookmark } from "./bookmarks";
import type { Configured } from "./command";
import { cameraJson, curlCommand, imageRequest, pythonScript, renderCommand } from "./command";
import { defaultLook, defaultPrimitives } from "./look";
import type { Look } from "./look";
import type { Output } from "./output";
import { usualOutput } from "./output";
import { configuredFor } from "./panel/displays";
import { CanvasStateSchema } from "./protocol/gen/eyrie/v1/viewer_pb";
import { Shading } from "./protocol/messages";
import type { SharedView } from "./share";
import { decodeView, encodeView } from "./share";
import { browserStorage } from "./storage";

const plain: SharedView = {
  camera: { eye: [1.5, -2, 1e6 + 1 / 3], target: [0, 0, 0], up: [0, 0, 1], fovyDegrees: 45 },
  tau: 1,
  budget: null,
  shading: Shading.SMOOTH,
  look: defaultLook,
};
const special: SharedView = {
  camera: { ...plain.camera, up: [0, 1, 0], fovyDegrees: 30 },
  tau: 0.25,
  budget: 33,
  shading: Shading.WIREFRAME,
  look: {
    ...defaultLook,
    exaggeration: 2.5,
    colouring: "edited",
    primitives: defaultLook.primitives.slice(0, 2),
    contourMetres: 50,
    underground: true,
    sun: { azimuth: 200, elevation: 12.5 },
    hidden: [0, 7],
    objects: [
      { object: 1, colour: [1, 0.5, 0], shading: null },
      { object: 4, colour: null, shading: Shading.FLAT },
    ],
  },
};

describe("a link", () => {
  it("brings a view back to the last bit", () => {
    for (const view of [plain, special]) expect(decodeView(`#${encodeView(view)}`)).toEqual(view);
  });

  it("is short where all is as usual, and holds no frozen cut", () => {
    expect(encodeView(plain)).toBe("eye=1.5,-2,1000000.3333333334&at=0,0,0&tau=1");
    const frozen = { ...plain, look: { ...defaultLook, frozen: plain.camera } };
    expect(decodeView(encodeView(frozen))).toEqual(plain);
  });

  it("stays whole in a URL", () => {
    const url = new URL("http://127.0.0.1/");
    url.hash = encodeView(special);
    expect(decodeView(new URL(url.href).hash)).toEqual(special);
  });

  it("is read with its commas encoded, too", () => {
    const passedOn = encodeView(special).replaceAll(",", "%2C");
    expect(decodeView(passedOn)).toEqual(special);
  });

  it("has whatever look the server takes", () => {
    const primitive = { ...defaultPrimitives[0]!, centre: -1e6, width: 1e6 };
    const primitives = Array.from({ length: 32 }, () => primitive);
    const look: Look = {
      ...defaultLook,
      colouring: "edited",
      primitives,
      unit: "metres",
      slopeShading: 0,
      contourPixels: 16,
    };
    expect(decodeView(encodeView({ ...plain, look }))?.look).toEqual(look);
    const tooMany = { ...look, primitives: [...primitives, primitive] };
    expect(decodeView(encodeView({ ...plain, look: tooMany }))).toBeUndefined();
  });

  it("asks for nothing that the server would refuse", () => {
    const withContours = (metres: number) =>
      decodeView(encodeView({ ...plain, look: { ...defaultLook, contourMetres: metres } }));
    for (const metres of [0.001, 100_000])
      expect(withContours(metres)?.look.contourMetres).toBe(metres);
    for (const metres of [0.0009, 100_001, -1]) expect(withContours(metres)).toBeUndefined();
  });

  it("hides objects in whatever order it names them, and however often", () => {
    const link = `${encodeView(plain)}&look=${encodeURIComponent('{"hidden":[4,1,4]}')}`;
    expect(decodeView(link)?.look.hidden).toEqual([1, 4]);
  });

  it("that is not one whole is none", () => {
    const good = encodeView(plain);
    for (const bad of [
      "",
      "#",
      "eye=1,2,3",
      "eye=1,2,3&at=1,2,3",
      "eye=1,2&at=0,0,0",
      "eye=1,2,3,4&at=0,0,0",
      "eye=1,,3&at=0,0,0",
      "eye=NaN,2,3&at=0,0,0",
      "eye=Infinity,2,3&at=0,0,0",
      `${good}&fov=0`,
      `${good}&budget=-1`,
      `${good}&shading=nice`,
      `${good}&look=%7B`,
      `${good}&look=%zz`,
      `${good}&look=null`,
      `${good}&look=${encodeURIComponent('{"exaggeration":"2"}')}`,
      `${good}&look=${encodeURIComponent('{"__proto__x":1}')}`,
      `${good}&look=${encodeURIComponent('{"sun":{"azimuth":0,"elevation":91}}')}`,
      `${good}&look=${encodeURIComponent('{"sun":{"azimuth":0}}')}`,
      `${good}&look=${encodeURIComponent('{"hidden":[-1]}')}`,
      `${good}&look=${encodeURIComponent('{"hidden":[0.5]}')}`,
      `${good}&look=${encodeURIComponent('{"hidden":{}}')}`,
      `${good}&look=${encodeURIComponent('{"objects":[{"object":0,"colour":null}]}')}`,
      `${good}&look=${encodeURIComponent('{"objects":[{"object":0,"colour":[2,0,0],"shading":null}]}')}`,
      `${good}&look=${encodeURIComponent('{"objects":[{"object":0,"colour":null,"shading":9}]}')}`,
      `${good}&look=${encodeURIComponent('{"constructor":1}')}`,
      `${good}&look=${encodeURIComponent('{"unit":"feet"}')}`,
      `${good}&look=${encodeURIComponent('{"slopeShading":2}')}`,
      `${good}&look=${encodeURIComponent('{"contourPixels":0}')}`,
      `${good}&look=${encodeURIComponent('{"primitives":[{"shape":"box","centre":0,"width":0,"colour":[1,0,0],"opacity":1}]}')}`,
      `${good}&look=${encodeURIComponent('{"primitives":[{"shape":"box"}]}')}`,
      `${good.replace("tau=1", "tau=0")}`,
    ])
      expect(decodeView(bad), bad).toBeUndefined();
  });
});

/** What a browser keeps. */
class MemoryStorage {
  private readonly items = new Map<string, string>();
  getItem(key: string): string | null {
    return this.items.get(key) ?? null;
  }
  setItem(key: string, value: string): void {
    if (value.length > 10_000) throw new DOMException("full", "QuotaExceededError");
    this.items.set(key, value);
  }
}

describe("bookmarks", () => {
  it("are kept by name, the newest of a name, and in the order of theirs", () => {
    const storage = new MemoryStorage();
    expect(addBookmark(storage, "summit", plain)).toBe(true);
    addBookmark(storage, "a ridge & more", special);
    addBookmark(storage, "summit", special);
    expect(readBookmarks(storage)).toEqual([
      { name: "a ridge & more", view: special },
      { name: "summit", view: special },
    ]);
    removeBookmark(storage, "a ridge & more");
    expect(readBookmarks(storage).map(({ name }) => name)).toEqual(["summit"]);
  });

  it("are none where what was kept is damaged, and say when no more fit", () => {
    const storage = new MemoryStorage();
    for (const bad of ["", "{", "null", '[{"name":1}]', '[{"name":"a","view":"eye=1"}]']) {
      storage.setItem("eyrie.bookmarks", bad);
      expect(readBookmarks(storage)).toEqual([]);
    }
    expect(addBookmark(storage, "x".repeat(20_000), plain)).toBe(false);
  });

  it("are none, and say so, where the browser forbids to keep any", () => {
    const forbidding = {
      get localStorage(): Storage {
        throw new DOMException("Access is denied", "SecurityError");
      },
    };
    vi.stubGlobal("window", forbidding);
    expect(readBookmarks(browserStorage())).toEqual([]);
    expect(addBookmark(browserStorage(), "summit", plain)).toBe(false);
    vi.unstubAllGlobals();
  });
});

describe("the command for a picture", () => {
  const size = { width: 1280, height: 720 };

  it("names camera, size, error and shading", () => {
    expect(cameraJson(special.camera)).toBe(
      '{"eye":[1.5,-2,1000000.3333333334],"target":[0,0,0],"up":[0,1,0],"fovyDegrees":30}',
    );
    const text = renderCommand({ ...plain, shading: Shading.FLAT }, size, usualOutput, null);
    expect(text).toContain(cameraJson(plain.camera));
    expect(text).toContain(
      "eyrie render SCENE --camera camera.json --size 1280x720 --tau 1 --shading flat -o view.png",
    );
    expect(text).not.toContain("look");
  });

  it("has a look where it is not the usual one", () => {
    const text = renderCommand(special, size, usualOutput, null);
    expect(text).toContain("--look look.json");
    const look: unknown = JSON.parse(/LOOK'\n(.*)\nLOOK/.exec(text)?.[1] ?? "");
    expect(look).toMatchObject({ exaggeration: 2.5, contours: { intervalMetres: 50 } });
  });
});

describe("the command for one screen of a wall", () => {
  const size = { width: 1280, height: 720 };
  const command = (output: Output, configured: Configured | null): string =>
    renderCommand(plain, size, output, configured);

  it("names the screen, the eye, the layout, and that there is a configuration", () => {
    const output = { ...usualOutput, segment: "it's left", eye: "right" as const };
    expect(command(output, { layout: "night shift" })).toContain(
      "--config CONFIG --segment 'it'\\''s left' --eye 'right' --layout 'night shift' -o view.png",
    );
    expect(command(usualOutput, { layout: "" })).toContain("--config CONFIG -o view.png");
  });

  it("names no configuration for two eyes that see through no wall", () => {
    const text = command({ ...usualOutput, stereo: "anaglyph" }, null);
    expect(text).toContain("--stereo 'anaglyph' -o view.png");
    expect(text).not.toContain("--config");
  });

  it("names the only screen there is no more than its configuration", () => {
    const text = command({ ...usualOutput, canvas: "0", segment: "0", eye: "left" }, null);
    expect(text).toContain("--shading smooth --eye 'left' -o view.png");
  });
});

describe("what of a configuration a picture is seen by", () => {
  const canvas = (name: string, segments: string[], layouts: string[], layout: string) =>
    create(CanvasStateSchema, { name, segments, layouts, layout });
  const made = [canvas("canvas", ["screen"], ["2D", "DB"], "DB")];
  const wall = [canvas("wall", ["left", "right"], ["day", "night"], "night")];
  const two = [canvas("desk", ["screen"], ["1"], "1"), ...wall];

  it("is nothing where it is made of the renderers there are", () => {
    expect(configuredFor(made, usualOutput, false)).toBeNull();
    expect(configuredFor(made, { ...usualOutput, canvas: "0", segment: "0" }, false)).toBeNull();
  });

  it("is the layout that its canvas shows, where that has others", () => {
    expect(configuredFor(wall, usualOutput, false)).toEqual({ layout: "night" });
    expect(configuredFor(two, usualOutput, false)).toEqual({ layout: "" });
    expect(configuredFor(two, { ...usualOutput, canvas: "wall" }, true)).toEqual({
      layout: "night",
    });
    expect(configuredFor(two, { ...usualOutput, canvas: "1" }, true)).toEqual({ layout: "night" });
    expect(configuredFor(made, usualOutput, true)).toEqual({ layout: "DB" });
  });
});

describe("a request for a picture", () => {
  const size = { width: 640, height: 480 };
  const page = "http://127.0.0.1:8080/?session=a#eye=1,2,3";

  it("says what makes the picture, and nothing that is as usual", () => {
    expect(imageRequest(plain, size, usualOutput)).toEqual({
      camera: plain.camera,
      ...size,
      tauPixels: 1,
      shading: "SHADING_SMOOTH",
    });
    const request = imageRequest(special, size, { ...usualOutput, segment: "left", eye: "right" });
    expect(request).toMatchObject({
      tauPixels: 0.25,
      shading: "SHADING_WIREFRAME",
      look: {
        exaggeration: 2.5,
        sun: { azimuthDegrees: 200, elevationDegrees: 12.5 },
        hiddenObjects: [0, 7],
      },
      shown: { segment: "left", eye: "SHOWN_EYE_RIGHT" },
    });
  });

  it("is nothing of the shell's, whatever names are in it", () => {
    const output = { ...usualOutput, canvas: "a'b $(c) `d`" };
    const text = curlCommand(imageRequest(plain, size, output), page);
    expect(text).toContain("'http://127.0.0.1:8080/api/v1/image'");
    expect(text).toContain(`"canvas":"a'\\''b $(c) \`d\`"`);
  });

  it("is the same in Python", () => {
    const request = imageRequest(special, size, usualOutput);
    const text = pythonScript(request, page);
    expect(JSON.parse(/r"""(.*)"""/.exec(text)?.[1] ?? "")).toEqual(request);
    expect(text).toContain('Request("http://127.0.0.1:8080/api/v1/image"');
  });
});
