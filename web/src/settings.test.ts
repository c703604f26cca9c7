// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { defaultLook } from "./look";
import { Shading } from "./protocol/messages";
import { applySettings, areSame, settingsOf, watchSettings } from "./settings";
import { State } from "./state";

const led = { tau: 4, budget: 20, shading: Shading.FLAT, look: { ...defaultLook, saturation: 0 } };

describe("settings", () => {
  it("are in the state once they are applied", () => {
    const state = new State();
    applySettings(state, led);
    expect(settingsOf(state)).toEqual(led);
    expect(areSame(settingsOf(state), { ...led, look: { ...led.look } })).toBe(true);
    expect(areSame(settingsOf(state), { ...led, budget: null })).toBe(false);
  });

  it("that are the same in another object tell nobody", () => {
    const state = new State();
    applySettings(state, led);
    let told = -1; // watching tells once
    state.look.watch(() => (told += 1));
    applySettings(state, { ...led, look: { ...led.look } });
    expect(told).toBe(0);
  });

  it("may be taken back once all have heard of them, and all hear of that, too", async () => {
    const state = new State();
    applySettings(state, led);
    const before = settingsOf(state);
    watchSettings(
      state,
      () => undefined,
      () => applySettings(state, before),
    );
    const heard: number[] = [];
    state.tau.watch((tau) => heard.push(tau));
    state.tau.set(1);
    await Promise.resolve();
    expect(heard).toEqual([4, 1, 4]);
    expect(settingsOf(state)).toEqual(led);
  });
});
