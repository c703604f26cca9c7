// SPDX-License-Identifier: Apache-2.0
// The sheet of controls, with how they stand.
import { standardViews } from "../camera/standard";
import type { State } from "../state";
import { byId, make, setText } from "./element";
import { metres, times } from "./format";
import { sentText } from "./numbers";
import { azimuthText } from "./scene";

/** Keys, what they do, and how that stands. */
type Line = readonly [string, string, ((state: State) => string)?];

const onOff = (isOn: boolean): string => (isOn ? "on" : "off");

/** Lines of one device, by its name. */
type Group = readonly [string, readonly Line[]];

const mouse: Group = [
  "Mouse",
  [
    ["Left drag", "Orbit; look around while flying or walking"],
    ["Right, middle or Shift + left drag", "Pan"],
    ["Wheel", "Zoom to the cursor; a taller or smaller walker"],
    ["Click", "What is there: coordinates and their error; Esc closes it"],
    ["Double click", "Turn to the point, and from then on about it"],
  ],
];

const touch: Group = [
  "Touch",
  [
    ["One finger", "Orbit"],
    ["Two fingers", "Pan, zoom by pinching, and turn; walk while walking"],
  ],
];

const keyboard: Group = [
  "Keys",
  [
    ["← → ↑ ↓", "Orbit; with Shift: pan"],
    ["+ −", "Zoom"],
    ["W A S D, Q E", "Fly, or walk; with Shift: faster"],
    ["F", "Fly on or off; Esc ends it", ({ flying }) => onOff(flying.value)],
    [
      "T",
      "Walk on the ground that is in the middle, or end it",
      ({ walking }) => onOff(walking.value),
    ],
    ["Home or R", "Show the whole scene"],
    ["1 to 7", `Standard views: ${standardViews.map(({ name }) => name.toLowerCase()).join(", ")}`],
    ["Space", "What is at the middle of the picture"],
    ["M", "Measure: then click points, or Space", ({ measuring }) => onOff(measuring.value)],
    ["V", "Heights along the last line measured"],
    [
      "[ ]",
      "Terrain lower or higher; \\ at its true height",
      ({ look }) => times(look.value.exaggeration),
    ],
    [
      "C",
      "Contour lines on or off",
      ({ look }) =>
        look.value.contourMetres > 0 ? `every ${metres(look.value.contourMetres)}` : "off",
    ],
    [
      "X",
      "Hold the cut, or let it follow the view",
      ({ look }) => (look.value.frozen === null ? "follows" : "held"),
    ],
    [
      "U",
      "Camera under ground, or above it",
      ({ look }) => (look.value.underground ? "anywhere" : "above"),
    ],
    [
      "J",
      "The sun moved by hand, or the scene's lights",
      ({ look }) => (look.value.sun === null ? "the scene's" : azimuthText(look.value.sun.azimuth)),
    ],
    ["B", "Record a flight; again ends it"],
    ["Y", "Play the flight, or stop"],
    ["N", "Add what is seen to the flight, at its time or after its end"],
    ["L, K", "Copy a link to this view; the command that renders it"],
    [
      "O",
      "Save the exact picture as a file",
      ({ numbers }) => (numbers.value ? sentText(numbers.value) : ""),
    ],
    ["G", "Live plots of time, error and bandwidth"],
    ["P", "Show or hide the panel"],
    ["H or ?", "This sheet"],
  ],
];

/** Fills the sheet and returns how to open and close it. */
export function setUpHelp(state: State): () => void {
  const dialog = byId("help", HTMLDialogElement);
  const title = make("h2", "help-title", "Controls");
  title.id = "help-title";
  const close = make("button", "help-close", "Close");
  close.type = "button";
  close.addEventListener("click", () => dialog.close());
  dialog.append(make("div", "help-head", title, close));
  const states: (() => void)[] = [];
  const isTouched = window.matchMedia("(pointer: coarse)").matches;
  for (const [name, entries] of isTouched ? [touch, mouse, keyboard] : [mouse, touch, keyboard]) {
    const list = make("dl", "help-list");
    for (const [keys, meaning, stands] of entries) {
      const text = make("dd", "", meaning);
      if (stands !== undefined) {
        const now = make("span", "help-now");
        text.append(now);
        states.push(() => setText(now, stands(state)));
      }
      list.append(make("dt", "", make("kbd", "", keys)), text);
    }
    dialog.append(make("h3", "heading", name), list);
  }
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
  // Keys work while the sheet is open, and pictures come.
  const update = (): void => {
    if (dialog.open) for (const show of states) show();
  };
  for (const value of [state.flying, state.walking, state.measuring, state.look, state.numbers])
    value.watch(update);
  return () => {
    if (dialog.open) return dialog.close();
    dialog.showModal();
    update();
  };
}
