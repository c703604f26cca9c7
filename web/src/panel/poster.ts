// SPDX-License-Identifier: Apache-2.0
// The view as a picture larger than the window, saved as a file.
import { imageRequest } from "../command";
import { isPacked } from "../output";
import { drawPoster, largestSide, posterSize } from "../poster/poster";
import type { State } from "../state";
import type { Viewer } from "../viewer";
import { download } from "./clipboard";
import { button, make, setText } from "./element";
import { pixels } from "./format";

const sides = [2048, 4096, 8192, largestSide] as const;
const usualSide = 4096;

export function posterField(state: State, viewer: Viewer): HTMLElement {
  const select = make("select", "select");
  select.id = "poster-side";
  const label = make("label", "label", "Poster");
  label.htmlFor = select.id;
  label.title =
    "Pixels of its longer side; drawn in parts, with the error allowed counted in its own pixels";
  const options = sides.map((side) => {
    const option = make("option", "");
    option.value = String(side);
    select.append(option);
    return option;
  });
  select.value = String(usualSide);
  const nameSides = (): void =>
    options.forEach((option, i) => {
      const { width, height } = posterSize(viewer.pictureSize, sides[i] ?? usualSide);
      setText(option, `${width} × ${height}`);
    });
  nameSides();
  state.numbers.watch((numbers) => {
    if (numbers !== null) nameSides();
  });

  let drawing: AbortController | undefined;
  const save = async (): Promise<void> => {
    const view = viewer.sharedView();
    if (view === null) return;
    if (isPacked(viewer.output))
      return state.notice.set("No poster of two eyes in one picture: choose one, or an anaglyph");
    const size = posterSize(viewer.pictureSize, Number(select.value));
    drawing = new AbortController();
    select.disabled = true;
    try {
      const request = imageRequest(view, size, viewer.output);
      const tell = (done: number, all: number): void =>
        setText(start, `Stop (${Math.round((100 * done) / all)} %)`);
      const { file, error } = await drawPoster(request, tell, drawing.signal);
      download(file, "eyrie-poster.png");
      state.notice.set(`Poster saved; its error is at most ${pixels(error)} of its own`);
    } catch (error) {
      const why = error instanceof Error ? error.message : "it cannot be drawn";
      state.notice.set(drawing.signal.aborted ? "Stopped: no poster" : `No poster: ${why}`);
    } finally {
      drawing = undefined;
      select.disabled = false;
      setText(start, "Save");
    }
  };
  const start = button("Save", "Save the poster as a PNG file; again stops it", () =>
    drawing === undefined ? void save() : drawing.abort(),
  );
  start.id = "poster";
  return make("div", "field row", label, select, start);
}
