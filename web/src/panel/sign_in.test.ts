// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { signIn, signInAgain } from "./sign_in";

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

/** As much of an element as a form needs. */
class FakeElement extends EventTarget {
  value = "";
  textContent = "";
  children: unknown[] = [];
  isGone = false;
  append = (...children: unknown[]): void => void this.children.push(...children);
  after = this.append;
  setAttribute(): void {}
  focus(): void {}
  remove(): void {
    this.isGone = true;
  }
}

it("asks once for a token that several wait for, and all go on with it", async () => {
  await signIn();
  const made: [string, FakeElement][] = [];
  vi.stubGlobal("HTMLElement", FakeElement);
  vi.stubGlobal("document", {
    getElementById: () => new FakeElement(),
    createElement: (tag: string) => {
      const element = new FakeElement();
      made.push([tag, element]);
      return element;
    },
  });
  const all = (tag: string): FakeElement[] =>
    made.filter(([each]) => each === tag).map(([, element]) => element);
  asked.mockClear();
  asked.mockResolvedValueOnce(new Response(null, { status: 401 }));
  const went: string[] = [];
  const waiting = ["socket", "reports"].map((who) => signInAgain().then(() => went.push(who)));
  await vi.waitFor(() => expect(all("form")).toHaveLength(1));
  waiting.push(signInAgain().then(() => went.push("poster")));
  expect(asked).toHaveBeenCalledTimes(1);
  expect(all("p")[0]?.textContent).toContain("wants a token");
  expect(went).toEqual([]);

  all("input")[0]!.value = "secret";
  all("form")[0]!.dispatchEvent(new Event("submit"));
  await Promise.all(waiting);
  expect(went).toEqual(["socket", "reports", "poster"]);
  expect(all("form")).toHaveLength(1);
  expect(all("section")[0]?.isGone).toBe(true);

  asked.mockClear();
  await signInAgain();
  expect(asked, "which is looked at anew another time").toHaveBeenCalledTimes(1);
});
