// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { SessionStateSchema, ViewerPlaceSchema } from "../protocol/gen/eyrie/v1/viewer_pb";
import { RendererCondition } from "../protocol/messages";
import type { SessionState } from "../protocol/messages";
import type { Connection, Numbers } from "../state";
import { sharersOf } from "./equalizers";
import { count, deviceName, milliseconds, pixels } from "./format";
import { bannerFor, lossText, messageFor } from "./message";
import { sentText, triangleText } from "./numbers";
import { budgetHint, normalsText, tauHint } from "./quality";
import { readoutOf } from "./readout";
import { degradedText, missingText, rendererLine, statusOf } from "./status";

const connected: Connection = { kind: "connected" };
const lost: Connection = { kind: "lost", since: 1000, refusal: "" };
const refused: Connection = { ...lost, refusal: "too many sessions; close one" };
const closed: Connection = { kind: "closed" };

function session(alive: number, dead = 0, problem = "", isOpen = true): SessionState {
  const device = { device: "llvmpipe (LLVM 15.0.6, 256 bits)", software: true };
  const renderer = (isAlive: boolean) => ({ id: "r", device, alive: isAlive });
  return create(SessionStateSchema, {
    renderers: [...Array(alive).fill(true), ...Array(dead).fill(false)].map(renderer),
    problem,
    ...(isOpen ? { sceneBounds: { min: { x: 0 }, max: { x: 1 } } } : {}),
  });
}

describe("the status chip", () => {
  it("names the renderers and their device", () => {
    const status = statusOf(connected, session(2), false);
    expect(status).toEqual({
      level: "good",
      text: "Connected",
      detail: "2 renderers · llvmpipe (software)",
    });
  });

  it("counts those that are left", () => {
    const status = statusOf(connected, session(1, 1), false);
    expect(status.detail).toContain("1 of 2 renderers");
    expect(status.level).toBe("wait");
  });

  it("says what is missing though all are there", () => {
    const note = "3 of 4 renderers that the configuration wants are here";
    const status = statusOf(connected, { ...session(3), note }, false);
    expect(status.detail).toContain(note);
    expect(status.level).toBe("wait");
  });

  it("says who does not draw as usual, and why", () => {
    const { READY, LATE, DEAD, REFUSED } = RendererCondition;
    const why = "it has other data";
    const state = create(SessionStateSchema, {
      renderers: [
        { id: "a", alive: true, condition: READY, device: { device: "llvmpipe" } },
        { id: "b", alive: true, condition: LATE },
        { id: "c", condition: DEAD, why: "no heartbeat", sinceUnixMilliseconds: 1000n },
        { id: "d", condition: REFUSED, why },
      ],
    });
    expect(degradedText(state)).toBe("b late, c dead, d refused");
    expect(degradedText(session(2))).toBe("");
    expect(statusOf(connected, state, false).detail).toContain("d refused");
    const [ready, late, dead, refused] = state.renderers.map(rendererLine);
    expect(ready).toBe("a: llvmpipe");
    expect(late).toBe("b: late");
    expect(dead).toMatch(/^c: dead since .*:01.*: no heartbeat$/);
    expect(refused).toBe(`d: refused: ${why}`);
  });

  it("is never good without a live picture", () => {
    for (const [connection, state, stale] of [
      [lost, session(1), false],
      [closed, session(1), false],
      [{ kind: "connecting" }, null, false],
      [connected, null, false],
      [connected, session(0), false],
      [connected, session(1, 0, "the scene is gone"), false],
      [connected, session(1), true],
    ] as [Connection, SessionState | null, boolean][])
      expect(statusOf(connection, state, stale).level).not.toBe("good");
  });
});

