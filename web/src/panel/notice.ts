// SPDX-License-Identifier: Apache-2.0
// One line that says what came of a command.
import type { State } from "../state";
import { byId, setText } from "./element";

export function showNotice(state: State): void {
  const notice = byId("notice", HTMLElement);
  state.notice.watch((text) => {
    setText(notice, text);
    notice.classList.toggle("is-empty", text === "");
  });
}
