// SPDX-License-Identifier: Apache-2.0
import type { Entry } from "../protocol/login";
import { logIn, splitFragment } from "../protocol/login";
import { Value } from "../state";
import { byId, make, setText } from "./element";

const loginUrl = "login";

const reasons: Record<Exclude<Entry, "ok">, string> = {
  needed: "This server wants a token. Who runs it has one for you.",
  wrong: "The server does not know this token, or no longer.",
  limited: "Too many wrong tokens came from here; wait a minute.",
  unkept: "This browser keeps no cookie of this server; allow that, and give the token again.",
};

/** The token in the page's address, which leaves the address and the history at once. */
function takeToken(): string | undefined {
  const { token, rest } = splitFragment(window.location.hash);
  if (token === undefined) return undefined;
  const { pathname, search } = window.location;
  window.history.replaceState(null, "", `${pathname}${search}${rest === "" ? "" : `#${rest}`}`);
  return token;
}

/** What is not there before somebody is let in: all tools, and how things stand. */
function showEmpty(isEmpty: boolean): void {
  for (const button of document.querySelectorAll<HTMLButtonElement>(".tools button"))
    button.disabled = isEmpty;
  byId("status", HTMLElement).hidden = isEmpty;
}

const entry = new Value<Entry>("needed");
let again: Promise<void> | undefined; // while the server may want a token again
const show = async (token?: string): Promise<void> => entry.set(await logIn(loginUrl, token));

/** Asks for a token until the server takes one, given here or by `entry` becoming another. */
function askForToken(): Promise<void> {
  const reason = make("p", "");
  const input = make("input", "token");
  input.type = "password";
  input.autocomplete = "off";
  input.required = true;
  input.setAttribute("aria-label", "Token");
  const form = make("form", "message-box sign-in", reason, input, make("button", "small", "Enter"));
  const sheet = make("section", "message", form);
  sheet.setAttribute("role", "status");
  byId("message", HTMLElement).after(sheet);
  input.focus();
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const token = input.value.trim();
    if (token !== "") void show(token);
  });
  return new Promise((resolve) => {
    const end = entry.watch((now) => {
      if (now !== "ok") {
        setText(reason, reasons[now]);
        return;
      }
      end();
      sheet.remove();
      resolve();
    });
  });
}

/**
 * Returns when the server lets this browser in, for which the user may have to give a token. Those
 * of links that are opened in this tab are taken ever after.
 */
export async function signIn(): Promise<void> {
  window.addEventListener("hashchange", () => {
    const token = takeToken();
    if (token !== undefined) void show(token);
  });
  await show(takeToken());
  if (entry.value === "ok") return;
  showEmpty(true);
  await askForToken();
  showEmpty(false);
}

async function lookAgain(): Promise<void> {
  await show();
  if (entry.value !== "ok") await askForToken();
}

/**
 * Asks for a token where the server wants one again, as after a cookie's life; who asks meanwhile
 * waits for the same. The page stays as it is beneath, with what is not kept of it, and connects
 * again by itself.
 */
export function signInAgain(): Promise<void> {
  again ??= lookAgain().finally(() => (again = undefined));
  return again;
}

/** The server has let this browser in, perhaps for what another tab showed it. */
export const signedIn = (): void => entry.set("ok");
