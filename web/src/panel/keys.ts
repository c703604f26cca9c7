// SPDX-License-Identifier: Apache-2.0
import { addCommands } from "../camera/commands";
import { isPressed, isScrolled, isText } from "../camera/typing";

/** Calls what belongs to a key, by KeyboardEvent.key in lower case, wherever no text is edited. */
export function onKeys(actions: Readonly<Record<string, (time: number) => void>>): void {
  addCommands(Object.keys(actions));
  window.addEventListener("keydown", (event) => {
    if (event.defaultPrevented) return;
    if (event.ctrlKey || event.metaKey || event.altKey || event.repeat) return;
    const key = event.key.toLowerCase();
    // Space presses, or scrolls, what has the focus.
    if (key === " " && (isPressed(event.target) || isScrolled(event.target))) return;
    const action = isText(event.target) || !Object.hasOwn(actions, key) ? undefined : actions[key];
    if (action === undefined) return;
    event.preventDefault();
    action(event.timeStamp);
  });
}
