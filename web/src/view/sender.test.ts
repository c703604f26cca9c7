// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import type { View } from "../protocol/messages";
import { Shading } from "../protocol/messages";
import { defaultLook } from "../look";
import { usualOutput } from "../output";
import type { WantedView } from "./sender";
import { ViewSender } from "./sender";

describe("ViewSender", () => {
  let frames: (() => void)[] = [];
  const nextFrame = () => frames.splice(0).forEach((frame) => frame());

  beforeEach(() => {
    frames = [];
    vi.stubGlobal("requestAnimationFrame", (frame: () => void) => frames.push(frame));
    vi.stubGlobal("cancelAnimationFrame", () => (frames = []));
  });
  afterEach(() => vi.unstubAllGlobals());

  const sending = () => {
    const sent: View[] = [];
    const server = { accepts: true, isConnected: true, tau: 1 as number | null };
    const wanted = (tauPixels: number): WantedView => ({
      camera: { eye: [0, 0, 9], target: [0, 0, 0], up: [0, 1, 0], fovyDegrees: 45 },
      width: 640,
      height: 360,
      tauPixels,
      budgetMilliseconds: null,
      shading: Shading.SMOOTH,
      look: defaultLook,
      output: usualOutput,
    });
    const sender = new ViewSender({
      wantedView: () => (server.tau === null ? null : wanted(server.tau)),
      sendView: (view) => {
        if (server.accepts) sent.push(view);
        return server.accepts;
      },
      isConnected: () => server.isConnected,
    });
    return { sender, server, sent };
  };

  it("sends the newest view once a frame, and the same one once", () => {
    const { sender, server, sent } = sending();
    sender.request();
    server.tau = 2;
    sender.request();
    nextFrame();
    sender.request();
    nextFrame();
    expect(sent.map(({ sequence, tauPixels }) => [sequence, tauPixels])).toEqual([[1, 2]]);
    sender.forgetLast();
    sender.request();
    nextFrame();
    expect(sent.at(-1)?.sequence).toBe(2);
  });

  it("does not wait for a frame while no picture is on its way", () => {
    const { sender, server, sent } = sending();
    sender.request();
    sender.sendUnlessWaiting();
    expect(sent.length).toBe(1);
    server.tau = 2;
    sender.request();
    sender.sendUnlessWaiting();
    expect(sent.length).toBe(1);
    sender.sendNow();
    expect(sent.length).toBe(2);
    sender.sendNow();
    expect(sent.length).toBe(2);
  });

  it("tries again what could not be sent, while there is a connection", () => {
    const { sender, server, sent } = sending();
    server.accepts = false;
    sender.request(performance.now());
    nextFrame();
    expect(frames.length).toBe(1);
    expect(sender.isNewest(0)).toBe(false);
    server.isConnected = false;
    nextFrame();
    expect(frames.length).toBe(0);
    server.accepts = true;
    sender.request();
    nextFrame();
    expect(sent.map(({ sequence }) => sequence)).toEqual([1]);
    expect(sender.isNewest(1)).toBe(true);
  });

  it("takes no view for the newest that was sent before the connection was lost", () => {
    const { sender, server } = sending();
    sender.request();
    nextFrame();
    sender.drawn(1, performance.now());
    expect(sender.isNewest(1)).toBe(true);
    sender.lost();
    server.accepts = server.isConnected = false;
    server.tau = 2;
    sender.request();
    nextFrame();
    expect(sender.isNewest(1)).toBe(false);
  });

  it("knows what a picture shows until a later one is shown", () => {
    const { sender, server } = sending();
    for (const tau of [1, 2, 3]) {
      server.tau = tau;
      sender.request();
      nextFrame();
    }
    expect(sender.shownBy(2)).toMatchObject({ width: 640, exaggeration: 1, seen: null });
    expect(sender.shownBy(1)).toBeUndefined();
    expect(sender.shownBy(2)).toBeDefined();
    expect(sender.shownBy(4)).toBeUndefined();
  });

  it("sends nothing while there is nothing to ask for", () => {
    const { sender, server, sent } = sending();
    server.tau = null;
    sender.request();
    nextFrame();
    expect(sent).toEqual([]);
    expect(sender.waitingSince()).toBeUndefined();
  });
});
