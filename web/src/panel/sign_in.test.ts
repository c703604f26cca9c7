// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { signIn } from "./sign_in";

let [hash, edited] = ["", () => {}];
const asked = vi.fn((_url: string, _init?: RequestInit) => Promise.resolve(new Response()));

beforeEach(() => {
  vi.stubGlobal("fetch", asked);
  vi.stubGlobal("window", {
    get location() {
      return { pathname: "/page", search: "?session=a", hash };
    },
    history: {
      replaceState: (_: null, __: string, url: string) => (hash = url.replace(/^[^#]*/, "")),
    },
    addEventListener: (_: string, listener: () => void) => (edited = listener),
  });
});
afterEach(() => void vi.unstubAllGlobals());

it("takes the token of a link that is opened later out of the address at once", async () => {
  await signIn();
  asked.mockClear();
  hash = "#token=secret&eye=1,2,3";
  edited();
  expect(hash).toBe("#eye=1,2,3");
  expect(asked.mock.calls[0]?.[1]?.headers).toEqual({ Authorization: "Bearer secret" });
  asked.mockClear();
  edited();
  expect(asked).not.toHaveBeenCalled();
});
