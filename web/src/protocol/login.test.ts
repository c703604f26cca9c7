// SPDX-License-Identifier: Apache-2.0
import { afterEach, describe, expect, it, vi } from "vitest";
import { logIn, splitFragment } from "./login";

describe("the fragment of a link", () => {
  it("gives its token up and keeps the view", () => {
    expect(splitFragment("#eye=1,2,3&token=abc=&tau=1")).toEqual({
      token: "abc=",
      rest: "eye=1,2,3&tau=1",
    });
    expect(splitFragment("#token=abc")).toEqual({ token: "abc", rest: "" });
    expect(splitFragment("#eye=1,2,3")).toEqual({ token: undefined, rest: "eye=1,2,3" });
    expect(splitFragment("")).toEqual({ token: undefined, rest: "" });
  });
});

describe("logging in", () => {
  afterEach(() => vi.unstubAllGlobals());

  function answering(status: number) {
    const asked = vi.fn((_url: string, _init?: RequestInit) =>
      Promise.resolve(new Response(null, { status })),
    );
    vi.stubGlobal("fetch", asked);
    return asked;
  }

  it("asks without a token whether one is needed", async () => {
    const asked = answering(401);
    expect(await logIn("/login")).toBe("needed");
    expect(asked.mock.calls[0]?.[1]?.headers).toBeUndefined();
    answering(200);
    expect(await logIn("/login")).toBe("ok");
  });

  it("sends the token in a header and never in the address", async () => {
    const asked = answering(401);
    expect(await logIn("/login", "secret")).toBe("wrong");
    expect(asked.mock.calls[0]?.[0]).toBe("/login");
    expect(asked.mock.calls[0]?.[1]?.headers).toEqual({ Authorization: "Bearer secret" });
    answering(429);
    expect(await logIn("/login", "secret")).toBe("limited");
  });

  it("knows tokens that no header can hold to be wrong", async () => {
    const asked = answering(200);
    for (const token of ["secret”", "sécret", "sec ret"])
      expect(await logIn("/login", token)).toBe("wrong");
    expect(asked).not.toHaveBeenCalled();
    expect(await logIn("/login", "aZ09-._~+/=")).toBe("ok");
  });

  it("knows a right token of which the browser keeps nothing", async () => {
    const asked = vi.fn((_url: string, init?: RequestInit) =>
      Promise.resolve(new Response(null, { status: init?.method === "POST" ? 200 : 401 })),
    );
    vi.stubGlobal("fetch", asked);
    expect(await logIn("/login", "secret")).toBe("unkept");
    expect(asked.mock.calls[1]).toEqual(["/login", { cache: "no-store" }]);
  });

  it("takes a right token for kept where the server is away right after it", async () => {
    vi.stubGlobal("fetch", (_url: string, init?: RequestInit) =>
      init?.method === "POST" ? Promise.resolve(new Response()) : Promise.reject(new Error("away")),
    );
    expect(await logIn("/login", "secret")).toBe("ok");
  });

  it("leaves a server that is away, or knows no tokens, to the stream", async () => {
    answering(404);
    expect(await logIn("/login")).toBe("ok");
    vi.stubGlobal("fetch", () => Promise.reject(new Error("refused")));
    expect(await logIn("/login")).toBe("ok");
  });
});
