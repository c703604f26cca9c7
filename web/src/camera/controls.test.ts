// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { Aim } from "../aim";
import { onKeys } from "../panel/keys";
import type { Camera } from "./camera";
import { Controls } from "./controls";
import type { CameraHolder } from "./controls";
import { pan, zoom } from "./orbit";

class FakeWindow extends EventTarget {
  readonly press = (code: string, key: string, isTaken = false): void => {
    const event = new Event("keydown", { cancelable: true });
    if (isTaken) event.preventDefault();
    this.dispatchEvent(Object.assign(event, { code, key }));
  };

  readonly letGo = (code: string, key: string): void => {
    this.dispatchEvent(Object.assign(new Event("keyup"), { code, key }));
  };
}

describe("a key", () => {
  const did: string[] = [];
  let page: FakeWindow;
  let controls: Controls;
  let frames: ((time: number) => void)[];
  let sheet: object | null;

  beforeEach(() => {
    did.length = 0;
    frames = [];
    sheet = null;
    page = new FakeWindow();
    vi.stubGlobal("window", page);
    vi.stubGlobal("Element", class {});
    vi.stubGlobal("document", { querySelector: () => sheet });
    vi.stubGlobal("requestAnimationFrame", (draw: (time: number) => void) => frames.push(draw));
    const holder: Partial<CameraHolder> = {
      isWalking: false,
      isFlying: false,
      camera: null,
      setFlying: (isFlying) => did.push(isFlying ? "fly" : "stop"),
      setWalking: (isWalking) => did.push(isWalking ? "walk" : "stand"),
      goHome: () => did.push("home"),
    };
    controls = new Controls(new EventTarget() as HTMLCanvasElement, holder as CameraHolder);
    onKeys({ o: () => did.push("save") });
  });
  afterEach(() => {
    controls.close();
    vi.unstubAllGlobals();
  });

  it("flies by where it lies", () => {
    for (const [code, key] of [
      ["KeyW", "w"],
      ["KeyW", "z"], // AZERTY
      ["KeyS", "ы"],
      ["KeyW", ","], // Dvorak
    ] as const)
      page.press(code, key);
    expect(did).toEqual(["fly", "fly", "fly", "fly"]);
  });

  it("that types a command's letter does that alone, wherever it lies", () => {
    page.press("KeyO", "o");
    page.press("KeyS", "o"); // Dvorak
    page.press("KeyS", "O");
    page.press("KeyS", "r"); // Colemak
    page.press("KeyE", "f");
    expect(did).toEqual(["save", "save", "save", "home", "fly"]);
  });

  it("of another script is the command that lies there", () => {
    page.press("KeyR", "к"); // Russian
    page.press("KeyF", "А");
    page.press("KeyR", "ρ"); // Greek
    page.press("KeyT", "ㅅ"); // Korean
    page.press("KeyO", "щ");
    page.press("KeyF", "ä"); // in Latin it would be no F
    page.press("ArrowLeft", "ArrowLeft");
    expect(did).toEqual(["home", "fly", "home", "walk", "save"]);
  });

  it("that is let go of while Cmd is down, of which macOS tells nothing, is not held", () => {
    page.press("KeyW", "w");
    page.press("MetaLeft", "Meta");
    const drawFrame = (): void => frames.splice(0).forEach((draw) => draw(0));
    drawFrame();
    expect(frames.length).toBe(1);
    page.letGo("MetaLeft", "Meta");
    drawFrame();
    expect(frames.length).toBe(0);
  });

  it("of Esc ends what moves the view, unless it closes a sheet", () => {
    sheet = {};
    page.press("Escape", "Escape");
    expect(did).toEqual([]);
    sheet = null;
    page.press("Escape", "Escape");
    expect(did).toEqual(["stop", "stand"]);
  });

  it("that something else has taken does nothing more", () => {
    page.press("KeyO", "o", true);
    expect(did).toEqual([]);
  });
});

describe("the wheel and drags", () => {
  const camera: Camera = { eye: [0, -10, 0], target: [0, 0, 0], up: [0, 0, 1], fovyDegrees: 45 };
  const limits = { min: 0.01, max: 1000 };
  let canvas: EventTarget;
  let moved: Camera | undefined;
  let aim: Aim | undefined;
  const send = (type: string, values: object): void => {
    const at = { clientX: 500, clientY: 100, button: 2, pointerId: 1, timeStamp: 1 };
    const event = new Event(type, { cancelable: true });
    for (const [key, value] of Object.entries({ ...at, ...values }))
      Object.defineProperty(event, key, { value });
    canvas.dispatchEvent(event);
  };
  const wheel = (): Camera | undefined => {
    send("wheel", { deltaMode: 0, deltaY: -100 });
    return moved;
  };
  const drag = (): Camera | undefined => {
    send("pointerdown", {});
    send("pointermove", { clientX: 530, clientY: 90 });
    send("pointerup", {});
    return moved;
  };
  let controls: Controls;

  beforeEach(() => {
    vi.stubGlobal("window", new EventTarget());
    canvas = Object.assign(new EventTarget(), {
      clientHeight: 300,
      getBoundingClientRect: () => ({ left: 100, top: 0, width: 800, height: 300 }),
      focus: () => {},
      setPointerCapture: () => {},
    });
    const holder: Partial<CameraHolder> = {
      camera,
      limits,
      isWalking: false,
      isFlying: false,
      move: (to) => (moved = to),
      dragEnded: () => {},
      aimAt: () => aim,
    };
    controls = new Controls(canvas as HTMLCanvasElement, holder as CameraHolder);
  });
  afterEach(() => {
    controls.close();
    vi.unstubAllGlobals();
  });

  it("go by the canvas in a picture of the camera's own", () => {
    aim = undefined;
    expect(wheel()).toEqual(zoom(camera, Math.exp(-0.15), 0, -50, 300, limits));
    expect(drag()).toEqual(pan(camera, 30, -10, 300));
  });

  it("zoom by as much as fingers on a trackpad spread", () => {
    aim = undefined;
    const pinch = (deltaY: number): Camera | undefined => {
      send("wheel", { deltaMode: 0, deltaY, ctrlKey: true });
      return moved;
    };
    expect(pinch(-100 * Math.log(1.25))?.eye[1]).toBeCloseTo(camera.eye[1] / 1.25);
    expect(pinch(120)).toEqual(zoom(camera, Math.exp(0.5), 0, -50, 300, limits));
    send("wheel", { deltaMode: 1, deltaY: 3, ctrlKey: true }); // a mouse's, for sure
    expect(moved).toEqual(zoom(camera, Math.exp(99 * 0.0015), 0, -50, 300, limits));
  });

  it("go by the view that they are on in another", () => {
    aim = { x: 7, y: -9, perPixel: { x: 2, y: 3 } };
    expect(wheel()).toEqual(zoom(camera, Math.exp(-0.15), 7, -9, 300, limits));
    expect(drag()).toEqual(pan(camera, 60, -30, 300));
  });
});
