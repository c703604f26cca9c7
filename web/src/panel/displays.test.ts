// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { CanvasStateSchema } from "../protocol/gen/eyrie/v1/viewer_pb";
import { canvasOf, segmentOf } from "./displays";

describe("what an address names", () => {
  // As the server tells them: the second has no name, and "1" is the first one's.
  const [first, second, wall] = [
    create(CanvasStateSchema, { name: "1" }),
    create(CanvasStateSchema, { name: "#1" }),
    create(CanvasStateSchema, { name: "wall", segments: ["left", "1", "#2"] }),
  ];
  const canvases = [first!, second!, wall!];

  it("is found among canvases by its name, or else by its position", () => {
    expect(canvasOf(canvases, "")).toBe(first);
    expect(canvasOf(canvases, "wall")).toBe(wall);
    expect(canvasOf(canvases, "1")).toBe(first);
    expect(canvasOf(canvases, "2")).toBe(wall);
    expect(canvasOf(canvases, "none")).toBeUndefined();
    expect(canvasOf(canvases, "3")).toBeUndefined();
  });

  it("is a position with #, whatever is called so", () => {
    expect(canvasOf(canvases, "#0")).toBe(first);
    expect(canvasOf(canvases, "#1")).toBe(second);
    expect(canvasOf(canvases, "#2")).toBe(wall);
    expect(canvasOf(canvases, "#3")).toBeUndefined();
  });

  it("is a segment in the same way", () => {
    expect(segmentOf(wall, "left")).toBe("left");
    expect(segmentOf(wall, "0")).toBe("left");
    expect(segmentOf(wall, "#0")).toBe("left");
    expect(segmentOf(wall, "#1")).toBe("1");
    expect(segmentOf(wall, "2")).toBe("#2");
    expect(segmentOf(wall, "")).toBe("");
    expect(segmentOf(wall, "none")).toBe("");
    expect(segmentOf(undefined, "left")).toBe("");
  });
});
