// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { FrameSchema, SessionStateSchema } from "./protocol/gen/eyrie/v1/viewer_pb";
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

describe("a viewer", () => {
  let frames: (() => void)[] = [];
  const drawFrame = (): void => frames.splice(0).forEach((draw) => draw());
  const makeViewer = (state: State): Viewer => {
    const canvas = Object.assign(new EventTarget(), {
      style: {},
      transferControlToOffscreen: () => ({}),
    });
    return new Viewer(canvas as unknown as HTMLCanvasElement, "ws://host/ws", state);
  };

  beforeEach(() => {
    frames = [];
    vi.stubGlobal("window", new FakeWindow());
    vi.stubGlobal("requestAnimationFrame", (draw: () => void) => frames.push(draw));
    vi.stubGlobal("cancelAnimationFrame", () => {});
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

  it("that was closed asks for no more frames, whatever becomes of the state", () => {
    const state = new State();
    const viewer = makeViewer(state);
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

  it("that takes over a walk stays under ground until the eye comes out, and not for good", () => {
    const state = new State();
    const viewer = makeViewer(state);
    const place = (leads: boolean) =>
      viewer["sessionChanged"](create(SessionStateSchema, { place: { leads, led: true } }));
    const camera = { eye: [0, -1, 1], target: [0, 0, 1], up: [0, 0, 1], fovyDegrees: 45 };
    const ledView = { camera, tauPixels: 1, underground: true };
    const show = () => viewer["noteShown"](create(FrameSchema, { ledView }));
    place(false);
    show();
    expect(state.look.value.underground).toBe(true);
    place(true);
    for (const showsLate of [false, true]) {
      if (showsLate) show();
      expect(state.look.value.underground).toBe(false);
      expect(viewer.sharedView()?.look.underground).toBe(true);
    }
    viewer.steering.liftedTo(undefined, undefined, 1);
    expect(viewer.sharedView()?.look.underground).toBe(false);
    // What is a setting stays one, until a program ends it.
    for (const underground of [true, false]) {
      state.look.set({ ...state.look.value, underground: true });
      const view = { ...ledView, tauPixels: underground ? 2 : 3, underground };
      viewer["noteShown"](create(FrameSchema, { ledView: view }));
      expect(state.look.value.underground).toBe(underground);
    }
    viewer.close();
  });
});
