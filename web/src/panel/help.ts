// SPDX-License-Identifier: Apache-2.0
// The sheet of controls.
import { byId, make } from "./element";

const groups: readonly (readonly [string, readonly (readonly [string, string])[]])[] = [
  [
    "Mouse",
    [
      ["Left drag", "Orbit; look around while flying"],
      ["Right, middle or Shift + left drag", "Pan"],
      ["Wheel", "Zoom to the cursor"],
      ["Click", "What is there: coordinates and their error; Esc closes it"],
      ["Double click", "Turn to the point, and from then on about it"],
    ],
  ],
  [
    "Touch",
    [
      ["One finger", "Orbit"],
      ["Two fingers", "Pan, and zoom by pinching"],
    ],
  ],
  [
    "Keys",
    [
      ["← → ↑ ↓", "Orbit; with Shift: pan"],
      ["+ −", "Zoom"],
      ["W A S D, Q E", "Fly; with Shift: faster"],
      ["F", "Fly on or off; Esc ends it"],
      ["Home or R", "Show the whole scene"],
      ["[ ]", "Terrain lower or higher; \\ at its true height"],
      ["C", "Contour lines on or off"],
      ["X", "Hold the cut, or let it follow the view"],
      ["U", "Camera under ground, or above it"],
      ["P", "Show or hide the panel"],
      ["H or ?", "This sheet"],
    ],
  ],
];

/** Fills the sheet and returns how to open and close it. */
export function setUpHelp(): () => void {
  const dialog = byId("help", HTMLDialogElement);
  const title = make("h2", "help-title", "Controls");
  title.id = "help-title";
  const close = make("button", "help-close", "Close");
  close.type = "button";
  close.addEventListener("click", () => dialog.close());
  dialog.append(make("div", "help-head", title, close));
  for (const [name, entries] of groups) {
    const list = make("dl", "help-list");
    for (const [keys, meaning] of entries)
      list.append(make("dt", "", make("kbd", "", keys)), make("dd", "", meaning));
    dialog.append(make("h3", "heading", name), list);
  }
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
  return () => {
    if (dialog.open) dialog.close();
    else dialog.showModal();
  };
}
