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
});
