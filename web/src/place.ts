// SPDX-License-Identifier: Apache-2.0
// Which session the page joins, and how, as the query of its address: "?session=review&role=watch".
// Without a session it has a view of its own.

export interface Joining {
  /** "": a session of its own. */
  session: string;
  /** Who leads moves the view; "watch" does so only when asked to. */
  role: "lead" | "watch";
}

/** A name that the server would refuse is none; misreadJoining says so. */
export function joiningOf(query: string): Joining {
  const fields = new URLSearchParams(query);
  const name = fields.get("session") ?? "";
  return {
    session: /^[A-Za-z0-9._-]{1,64}$/.test(name) ? name : "",
    role: fields.get("role") === "watch" ? "watch" : "lead",
  };
}

/** What of the query names no session or role, for the user to read; "" where all is understood. */
export function misreadJoining(query: string): string {
  const fields = new URLSearchParams(query);
  const [name, role] = [fields.get("session") ?? "", fields.get("role") ?? ""];
  if (name !== "" && joiningOf(query).session === "")
    return "The address names no session: its name may have 64 letters, digits, dots, _ and -. This view is yours alone";
  if (role !== "" && role !== "lead" && role !== "watch")
    return `The address says role=${role}, which is neither lead nor watch`;
  return role === "watch" && name === "" ? "The address says role=watch, but no session" : "";
}

/** /ws beside the page at `page`. `viewer` is the page's own name: it has its place again by it. */
export function socketUrl(page: string, { session, role }: Joining, viewer: string): string {
  const url = new URL("ws", page);
  url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
  url.hash = "";
  url.search = session === "" ? "" : `?session=${session}&role=${role}&viewer=${viewer}`;
  return url.href;
}

/** The same page in a session, as that role. */
export function pageIn(page: string, { session, role }: Joining): string {
  const url = new URL(page);
  url.searchParams.set("session", session);
  if (role === "watch") url.searchParams.set("role", role);
  else url.searchParams.delete("role");
  return url.href;
}

/** Hard to guess, easy to read out: of a session, or of a viewer. */
export function newName(random: (bytes: Uint8Array) => Uint8Array): string {
  const letters = "abcdefghjkmnpqrstuvwxyz23456789";
  return Array.from(random(new Uint8Array(12)), (byte) => letters[byte % letters.length]).join("");
}
