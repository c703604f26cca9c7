// SPDX-License-Identifier: Apache-2.0
import { create } from "@bufbuild/protobuf";
import { expect, it, vi } from "vitest";
import { SessionStateSchema } from "./protocol/gen/eyrie/v1/viewer_pb";
import { State, Value } from "./state";

it("A value that a listener sets at once is the last that the others hear of", () => {
  const value = new Value(false);
  value.watch((isOn) => {
    if (isOn) value.set(false);
  });
  const told = vi.fn();
  value.watch(told);
  value.set(true);
  expect(value.value).toBe(false);
  expect(told).toHaveBeenLastCalledWith(false);
});

it("Who watches is told to take the lead only where that may be", () => {
  const state = new State();
  const textFor = (mayControl: boolean): string => {
    state.session.set(create(SessionStateSchema, { place: { session: "review", mayControl } }));
    return state.watchingText("move the view");
  };
  expect(textFor(true)).toBe("You watch this session: take the lead to move the view");
  expect(textFor(false)).toBe("You watch this session and may not move the view");
});
