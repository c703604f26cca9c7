// SPDX-License-Identifier: Apache-2.0

/** What an event is really at: what is inside a web component is seen from outside as the component. */
export const targetOf = (event: Event): EventTarget | null =>
  event.composedPath()[0] ?? event.target;

const isIn = (target: EventTarget | null, selector: string): boolean =>
  target instanceof Element && target.closest(selector) !== null;

const pressedInputs = ["range", "checkbox", "radio", "color", "button", "submit", "reset", "file"];
const textInput = `input:not(${pressedInputs.map((type) => `[type=${type}]`).join()})`;

/** Where letters belong to a text. */
export const isText = (target: EventTarget | null): boolean =>
  isIn(target, `${textInput}, select, textarea, [contenteditable]`);

/** A sheet is open: Esc closes that, and nothing beside it. */
export const isSheetOpen = (): boolean => document.querySelector("dialog[open]") !== null;

/** What the space bar presses. */
export const isPressed = (target: EventTarget | null): boolean =>
  isIn(target, "button, summary, input, a");

/** What arrows, the space bar and Home scroll while it has the focus itself. */
export const isScrolled = (target: EventTarget | null): boolean =>
  target instanceof Element && target.matches(".panel");

/** Where arrows belong to what they change, too. */
export const isTyping = (target: EventTarget | null): boolean =>
  isIn(target, "input, select, textarea, dialog");
