// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from "vitest";
import { joiningOf, misreadJoining, newName, pageIn, socketUrl } from "./place";

describe("the session that an address names", () => {
  it("is one of its own where nothing is said, or what the server would refuse", () => {
    const own = { session: "", role: "lead" };
    expect(joiningOf("")).toEqual(own);
    expect(joiningOf("?session=a%20b")).toEqual(own);
    expect(joiningOf(`?session=${"a".repeat(65)}`)).toEqual(own);
    expect(socketUrl("http://host:8080/#eye=1,2,3", joiningOf(""), "v")).toBe("ws://host:8080/ws");
  });

  it("is told to be none where the address says something else", () => {
    for (const fine of ["", "?session=a-1_b.c", "?session=a&role=watch", "?session=a&role=lead"])
      expect(misreadJoining(fine)).toBe("");
    expect(misreadJoining("?session=my%20view")).toContain("names no session");
    expect(misreadJoining("?session=a&role=wacth")).toContain("role=wacth");
    expect(misreadJoining("?role=watch")).toContain("no session");
  });

  it("is joined under its name, to lead or to watch", () => {
    expect(joiningOf("?session=review")).toEqual({ session: "review", role: "lead" });
    const watching = joiningOf("?eye=left&session=a-1_b.c&role=watch");
    expect(watching).toEqual({ session: "a-1_b.c", role: "watch" });
    expect(socketUrl("https://host/under/?session=x#y", watching, "v")).toBe(
      "wss://host/under/ws?session=a-1_b.c&role=watch&viewer=v",
    );
  });

  it("comes back from the page's address in it, which keeps the rest", () => {
    const joining = { session: "review", role: "watch" } as const;
    const page = pageIn("http://host/?eye=left#tau=2", joining);
    expect(joiningOf(new URL(page).search)).toEqual(joining);
    expect(page).toBe("http://host/?eye=left&session=review&role=watch#tau=2");
    expect(pageIn(page, { session: "review", role: "lead" })).not.toContain("role");
  });

  it("has a name that the server takes, another each time", () => {
    const random = (bytes: Uint8Array) => bytes.map(() => Math.floor(256 * Math.random()));
    const names = new Set(Array.from({ length: 50 }, () => newName(random)));
    expect(names.size).toBe(50);
    for (const name of names) expect(joiningOf(`?session=${name}`).session).toBe(name);
  });
});
