// SPDX-License-Identifier: Apache-2.0
// Lays what is drawn over the picture where the picture lies on the canvas.
import { coverOf } from "../pick";
import type { State } from "../state";
import { byId } from "./element";

export function keepCover(state: State, canvas: HTMLCanvasElement): void {
  const cover = byId("cover", HTMLElement);
  const update = (): void => {
    const shown = state.shown.value;
    if (shown === null) return;
    const size = { width: canvas.clientWidth, height: canvas.clientHeight };
    const { x, y, width, height } = coverOf(size, shown);
    cover.style.left = `${x}px`;
    cover.style.top = `${y}px`;
    cover.style.width = `${width}px`;
    cover.style.height = `${height}px`;
  };
  state.shown.watch(update);
  new ResizeObserver(update).observe(canvas);
}
