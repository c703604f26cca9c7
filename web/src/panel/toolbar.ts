// SPDX-License-Identifier: Apache-2.0
// The buttons of the top bar, and the keys that do the same.
import type { State } from "../state";
import type { Viewer } from "../viewer";
import { byId } from "./element";
import { setUpHelp } from "./help";
import { onKeys } from "./keys";

/** In a window this narrow the panel covers a part of the picture. */
const narrow = "(max-width: 700px)";

export function setUpToolbar(state: State, viewer: Viewer): void {
  const fly = byId("fly", HTMLButtonElement);
  const toggle = byId("panel-toggle", HTMLButtonElement);
  const panel = byId("panel", HTMLElement);
  const stage = byId("stage", HTMLElement);
  const mode = byId("mode", HTMLElement);
  const toggleHelp = setUpHelp(state);
  const showPanel = (isShown: boolean): void => {
    panel.hidden = !isShown;
    stage.classList.toggle("is-covered", isShown);
    toggle.setAttribute("aria-expanded", String(isShown));
  };

  showPanel(!window.matchMedia(narrow).matches);
  toggle.addEventListener("click", () => showPanel(panel.hidden));
  byId("home", HTMLButtonElement).addEventListener("click", (event) =>
    viewer.steering.goHome(event.timeStamp),
  );
  byId("help-open", HTMLButtonElement).addEventListener("click", toggleHelp);
  const walk = byId("walk", HTMLButtonElement);
  const walkMode = byId("walk-mode", HTMLElement);
  fly.addEventListener("click", () => viewer.steering.setFlying(!state.flying.value));
  walk.addEventListener("click", () => viewer.steering.setWalking(!state.walking.value));
  state.flying.watch((isFlying) => {
    fly.setAttribute("aria-pressed", String(isFlying));
    mode.hidden = !isFlying;
  });
  state.walking.watch((isWalking) => {
    walk.setAttribute("aria-pressed", String(isWalking));
    walkMode.hidden = !isWalking;
  });

  onKeys({
    h: toggleHelp,
    "?": toggleHelp,
    p: () => showPanel(panel.hidden),
    " ": () => viewer.steering.clickMiddle(),
  });
}
