// SPDX-License-Identifier: Apache-2.0
// Why a server takes no connection. A WebSocket that does not open tells scripts nothing, so the
// server answers what would refuse one to a plain request of the same address, too.

export interface Refusal {
  /** For the user to read. */
  text: string;
  /** How long the server wants to be left alone, in ms; 0 where it does not say. */
  retryAfter: number;
}

const patience = 5000;
/** A wrong clock in between is not to keep a page away for long. */
const longestWait = 60_000;

function waitOf(response: Response): number {
  const seconds = Number(response.headers.get("Retry-After"));
  return seconds > 0 ? Math.min(longestWait, 1000 * seconds) : 0;
}

async function refusalIn(response: Response): Promise<Refusal | undefined> {
  const type = response.headers.get("Content-Type") ?? "";
  if (!type.startsWith("application/problem+json")) return undefined;
  const { detail } = (await response.json()) as { detail?: unknown };
  return typeof detail === "string" ? { text: detail, retryAfter: waitOf(response) } : undefined;
}

/** Asks the server of a WebSocket; undefined where none answers. */
export async function refusalOf(socketUrl: string): Promise<Refusal | undefined> {
  const giveUp = new AbortController();
  const timer = setTimeout(() => giveUp.abort(), patience);
  try {
    const response = await fetch(socketUrl.replace(/^ws(s?):/, "http$1:"), {
      cache: "no-store",
      // Browsers send no Origin with what a page asks of its own server.
      headers: { "Eyrie-Page-Origin": window.location.origin },
      signal: giveUp.signal,
    });
    return await refusalIn(response);
  } catch {
    return undefined;
  } finally {
    clearTimeout(timer);
  }
}
