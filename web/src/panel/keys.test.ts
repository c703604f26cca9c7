// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { isCommand } from "../camera/commands";
import { onHeldKeys, onKeys } from "./keys";

type Pressed = Partial<Pick<KeyboardEvent, "ctrlKey" | "altKey" | "metaKey" | "repeat">>;

describe("keys", () => {
  const did: string[] = [];
  let page: EventTarget;
  const press = (key: string, by: Pressed = {}, isAltGraph = false): boolean => {
    const getModifierState = (name: string) => name === "AltGraph" && isAltGraph;
    const event = new Event("keydown", { cancelable: true });
    page.dispatchEvent(Object.assign(event, { key, getModifierState, ...by }));
    return did.splice(0).length > 0;
  };

  beforeEach(() => {
    page = new EventTarget();
    vi.stubGlobal("window", page);
    vi.stubGlobal("Element", class {});
    onKeys({ c: () => did.push("contours") });
    onHeldKeys({ "[": () => did.push("lower"), "\\": () => did.push("true") });
  });
  afterEach(() => void vi.unstubAllGlobals());

  it("go on while they are held, where that is meant", () => {
    expect([press("["), press("[", { repeat: true })]).toEqual([true, true]);
    expect([press("c"), press("c", { repeat: true })]).toEqual([true, false]);
    expect(isCommand("\\")).toBe(true);
  });

  it("leave the browser its own", () => {
    for (const by of [{ ctrlKey: true }, { altKey: true }, { metaKey: true }])
      expect(press("c", by)).toBe(false);
    for (const by of [
      { ctrlKey: true },
      { metaKey: true },
      { ctrlKey: true, altKey: true },
      { metaKey: true, altKey: true },
    ])
      expect(press("[", by)).toBe(false);
  });

  it("of brackets are heard with AltGr and Option, where keyboards have them there", () => {
    for (const key of ["[", "\\"]) {
      expect(press(key, {}, true)).toBe(true);
      expect(press(key, { ctrlKey: true, altKey: true }, true)).toBe(true); // Windows
      expect(press(key, { altKey: true })).toBe(true); // macOS
    }
  });
});
