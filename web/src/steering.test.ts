// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it, vi } from "vitest";
import type { Camera } from "./camera/camera";
import { SightSchema } from "./protocol/gen/eyrie/v1/frame_pb";
import { SeenAreaSchema, SessionStateSchema } from "./protocol/gen/eyrie/v1/viewer_pb";
import { State } from "./state";
import { Steering } from "./steering";
import type { WalkerEvents } from "./walker";

vi.mock("./camera/controls", () => ({ Controls: class {} }));

const at = (x: number, z: number): Camera => ({
  eye: [x, 0, z],
  target: [x, 20, z],
  up: [0, 0, 1],
  fovyDegrees: 45,
});

describe("Steering", () => {
  const clicked = vi.fn();
  const known: WalkerEvents["ask"] = (from, to, samples, answered) => {
    answered({ from, to, heights: Array<number>(samples).fill(0) });
    return true;
  };
  const make = (ask = known): { steering: Steering; state: State } => {
    const state = new State();
    const steering = new Steering({} as HTMLCanvasElement, state, {
      moved: () => {},
      changed: () => {},
      clicked,
      ask,
      isNewest: () => true,
      canvasSize: () => ({ width: 640, height: 360 }),
    });
    steering.move(at(0, 50));
    return { steering, state };
  };

  it("goes on under ground from a flight that was there, until it comes out", () => {
    const { steering } = make();
    steering.moveAlong(at(1, 1.7));
    steering.liftedTo(undefined, [0, 0, 0.3], 1);
    steering.move(at(2, 1.7));
    expect(steering.goesUnderground).toBe(true);
    steering.liftedTo(undefined, [0, 0, 0.3], 2);
    steering.move(at(3, 1.8));
    expect(steering.goesUnderground).toBe(true);
    steering.liftedTo(undefined, undefined, 3);
    steering.move(at(3, 9));
    expect(steering.goesUnderground).toBe(false);
  });

  it("comes out of the ground where a walk ends, before a picture shows it lifted", () => {
    for (const underground of [false, true]) {
      const { steering, state } = make();
      state.look.set({ ...state.look.value, underground });
      steering.setWalking(true);
      expect(steering.camera?.eye[2]).toBeCloseTo(1.7);
      steering.liftedTo(undefined, [0, 0, 0.3], 1);
      steering.setWalking(false);
      const z = underground ? 1.7 : 2;
      expect(steering.camera?.eye[2]).toBeCloseTo(z);
      expect(steering.camera?.target[2]).toBeCloseTo(z);
    }
  });

  it("clicks at the middle of what one eye sees, where two are beside each other", () => {
    const { steering, state } = make();
    steering.clickMiddle();
    expect(clicked).toHaveBeenLastCalledWith({ x: 320, y: 180 }, false);
    const half = (x: number) =>
      create(SeenAreaSchema, { x, width: 0.5, height: 1, sight: create(SightSchema) });
    const picture = { camera: at(0, 50), width: 640, height: 360, exaggeration: 1, hidden: [] };
    state.shown.set({ ...picture, seen: [half(0), half(0.5)], isPacked: true });
    steering.clickMiddle();
    expect(clicked).toHaveBeenLastCalledWith({ x: 160, y: 180 }, false);
  });

  it("neither walks nor flies for who watches, and says why", () => {
    const { steering, state } = make();
    const place = { leads: false, led: true };
    state.session.set(create(SessionStateSchema, { place }));
    for (const begin of ["setFlying", "setWalking"] as const) {
      state.notice.set("");
      steering[begin](true);
      expect(state.notice.value).toContain("You watch this session");
      expect([state.flying.value, state.walking.value]).toEqual([false, false]);
    }
  });

  it("does not walk where no ground can be asked for", () => {
    for (const hasView of [false, true]) {
      const { steering, state } = make(() => false);
      if (!hasView) steering.camera = null;
      steering.setWalking(true);
      expect(state.walking.value).toBe(false);
      expect(state.notice.value).toContain("cannot be asked for now");
    }
  });

  it("stays in a view or flight taken before a walk knew its ground", () => {
    for (const leave of ["jumpTo", "moveAlong"] as const) {
      let answer = (): void => {};
      const { steering, state } = make((from, to, samples, answered) => {
        answer = () => known(from, to, samples, answered);
        return true;
      });
      steering.setWalking(true);
      steering[leave](at(5, 90));
      expect(state.walking.value).toBe(false);
      answer();
      expect(steering.camera).toEqual(at(5, 90));
    }
  });

  it("is kept above ground after a flight that was there, and in another view", () => {
    const { steering } = make();
    steering.moveAlong(at(1, 90));
    steering.liftedTo(undefined, undefined, 1);
    steering.move(at(2, 90));
    expect(steering.goesUnderground).toBe(false);
    steering.moveAlong(at(1, 1.7));
    steering.liftedTo(undefined, [0, 0, 0.3], 2);
    steering.jumpTo(at(5, 1));
    expect(steering.goesUnderground).toBe(false);
  });
});