describe("the message in place of a picture", () => {
  const titleOf = (connection: Connection, state: SessionState | null) =>
    messageFor({ connection, session: state, hasPicture: false })?.title;

  it("says what is missing, whatever it is", () => {
    expect(titleOf({ kind: "connecting" }, null)).toBe("Connecting");
    expect(titleOf(lost, null)).toBe("Eyrie does not answer");
    expect(titleOf(refused, null)).toBe("The server takes no connection");
    expect(titleOf(closed, null)).toBe("This session was closed");
    expect(titleOf(connected, session(0))).toBe("No renderer is running");
    expect(titleOf(connected, session(1, 0, "bad file"))).toBe("There is no picture");
    expect(titleOf(connected, session(1, 0, "", false))).toBe("Opening the scene");
    expect(titleOf(connected, session(1))).toBe("Drawing the first picture");
  });

  it("is the server's own where one answers and refuses", () => {
    const situation = { connection: refused, session: null, hasPicture: false };
    const message = messageFor(situation);
    expect(message?.text).toContain("Too many sessions; close one. The page tries again");
    expect(message?.command).toBeUndefined();
    expect(bannerFor({ ...situation, hasPicture: true })).toContain("Too many sessions");
    expect(statusOf(refused, null, false).text).toBe("Refused");
  });

  it("has the server's words as sentences", () => {
    const said = (state: SessionState, hasPicture: boolean) => {
      const situation = { connection: connected, session: state, hasPicture };
      return bannerFor(situation) ?? messageFor(situation)?.text;
    };
    const opening = session(1, 0, "opening the scene…");
    expect(said(opening, true)).toBe("This is the last picture. Opening the scene…");
    expect(said(opening, false)).toBe("Opening the scene…");
    const none = session(0, 1, "no renderer is connected");
    expect(said(none, true)).toMatch(/last picture. No renderer is connected.$/);
    expect(said(none, false)).toBe("No renderer is connected.");
    const named = session(1, 0, "look.saturation is 3; it must be from 0 to 2");
    expect(said(named, false)).toBe("look.saturation is 3; it must be from 0 to 2.");
  });

  it("does not promise a picture where nobody leads", () => {
    const shared = session(1);
    shared.place = create(ViewerPlaceSchema, { session: "review", viewers: 1, led: false });
    expect(titleOf(connected, shared)).toBe("Nobody leads");
    const alone = { connection: connected, session: shared, hasPicture: false };
    expect(messageFor(alone)?.text).not.toContain("Take the lead");
    shared.place.mayControl = true;
    expect(messageFor(alone)?.text).toContain("Take the lead");
    shared.place.led = true;
    expect(titleOf(connected, shared)).toBe("Drawing the first picture");
  });

  it("gives the command that starts a renderer", () => {
    const situation = { connection: connected, session: session(0), hasPicture: false };
    expect(messageFor(situation)?.command).toContain("eyrie renderer");
    const told = { ...situation, session: session(0, 0, "no renderer is connected; wait") };
    expect(messageFor(told)?.command).toBeUndefined(); // the server says what to do
  });

  it("tells a browser that cannot draw which can, whatever the connection does", () => {
    const situation = { connection: lost, session: session(1), hasPicture: false };
    const message = messageFor({ ...situation, cannotDraw: true });
    expect(message?.title).toContain("cannot be drawn");
    expect(message?.text).toContain("Firefox 114");
  });

  it("leaves a picture alone, and says when that is not live", () => {
    const situation = { connection: lost, session: session(1), hasPicture: true };
    expect(messageFor(situation)).toBeNull();
    expect(bannerFor(situation)).toContain("Connection lost");
    expect(lossText(lost, 4200)).toBe("3 s");
    expect(bannerFor({ ...situation, connection: closed })).toContain("Load the page again");
    expect(bannerFor({ ...situation, connection: connected })).toBeNull();
    expect(bannerFor({ ...situation, connection: connected, session: session(0, 2) })).toContain(
      "No renderer is left",
    );
  });
});

const numbers: Numbers = {
  frameNumber: 1,
  viewSequence: 1,
  width: 1,
  height: 1,
  still: false,
  exact: false,
  pixelHash: 0,
  quality: 75,
  tiles: 0,
  isVideo: false,
  linkBytesPerSecond: 0,
  pictureBytes: 0,
  cullMilliseconds: 0,
  drawMilliseconds: 0,
  readbackMilliseconds: 0,
  tauAsked: 1,
  budgetMilliseconds: 0,
  predictedMilliseconds: 0,
  budgetTau: 0,
  tauAchieved: 1,
  normalMeanDegrees: 0,
  normalDegrees: 0,
  complete: true,
  pagesMissing: 0,
  pagesFailed: 0,
  triangles: 1,
  renderMilliseconds: 1,
  limitedBy: "",
  fps: 1,
  waits: false,
  inputToDrawnMilliseconds: 1,
  frozen: false,
  parts: [],
};

