// SPDX-License-Identifier: Apache-2.0
// Who else sees what is seen here, and who moves it.
import type { FlightDeck } from "../flight/deck";
import { isKept } from "../flight/store";
import { newName, pageIn } from "../place";
import type { ViewerPlace } from "../protocol/messages";
import type { SharedView } from "../share";
import { encodeView } from "../share";
import type { State } from "../state";
import { browserStorage } from "../storage";
import type { Viewer } from "../viewer";
import { copyText } from "./clipboard";
import { byId, make, setText } from "./element";
import { plural } from "./format";

/** Of those that show pictures together with this one; "" where none do. */
function togetherText({ together, behind }: ViewerPlace): string {
  if (together < 2) return "";
  if (behind === 0) return ` · ${together} screens together`;
  return ` · ${behind} of ${together} screens late, not waited for`;
}

/** "2 viewers · you lead". */
export function placeText(place: ViewerPlace): string {
  const who = place.leads ? "you lead" : place.led ? "you watch" : "nobody leads";
  return `${plural(place.viewers, "viewer")} · ${who}${togetherText(place)}`;
}

/** The same page in that session, with the view that is wanted now: the address may lag behind. */
export function sharedPage(page: string, session: string, view: SharedView | null): string {
  const url = new URL(pageIn(page, { session, role: "lead" }));
  if (view !== null) url.hash = encodeView(view);
  return url.href;
}

/** The page loads anew to share its view. */
function mayLoseFlight({ activity, flight }: FlightDeck): boolean {
  const isLost = activity.value.kind === "recording" || !isKept(browserStorage(), flight.value);
  const question =
    "This loads the page anew, and the flight is not kept in this browser: it will be gone. Share the view all the same?";
  return !isLost || window.confirm(question);
}

function button(id: string, text: string, title: string, action: () => void): HTMLButtonElement {
  const element = make("button", "small", text);
  element.id = id;
  element.type = "button";
  element.title = title;
  element.addEventListener("click", action);
  return element;
}

export function showSession(state: State, viewer: Viewer, deck: FlightDeck): void {
  const text = make("p", "field");
  text.id = "session-place";
  text.setAttribute("role", "status");
  const lead = button("take-lead", "Take the lead", "Move the view from here", () =>
    viewer.takeLead(),
  );
  const share = button("share-session", "Share this view", "Let others see what you see", () => {
    if (!mayLoseFlight(deck)) return;
    const session = newName((bytes) => crypto.getRandomValues(bytes));
    window.location.assign(sharedPage(window.location.href, session, viewer.sharedView()));
  });
  const link = button("watch-link", "Copy link to watch", "For those who are to watch", () => {
    const { session = "" } = state.session.value?.place ?? {};
    const page = window.location.href.replace(/#.*/, "");
    void copyText(pageIn(page, { session, role: "watch" })).then((isCopied) =>
      state.notice.set(isCopied ? "Link copied" : "Link: copying is forbidden"),
    );
  });
  const panel = byId("session", HTMLElement);
  panel.append(
    make("h2", "heading", "Together"),
    text,
    make("div", "small-buttons field", lead, share, link),
  );
  state.session.watch((session) => {
    const place = session?.place;
    const isShared = (place?.session ?? "") !== "";
    setText(text, isShared && place !== undefined ? placeText(place) : "");
    text.hidden = !isShared;
    const mayControl = place?.mayControl === true;
    lead.hidden = !isShared || !mayControl || place.leads;
    link.hidden = !isShared;
    share.hidden = isShared || !mayControl;
    panel.hidden = !isShared && !mayControl;
  });
}
