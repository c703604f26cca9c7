// SPDX-License-Identifier: Apache-2.0
// Who the user is to the server. A token is sent once, with POST /login; the cookie that comes back
// is out of reach of scripts, and the token is kept nowhere.

/**
 * "ok", or why the server is not to be had: it wants a token, or the one it got is wrong, or is
 * right and the browser keeps no cookie for it.
 */
export type Entry = "ok" | "needed" | "wrong" | "limited" | "unkept";

export interface Fragment {
  token: string | undefined;
  /** Without the token, and without the "#". */
  rest: string;
}

/** Takes "token=…" out of the fragment of a link, where no server and no Referer ever see it. */
export function splitFragment(hash: string): Fragment {
  const fields = hash
    .replace(/^#/, "")
    .split("&")
    .filter((field) => field !== "");
  const token = fields.find((field) => field.startsWith("token="))?.slice("token=".length);
  return { token, rest: fields.filter((field) => !field.startsWith("token=")).join("&") };
}

function entryOf(status: number, hadToken: boolean): Entry {
  if (status === 429) return "limited";
  if (status === 401) return hadToken ? "wrong" : "needed";
  return "ok"; // also of servers that know no /login: what else is amiss the stream says
}

/** Of a bearer token (RFC 6750): with others, such as typographic quotes, fetch throws. */
const tokenCharacters = /^[\w.~+/=-]*$/;

/** A token that was right lets in what comes after it only where the browser keeps its cookie. */
const kept = async (url: string): Promise<Entry> =>
  (await logIn(url)) === "needed" ? "unkept" : "ok";

/** Shows the token, or, without one, asks whether the browser is let in already. */
export async function logIn(url: string, token?: string): Promise<Entry> {
  if (token !== undefined && !tokenCharacters.test(token)) return "wrong";
  try {
    const response = await fetch(
      url,
      token === undefined
        ? { cache: "no-store" }
        : { method: "POST", headers: { Authorization: `Bearer ${token}` } },
    );
    if (token !== undefined && response.ok) return await kept(url);
    return entryOf(response.status, token !== undefined);
  } catch {
    return "ok"; // not reached: the stream waits for the server and says so
  }
}
