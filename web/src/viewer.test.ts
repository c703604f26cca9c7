// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { State } from "./state";
import { Viewer } from "./viewer";

class FakeWindow extends EventTarget {
  readonly devicePixelRatio = 1;
  setInterval(): void {}
  clearInterval(): void {}
  matchMedia(): EventTarget {
    return new EventTarget();
  }
}

describe("a viewer that was closed", () => {
  let frames: (() => void)[] = [];
  const drawFrame = (): void => frames.splice(0).forEach((draw) => draw());

  beforeEach(() => {
    frames = [];
    vi.stubGlobal("window", new FakeWindow());
    vi.stubGlobal("requestAnimationFrame", (draw: () => void) => frames.push(draw));
    vi.stubGlobal(
      "Worker",
      class {
        postMessage(): void {}
        terminate(): void {}
      },
    );
    vi.stubGlobal(
      "ResizeObserver",
      class {
        observe(): void {}
        disconnect(): void {}
      },
    );
    vi.stubGlobal(
      "WebSocket",
      class {
        close(): void {}
      },
    );
  });
  afterEach(() => void vi.unstubAllGlobals());

  it("asks for no more frames, whatever becomes of the state", () => {
    const canvas = Object.assign(new EventTarget(), {
      style: {},
      transferControlToOffscreen: () => ({}),
    });
    const state = new State();
    const viewer = new Viewer(canvas as unknown as HTMLCanvasElement, "ws://host/ws", state);
    viewer.steering.camera = { eye: [0, -1, 0], target: [0, 0, 0], up: [0, 0, 1], fovyDegrees: 45 };
    state.connection.set({ kind: "connected" });
    drawFrame();
    expect(frames.length).toBe(1); // what could not be sent goes with the next frame
    viewer.close();
    drawFrame();
    expect(frames.length).toBe(0);
    state.tau.set(3);
    state.output.set({ ...state.output.value, eye: "left" });
    state.walking.set(true);
    expect(frames.length).toBe(0);
    expect(state.walking.value).toBe(true); // nobody is left whom the ground might fail
  });
});
