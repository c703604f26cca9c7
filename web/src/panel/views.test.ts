// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { State } from "../state";
import { exactPicture } from "./views";

describe("A picture to save", () => {
  const state = new State();
  beforeEach(() => {
    vi.useFakeTimers({ toFake: ["setTimeout", "performance"] });
    state.connection.set({ kind: "connected" });
  });
  afterEach(() => void vi.useRealTimers());

  it("comes once it is exact", async () => {
    let exact: Blob | undefined;
    const picture = exactPicture(state, { exactNow: () => exact });
    await vi.advanceTimersByTimeAsync(1000);
    exact = new Blob(["exact"]);
    await vi.advanceTimersByTimeAsync(100);
    expect(await picture).toBe(exact);
  });

  it("is not waited for without a connection, which is said", async () => {
    const viewer = { exactNow: () => undefined };
    const told = vi.fn();
    void exactPicture(state, viewer).then(told);
    await vi.advanceTimersByTimeAsync(1000);
    expect(told).not.toHaveBeenCalled();
    state.connection.set({ kind: "lost", since: 0, refusal: "" });
    await vi.advanceTimersByTimeAsync(100);
    expect(told).toHaveBeenLastCalledWith(expect.stringContaining("without a connection"));
  });
});
