// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { ask, onUnknown } from "./ask";

let isKnown = false;
const asked = vi.fn((_address: string, { signal }: RequestInit) =>
  signal?.aborted
    ? Promise.reject(new Error("aborted"))
    : Promise.resolve(new Response(null, { status: isKnown ? 200 : 401 })),
);

beforeEach(() => {
  isKnown = false;
  asked.mockClear();
  vi.stubGlobal("fetch", asked);
});
afterEach(() => {
  onUnknown(undefined);
  vi.unstubAllGlobals();
});

it("asks once more, the same, when the user has been let in again", async () => {
  onUnknown(() => {
    isKnown = true;
    return Promise.resolve();
  });
  const request = { method: "PATCH", body: "{}" };
  expect((await ask("api", request)).status).toBe(200);
  expect(asked.mock.calls).toEqual([
    ["api", request],
    ["api", request],
  ]);
});

it("asks no third time", async () => {
  const signIn = vi.fn(() => Promise.resolve());
  onUnknown(signIn);
  expect((await ask("api", {})).status).toBe(401);
  expect(signIn).toHaveBeenCalledTimes(1);
  expect(asked).toHaveBeenCalledTimes(2);
});

it("waits for nobody where nobody can sign in, or need not", async () => {
  expect((await ask("api", {})).status).toBe(401);
  const signIn = vi.fn(() => Promise.resolve());
  onUnknown(signIn);
  isKnown = true;
  expect((await ask("api", {})).status).toBe(200);
  expect(signIn).not.toHaveBeenCalled();
});

it("ends when it is given up while the user is asked", async () => {
  onUnknown(() => new Promise(() => {}));
  const giveUp = new AbortController();
  const answer = ask("api", { signal: giveUp.signal });
  setTimeout(() => giveUp.abort());
  await expect(answer).rejects.toThrow("does not answer");
});
