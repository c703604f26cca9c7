// SPDX-License-Identifier: Apache-2.0
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { refusalOf } from "./refusal";

describe("why a server takes no connection", () => {
  beforeEach(() => vi.stubGlobal("window", { location: { origin: "https://host:1" } }));
  afterEach(() => vi.unstubAllGlobals());

  function answering(type: string, body: string, headers: Record<string, string> = {}) {
    const asked = vi.fn((_url: string, _init?: RequestInit) =>
      Promise.resolve(
        new Response(body, { status: 403, headers: { "Content-Type": type, ...headers } }),
      ),
    );
    vi.stubGlobal("fetch", asked);
    return asked;
  }

  it("is asked for at the same address, with where the page is", async () => {
    const asked = answering("application/problem+json", '{"detail":"no"}', { "Retry-After": "5" });
    expect(await refusalOf("wss://host:1/ws?session=a")).toEqual({ text: "no", retryAfter: 5000 });
    expect(asked.mock.calls[0]?.[0]).toBe("https://host:1/ws?session=a");
    expect(asked.mock.calls[0]?.[1]?.headers).toEqual({ "Eyrie-Page-Origin": "https://host:1" });
  });

  it("keeps no page away for more than a minute, whatever the server says", async () => {
    const wait = async (seconds: string) => {
      answering("application/problem+json", '{"detail":"no"}', { "Retry-After": seconds });
      return (await refusalOf("ws://host/ws"))?.retryAfter;
    };
    expect(await wait("86400")).toBe(60_000);
    expect(await wait("-1")).toBe(0);
    expect(await wait("Fri, 31 Dec 1999 23:59:59 GMT")).toBe(0);
  });

  it("is not known where none answers, or something else does", async () => {
    answering("text/html", "<h1>Bad gateway</h1>");
    expect(await refusalOf("ws://host/ws")).toBeUndefined();
    answering("application/problem+json", "{}");
    expect(await refusalOf("ws://host/ws")).toBeUndefined();
    vi.stubGlobal("fetch", () => Promise.reject(new Error("refused")));
    expect(await refusalOf("ws://host/ws")).toBeUndefined();
  });
});
