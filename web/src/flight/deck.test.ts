// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { Camera } from "../camera/camera";
import { defaultLook } from "../look";
import { Shading } from "../protocol/messages";
import type { SharedView } from "../share";
import type { ExactPicture } from "../viewer";
import type { Stage } from "./deck";
import { FlightDeck } from "./deck";
import { withKey } from "./flight";

const cameraAt = (x: number): Camera => ({
  eye: [x, 0, 5],
  target: [x, 10, 4],
  up: [0, 0, 1],
  fovyDegrees: 45,
});

class StageOfTest implements Stage {
  camera: Camera | null = cameraAt(0);
  movements = 0;
  isWatching = false;
  readonly watchingText = "another moves the view";
  exact: Blob | undefined;
  readonly pictureSize = { width: 64, height: 36 };
  tau = 1;
  sharedView(): SharedView | null {
    const rest = { budget: null, shading: Shading.SMOOTH, look: defaultLook };
    return this.camera && { camera: this.camera, tau: this.tau, ...rest };
  }
  move(camera: Camera): void {
    if (this.isWatching) return;
    this.camera = camera;
    this.movements += 1;
  }
  moveAlong(camera: Camera): void {
    this.move(camera);
  }
  revision = 1n;
  exactNow(): ExactPicture | undefined {
    return this.exact && { png: this.exact, revision: this.revision };
  }
}

