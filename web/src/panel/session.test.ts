// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { ViewerPlaceSchema } from "../protocol/gen/eyrie/v1/viewer_pb";
import { placeText } from "./session";

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
