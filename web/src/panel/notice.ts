// SPDX-License-Identifier: Apache-2.0
// One line that says what came of a command, and goes by itself.
import type { State } from "../state";
import { byId, setText } from "./element";

const shownFor = 4000;

export function showNotice(state: State): void {
  const notice = byId("notice", HTMLElement);
  let timer: number | undefined;
  state.notice.watch((text) => {
    clearTimeout(timer);
    setText(notice, text);
    notice.classList.toggle("is-empty", text === "");
    if (text !== "") timer = window.setTimeout(() => state.notice.set(""), shownFor);
  });
}
