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
}

describe("a key", () => {
  const did: string[] = [];
  let page: FakeWindow;
  let controls: Controls;

  beforeEach(() => {
    did.length = 0;
    page = new FakeWindow();
    vi.stubGlobal("window", page);
    vi.stubGlobal("Element", class {});
    vi.stubGlobal("requestAnimationFrame", () => 1);
    const holder: Partial<CameraHolder> = {
      isWalking: false,
      isFlying: false,
      setFlying: (isFlying) => did.push(isFlying ? "fly" : "stop"),
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

  it("that something else has taken does nothing more", () => {
    page.press("KeyO", "o", true);
    expect(did).toEqual([]);
  });
});
