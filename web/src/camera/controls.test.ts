// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { onKeys } from "../panel/keys";
import { Controls } from "./controls";
import type { CameraHolder } from "./controls";

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
