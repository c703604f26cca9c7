// SPDX-License-Identifier: Apache-2.0
// What a click found: a mark on the picture, and a card that says where that is and how surely.
import { isSheetOpen, isText } from "../camera/typing";
import { appearance } from "../pick";
import type { Shown } from "../protocol/messages";
import type { Pick, PickedPoint, State } from "../state";
import { byId, make, setText } from "./element";
import { coordinate, lengthAtMost, lengthText, lostOf, roundedUp } from "./format";

export interface PickText {
  title: string;
  /** Name, value, and what that means. */
  rows: readonly (readonly [string, string, string])[];
}

/** How far the source's surface may be from the point as it is written. */
function offAsWritten({ position, error }: PickedPoint): number {
  return error + Math.hypot(...position.map((value) => lostOf(coordinate(value, error), value)));
}

/** In metres, however high: "1234.567 m ± 20 mm". */
function elevationText(elevation: number, error: number): string {
  const text = coordinate(elevation, error);
  return `${text} m ± ${lengthAtMost(error + lostOf(text, elevation))}`;
}

function rowsOf(point: PickedPoint): PickText["rows"] {
  const [x, y, z] = point.position.map((value) => coordinate(value, point.error));
  const nearest = -roundedUp(point.distance - point.nearest);
  const range = Number.isFinite(point.farthest)
    ? `${lengthText(nearest)} to ${lengthAtMost(point.farthest - point.distance, "+")}`
    : "the source may be missed";
  return [
    ...(point.elevation === undefined
      ? []
      : [
          [
            "Elevation",
            elevationText(point.elevation, point.elevationError),
            "In the terrain's own heights, not exaggerated",
          ] as const,
        ]),
    ["x, y, z", `${x}, ${y}, ${z}`, "World metres"],
    [
      "Off by",
      `${lengthAtMost(offAsWritten(point))} at most`,
      "How far the source's surface may be from the point, however cells between posts are read",
    ],
    ["Distance", lengthText(point.distance), "From the eye"],
    ["Along the view", range, "Where the same line of sight meets the source, from the point on"],
  ];
}

export function textOf(pick: Pick): PickText {
  switch (pick.kind) {
    case "asking":
      return { title: "Looking …", rows: [] };
    case "nothing":
      return { title: "Nothing there", rows: [] };
    case "problem":
      return { title: pick.text, rows: [] };
    case "point":
      return { title: pick.object || "Point", rows: rowsOf(pick) };
  }
}

/** Where to mark a pick, as shares of the picture; undefined where it is not in it. */
export function markOf(pick: Pick | null, shown: Shown | null): [number, number] | undefined {
  if (pick?.kind !== "point" || shown === null) return undefined;
  if (pick.exaggeration !== shown.exaggeration) return undefined;
  const at = appearance(shown, pick.position);
  return at?.every((share) => share >= 0 && share <= 1) ? at : undefined;
}

export function showPick(state: State): void {
  const card = byId("pick", HTMLElement);
  const mark = byId("pick-mark", HTMLElement);
  const title = make("h2", "pick-title");
  const list = make("dl", "numbers");
  const close = make("button", "pick-close", "×");
  close.type = "button";
  close.title = "Close (Esc)";
  close.setAttribute("aria-label", "Close");
  close.addEventListener("click", () => state.pick.set(null));
  card.append(make("div", "pick-head", title, close), list);

  const placeMark = (): void => {
    const at = markOf(state.pick.value, state.shown.value);
    mark.hidden = at === undefined;
    if (at === undefined) return;
    mark.style.left = `${100 * at[0]}%`;
    mark.style.top = `${100 * at[1]}%`;
  };
  state.pick.watch((pick) => {
    card.hidden = pick === null;
    if (pick !== null) {
      const { rows, title: text } = textOf(pick);
      setText(title, text);
      list.replaceChildren(
        ...rows.flatMap(([name, value, meaning]) => {
          const term = make("dt", "label", name);
          term.title = meaning;
          return [term, make("dd", "value", value)];
        }),
      );
    }
    placeMark();
  });
  state.shown.watch(placeMark);
  window.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && !isSheetOpen() && !isText(event.target)) state.pick.set(null);
  });
}
