// SPDX-License-Identifier: Apache-2.0
import { addCommands, letterOf } from "../camera/commands";
import { isPressed, isScrolled, isText } from "../camera/typing";

/** What belongs to a key, by letterOf() in lower case. */
type Actions = Readonly<Record<string, (time: number) => void>>;

/** Many keyboards have these with AltGr only, or with Option. */
const bracketKeys = ["[", "]", "\\"];

/** With it a key is the browser's or the system's. AltGr is Ctrl and Alt, too, on Windows. */
function hasModifier(event: KeyboardEvent): boolean {
  const { ctrlKey, metaKey, altKey } = event;
  if (!bracketKeys.includes(event.key)) return ctrlKey || metaKey || altKey;
  return (ctrlKey || metaKey) && !event.getModifierState("AltGraph");
}

function listen(actions: Actions, isHeard: (event: KeyboardEvent) => boolean): void {
  addCommands(Object.keys(actions));
  window.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || hasModifier(event) || !isHeard(event)) return;
    const key = letterOf(event).toLowerCase();
    // Space presses, or scrolls, what has the focus.
    if (key === " " && (isPressed(event.target) || isScrolled(event.target))) return;
    const action = isText(event.target) || !Object.hasOwn(actions, key) ? undefined : actions[key];
    if (action === undefined) return;
    event.preventDefault();
    action(event.timeStamp);
  });
}

/** Calls what belongs to a key wherever no text is edited. */
export const onKeys = (actions: Actions): void => listen(actions, (event) => !event.repeat);

/** The same, again and again while the key is held. */
export const onHeldKeys = (actions: Actions): void => listen(actions, () => true);
