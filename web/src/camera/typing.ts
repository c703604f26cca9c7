// SPDX-License-Identifier: Apache-2.0

const isIn = (target: EventTarget | null, selector: string): boolean =>
  target instanceof Element && target.closest(selector) !== null;

/** Where letters belong to a text. */
export const isText = (target: EventTarget | null): boolean =>
  isIn(target, "input[type=text], input[type=number], select, textarea");

/** What the space bar presses. */
export const isPressed = (target: EventTarget | null): boolean =>
  isIn(target, "button, summary, input, a");

/** Where arrows belong to what they change, too. */
export const isTyping = (target: EventTarget | null): boolean =>
  isIn(target, "input, select, textarea, dialog");
