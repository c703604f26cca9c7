// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { ViewerPlaceSchema } from "../protocol/gen/eyrie/v1/viewer_pb";
import { defaultLook } from "../look";
import { Shading } from "../protocol/messages";
import { decodeView } from "../share";
import { placeText, sharedPage } from "./session";

describe("a view that is shared", () => {
  it("is the one that is wanted, whatever the address says", () => {
    const camera = { eye: [0, -9, 5], target: [0, 0, 0], up: [0, 0, 1], fovyDegrees: 45 } as const;
    const rest = { tau: 3, budget: null, shading: Shading.SMOOTH, look: defaultLook };
    const page = "https://host/below/?canvas=wall#eye=1,2,3&at=4,5,6&tau=1";
    const shared = new URL(sharedPage(page, "review", { camera, ...rest }));
    expect(shared.origin + shared.pathname).toBe("https://host/below/");
    expect(shared.searchParams.get("session")).toBe("review");
    expect(shared.searchParams.get("canvas")).toBe("wall");
    expect(decodeView(shared.hash)).toEqual({ camera, ...rest });
    expect(new URL(sharedPage(page, "review", null)).hash).toBe(new URL(page).hash);
  });
});

describe("a place in a session", () => {
  it("says how many see the view, and who moves it", () => {
    const place = { session: "review", viewers: 3, leads: false, led: true };
    const text = (by: Partial<typeof place>) =>
      placeText(create(ViewerPlaceSchema, { ...place, ...by }));
    expect(text({})).toBe("3 viewers · you watch");
    expect(text({ leads: true })).toBe("3 viewers · you lead");
    expect(text({ viewers: 1, led: false })).toBe("1 viewer · nobody leads");
  });

  it("says who shows pictures together with it, and who is too late for that", () => {
    const place = { session: "wall", viewers: 3, leads: true, led: true, barrier: "b" };
    const text = (together: number, behind: number) =>
      placeText(create(ViewerPlaceSchema, { ...place, together, behind }));
    expect(text(3, 0)).toBe("3 viewers · you lead · 3 screens together");
    expect(text(3, 1)).toBe("3 viewers · you lead · 1 of 3 screens late, not waited for");
    expect(text(1, 0)).toBe("3 viewers · you lead");
  });
});
