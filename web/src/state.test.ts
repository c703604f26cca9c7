// SPDX-License-Identifier: Apache-2.0
import { expect, it, vi } from "vitest";
import { Value } from "./state";

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
