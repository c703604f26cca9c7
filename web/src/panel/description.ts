// SPDX-License-Identifier: Apache-2.0
// Words for the canvas, for those who do not see it.
import type { SessionState } from "../protocol/messages";
import type { State } from "../state";

export function describe(session: SessionState | null, hasPicture: boolean): string {
  if (!hasPicture || session === null) return "The scene; no picture yet";
  const names = session.objectNames.join(", ");
  return `Picture of the scene${names === "" ? "" : `: ${names}`}. Arrow keys orbit, plus and minus zoom, H lists all controls.`;
}

export function keepDescription(state: State, canvas: HTMLCanvasElement): void {
  const update = (): void => {
    const text = describe(state.session.value, state.numbers.value !== null);
    if (canvas.getAttribute("aria-label") !== text) canvas.setAttribute("aria-label", text);
  };
  state.session.watch(update);
  state.numbers.watch(update);
}