describe("A flight deck", () => {
  const [told, stage] = [vi.fn(), new StageOfTest()];
  const deck = new FlightDeck(stage, stage, told);
  const frameMs = 20;
  const frame = () => vi.advanceTimersByTime(frameMs);

  beforeEach(() => {
    vi.useFakeTimers({ toFake: ["setTimeout", "clearTimeout", "performance"] });
    vi.stubGlobal("requestAnimationFrame", (step: () => void) => setTimeout(step, frameMs));
    vi.stubGlobal("cancelAnimationFrame", clearTimeout);
    stage.isWatching = false;
    stage.move(cameraAt(0));
    deck.load({ name: "", keys: [] });
  });
  afterEach(() => {
    deck.stop();
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });

  it("records from the first movement to what moved last, at the moment it is stopped", () => {
    deck.record();
    for (let i = 0; i < 5; ++i) frame();
    for (let x = 1; x <= 10; ++x) {
      stage.move(cameraAt(x));
      frame();
    }
    vi.advanceTimersByTime(frameMs / 2);
    stage.move(cameraAt(11));
    deck.stop();
    const { keys } = deck.flight.value;
    expect(keys[0]?.camera).toEqual(cameraAt(0));
    expect(keys[keys.length - 1]?.camera).toEqual(cameraAt(11));
    expect(deck.length).toBeCloseTo(0.21, 9);
  });

  it("keeps its flight where nothing moved while it recorded", () => {
    const kept = { name: "kept", keys: [{ seconds: 0, camera: cameraAt(3) }] };
    deck.load(kept);
    deck.record();
    for (let i = 0; i < 5; ++i) frame();
    deck.stop();
    expect(deck.flight.value).toEqual(kept);
    expect(told).toHaveBeenLastCalledWith("Nothing moved: the flight stays as it was");
  });

  it("adds keys to what it records, which ends with them", () => {
    deck.load({ name: "", keys: [{ seconds: 0, camera: cameraAt(30) }] });
    deck.record();
    for (let x = 1; x <= 10; ++x) {
      stage.move(cameraAt(x));
      frame();
    }
    deck.edit((keys) => withKey(keys, { seconds: 99, camera: cameraAt(-1) }));
    expect(deck.activity.value.kind).toBe("idle");
    const places = deck.flight.value.keys.map(({ camera }) => camera.eye[0]);
    expect([places[0], ...places.slice(-2)]).toEqual([0, 10, -1]);
  });

  it("plays until a hand steers", () => {
    const keys = [0, 1, 2].map((i) => ({ seconds: i, camera: cameraAt(10 * i) }));
    deck.load({ name: "", keys });
    deck.play();
    for (let i = 0; i < 25; ++i) frame();
    expect(deck.activity.value.kind).toBe("playing");
    expect(stage.camera?.eye[0]).toBeCloseTo(5, 0);
    stage.move(cameraAt(-1));
    for (let i = 0; i < 25; ++i) frame();
    expect(deck.activity.value.kind).toBe("idle");
    expect(stage.camera).toEqual(cameraAt(-1));
  });

  it("shows nothing and saves no pictures of what another moves", async () => {
    const keys = [0, 1, 2].map((i) => ({ seconds: i, camera: cameraAt(10 * i) }));
    deck.load({ name: "", keys });
    stage.isWatching = true;
    stage.exact = new Blob(["the leader's picture"]);
    const why = stage.watchingText;
    await expect(deck.draw(1)).rejects.toThrow(why);
    expect(deck.activity.value.kind).toBe("idle");
    for (const show of [() => deck.play(), () => deck.seek(1)]) {
      told.mockClear();
      show();
      expect(told).toHaveBeenLastCalledWith(why);
      expect(deck.activity.value.kind).toBe("idle");
    }
  });

  const flightOf = (seconds: number) =>
    deck.load({
      name: "",
      keys: [0, 1].map((i) => ({ seconds: i * seconds, camera: cameraAt(i) })),
    });

  it("begins no pictures that a ZIP does not hold, and says how many it does", async () => {
    flightOf(2200);
    await expect(deck.draw(30)).rejects.toThrow(
      "holds 65534 pictures, and these are 66001: up to 29",
    );
    flightOf(100_000);
    await expect(deck.draw(1)).rejects.toThrow("shorten the flight");
    expect(deck.activity.value.kind).toBe("idle");
  });

  it("saves what came before the ZIP was full, and says so", async () => {
    flightOf(4);
    const bytes = { arrayBuffer: () => Promise.resolve(new ArrayBuffer(0)) };
    stage.exact = { size: 2 ** 30, ...bytes } as Blob;
    expect(await deck.draw(1)).toBeInstanceOf(Blob);
    expect(told).toHaveBeenLastCalledWith("A ZIP file holds 4 GiB: 3 of 5 pictures are saved");
    expect(deck.activity.value.kind).toBe("idle");
  });

  it("saves no pictures that differ in more than the camera", async () => {
    flightOf(4);
    stage.exact = new Blob(["a picture"]);
    const end = deck.activity.watch((activity) => {
      if (activity.kind === "drawing" && activity.frame === 2) stage.tau = 2;
    });
    await expect(deck.draw(1)).rejects.toThrow("Settings have changed meanwhile");
    end();
    expect(await deck.draw(1)).toBeInstanceOf(Blob);
  });

  it("saves no pictures of two scenes", async () => {
    flightOf(4);
    stage.exact = new Blob(["a picture"]);
    const end = deck.activity.watch((activity) => {
      if (activity.kind === "drawing" && activity.frame === 2) stage.revision += 1n;
    });
    await expect(deck.draw(1)).rejects.toThrow("What is shown was changed meanwhile");
    end();
    expect(deck.activity.value.kind).toBe("idle");
    expect(await deck.draw(1)).toBeInstanceOf(Blob);
  });

  it("ends a recording after ten minutes, and says why", () => {
    deck.record();
    stage.move(cameraAt(1));
    vi.advanceTimersByTime(601_000);
    expect(deck.activity.value.kind).toBe("idle");
    expect(told).toHaveBeenLastCalledWith(
      expect.stringMatching(/^A recording ends after 10 minutes: \d+ views as/),
    );
  });

  it("stops where another takes the lead", () => {
    const keys = [0, 1, 2].map((i) => ({ seconds: i, camera: cameraAt(10 * i) }));
    deck.load({ name: "", keys });
    deck.play();
    frame();
    stage.isWatching = true;
    for (let i = 0; i < 3; ++i) frame();
    expect(deck.activity.value.kind).toBe("idle");
  });
});