describe("numbers", () => {
  it("explain an error above the one asked for", () => {
    expect(tauHint(numbers)).toBe("");
    expect(tauHint({ ...numbers, tauAchieved: 1.5 })).toContain("finest data drawn");
    expect(tauHint({ ...numbers, tauAchieved: Infinity, complete: false })).toContain("incomplete");
    const loading = { ...numbers, tauAchieved: 9, complete: false, pagesMissing: 3 };
    expect(tauHint(loading)).toContain("refining");
    expect(tauHint({ ...numbers, frozen: true })).toContain("nothing is promised");
  });

  it("say what a frame time costs, and whether it can be held", () => {
    const timed = { ...numbers, budgetMilliseconds: 33, predictedMilliseconds: 30 };
    expect(tauHint({ ...timed, budgetTau: 4, tauAchieved: 3.9 })).toContain("in time");
    expect(tauHint({ ...timed, budgetTau: 1, tauAchieved: 1.5 })).toContain("finest data drawn");
    expect(budgetHint(numbers)).toBe("");
    expect(budgetHint(timed)).toBe("");
    expect(budgetHint({ ...timed, predictedMilliseconds: 50 })).toContain("takes longer");
  });

  it("say what is being loaded and what cannot be read", () => {
    expect(missingText(null)).toBe("");
    expect(missingText(numbers)).toBe("");
    expect(missingText({ ...numbers, pagesMissing: 1 })).toBe("loading 1 page");
    expect(missingText({ ...numbers, pagesMissing: 5, pagesFailed: 2 })).toBe(
      "loading 3 pages, 2 pages unreadable",
    );
    expect(missingText({ ...numbers, pagesMissing: 2, pagesFailed: 2 })).toBe("2 pages unreadable");
  });

  it("are short", () => {
    expect([0, 999, 1000, 12345, 999_999, 1_740_000, 2e12].map(count)).toEqual([
      "0",
      "999",
      "1.00 k",
      "12.3 k",
      "1.00 M",
      "1.74 M",
      "2.00 T",
    ]);
    expect([0.25, 1, 12.34, Infinity].map(pixels)).toEqual([
      "0.25 px",
      "1.00 px",
      "12.4 px",
      "∞ px",
    ]);
    expect([0, 0.001, 0.931, 1 + 1e-7, 9.999, 9.9901].map(pixels)).toEqual([
      "0.00 px",
      "0.01 px",
      "0.94 px",
      "1.00 px",
      "10.0 px",
      "10.0 px",
    ]);
    expect([NaN, 4.24, 33.3].map(milliseconds)).toEqual(["–", "4.2 ms", "33 ms"]);
    expect(triangleText(412_000, 1_740_000)).toBe("412 k of 1.74 M");
    expect(deviceName("NVIDIA H200/PCIe/SSE2")).toBe("NVIDIA H200");
  });
});

describe("normals drawn", () => {
  it("are said to be off where meshes are not in full detail", () => {
    expect(normalsText(null)).toBeNull();
    expect(normalsText(numbers)).toBeNull();
    const off = { ...numbers, normalMeanDegrees: 7.42, normalDegrees: 180 };
    expect(normalsText(off)?.value).toBe("7.5° on average");
    expect(normalsText({ ...off, normalDegrees: 27.02 })?.title).toContain("at most 28° anywhere");
    expect(normalsText(off)?.title).toContain("at most 180° anywhere");
  });
});

describe("the readout", () => {
  it("has speed, error and how a picture was sent in one line", () => {
    expect(readoutOf({ ...numbers, fps: 26, inputToDrawnMilliseconds: 48 }, 9.9e6)).toEqual({
      speed: "26 fps · 48 ms · 9.9 Mbit/s",
      error: "1.00 px",
      isWarning: false,
      sent: "JPEG 75",
    });
    const atRest = { ...numbers, fps: 0, inputToDrawnMilliseconds: NaN, exact: true };
    expect(readoutOf(atRest, 0)).toMatchObject({ speed: "at rest", sent: "exact" });
    expect(readoutOf({ ...atRest, waits: true }, 0).speed).toBe("waiting");
  });

  it("warns of an error that is not the one asked for, and of data that are missing", () => {
    expect(readoutOf({ ...numbers, tauAchieved: 1.5 }, 0).isWarning).toBe(true);
    expect(readoutOf({ ...numbers, complete: false }, 0)).toMatchObject({
      isWarning: true,
      sent: "JPEG 75, incomplete",
    });
  });
});

describe("sentText", () => {
  it("says exact only where that was compared", () => {
    const sent = { exact: false, quality: 0, isVideo: false, tiles: 0 };
    expect(sentText({ ...sent, quality: 75 })).toBe("JPEG 75");
    expect(sentText({ ...sent, quality: 75, tiles: 2 })).toBe("JPEG 75 in 2 tiles");
    expect(sentText(sent)).toBe("lossless");
    expect(sentText({ ...sent, isVideo: true })).toBe("H.264");
    expect(sentText({ ...sent, exact: true })).toBe("exact");
  });
});

describe("who shares the work", () => {
  const shared = (layouts: string[], ...renderers: [id: string, condition: RendererCondition][]) =>
    sharersOf(
      create(SessionStateSchema, {
        canvases: [{ layouts }],
        renderers: renderers.map(([id, condition]) => ({ id, condition })),
      }),
    );
  const { READY, LATE, OPENING, DEAD } = RendererCondition;

  it("is another when a renderer comes or goes, though there are the same layouts", () => {
    const two = shared(["2D", "DB"], ["a", READY], ["b", READY]);
    expect(shared(["2D", "DB"], ["a", READY], ["b", READY], ["c", READY])).not.toBe(two);
    expect(shared(["2D", "DB"], ["a", READY], ["b", DEAD])).not.toBe(two);
    expect(shared(["2D"], ["a", READY], ["b", READY])).not.toBe(two);
    expect(shared(["2D", "DB"], ["a", READY], ["b", LATE], ["c", OPENING])).toBe(two);
    expect(sharersOf(null)).not.toBe(two);
  });
});
