// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { defaultLook } from "../look";
import { Shading } from "../protocol/messages";
import { decodeView } from "../share";
import type { Numbers } from "../state";
import { State } from "../state";
import { exactPicture, keepAddress } from "./views";

describe("A picture to save", () => {
  const state = new State();
  beforeEach(() => {
    vi.useFakeTimers({ toFake: ["setTimeout", "performance"] });
    state.connection.set({ kind: "connected" });
  });
  afterEach(() => void vi.useRealTimers());

  it("comes once it is exact", async () => {
    let exact: Blob | undefined;
    const picture = exactPicture(state, {
      exactNow: () => exact && { png: exact, revision: 1n },
    });
    await vi.advanceTimersByTimeAsync(1000);
    exact = new Blob(["exact"]);
    await vi.advanceTimersByTimeAsync(100);
    expect(await picture).toBe(exact);
  });

  it("is not waited for without a connection, which is said", async () => {
    const viewer = { exactNow: () => undefined };
    const told = vi.fn();
    void exactPicture(state, viewer).then(told);
    await vi.advanceTimersByTimeAsync(1000);
    expect(told).not.toHaveBeenCalled();
    state.connection.set({ kind: "lost", since: 0, refusal: "" });
    await vi.advanceTimersByTimeAsync(100);
    expect(told).toHaveBeenLastCalledWith(expect.stringContaining("without a connection"));
  });
});

describe("The address", () => {
  let [hash, written, edited] = ["", 0, () => {}];
  beforeEach(() => {
    vi.useFakeTimers({ toFake: ["setTimeout", "clearTimeout", "performance"] });
    [hash, written] = ["", 0];
    vi.stubGlobal("window", {
      get location() {
        return { hash };
      },
      history: {
        replaceState: (_: null, __: string, url: string) => {
          hash = url;
          written += 1;
        },
      },
      addEventListener: (_: string, listener: () => void) => (edited = listener),
      setTimeout: (...all: Parameters<typeof setTimeout>) => setTimeout(...all),
      clearTimeout: (timer: ReturnType<typeof setTimeout>) => clearTimeout(timer),
    });
  });
  afterEach(() => {
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });

  const keep = () => {
    const state = new State();
    let tau = 1;
    const camera = { eye: [0, -9, 5], target: [0, 0, 0], up: [0, 0, 1], fovyDegrees: 45 } as const;
    const rest = { budget: null, shading: Shading.SMOOTH, look: defaultLook };
    keepAddress(state, { sharedView: () => ({ camera, tau, ...rest }), show: () => {} });
    const draw = (of: number): void => {
      tau = of;
      state.numbers.set({ exact: true } as Numbers);
    };
    return draw;
  };
  const tauOfAddress = () => decodeView(hash)?.tau;

  it("follows exact pictures, once a second at most, to the last", async () => {
    const draw = keep();
    for (let tau = 1; tau <= 300; ++tau) {
      draw(tau);
      await vi.advanceTimersByTimeAsync(50);
    }
    expect(written).toBeLessThanOrEqual(16);
    await vi.advanceTimersByTimeAsync(1000);
    expect(tauOfAddress()).toBe(300);
    await vi.advanceTimersByTimeAsync(1000);
    draw(7);
    expect(tauOfAddress()).toBe(7);
  });

  it("is not written where it stays", async () => {
    const draw = keep();
    for (let i = 0; i < 5; ++i) {
      draw(2);
      await vi.advanceTimersByTimeAsync(1500);
    }
    expect(written).toBe(1);
  });

  it("is not overwritten by what was seen before it was edited", async () => {
    const draw = keep();
    draw(1);
    draw(2);
    hash = hash.replace("tau=1", "tau=3");
    edited();
    await vi.advanceTimersByTimeAsync(2000);
    expect(tauOfAddress()).toBe(3);
  });
});
