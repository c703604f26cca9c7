// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { SessionStateSchema } from "./protocol/gen/eyrie/v1/viewer_pb";
import { ShownScene } from "./shown_scene";

const session = (size: number, ...objectNames: string[]) =>
  create(SessionStateSchema, {
    objectNames,
    sceneBounds: { min: { x: 0, y: 0, z: 0 }, max: { x: size, y: size, z: size } },
  });
const same = { isElsewhere: false, hasOtherObjects: false };

describe("the scene that is shown", () => {
  it("is the same after a reconnection, and while there is none", () => {
    const shown = new ShownScene();
    expect(shown.next(create(SessionStateSchema))).toEqual(same);
    expect(shown.next(session(2, "hill", "tower"))).toEqual(same);
    expect(shown.next(create(SessionStateSchema))).toEqual(same);
    expect(shown.next(session(2, "hill", "tower"))).toEqual(same);
  });

  it("is another where it reaches elsewhere", () => {
    const shown = new ShownScene();
    shown.next(session(2, "hill"));
    expect(shown.next(session(3, "hill"))).toEqual({ isElsewhere: true, hasOtherObjects: true });
    expect(shown.next(session(3, "hill"))).toEqual(same);
  });

  it("has other objects where one has gone, though it reaches as far", () => {
    const shown = new ShownScene();
    shown.next(session(2, "hill", "tower", "bridge"));
    const change = { isElsewhere: false, hasOtherObjects: true };
    expect(shown.next(session(2, "hill", "bridge"))).toEqual(change);
    expect(shown.next(session(2, "bridge", "hill"))).toEqual(change);
  });
});
