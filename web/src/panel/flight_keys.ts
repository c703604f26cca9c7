// SPDX-License-Identifier: Apache-2.0
// The keys of a flight, to go to, move in time, replace and delete.
import type { FlightDeck } from "../flight/deck";
import type { FlightKey } from "../flight/flight";
import { withCamera, withKey, withoutKey, withTime } from "../flight/flight";
import type { State } from "../state";
import type { Viewer } from "../viewer";
import { button, make, setText } from "./element";
import { onKeys } from "./keys";

/** Rows at once: of a longer flight those about the time that is shown. */
export const rowsShown = 30;
/** What a new key at the end adds. */
const secondsPerKey = 2;

/** The first of the rows to show, of `count` keys, when `current` is where the flight is. */
export function firstRow(count: number, current: number): number {
  return Math.max(0, Math.min(current - Math.floor(rowsShown / 2), count - rowsShown));
}

/** The key that the flight is at or has passed last. */
function currentKey(keys: readonly FlightKey[], seconds: number): number {
  const time = (keys[0]?.seconds ?? 0) + seconds + 1e-9;
  return Math.max(0, keys.filter((key) => key.seconds <= time).length - 1);
}

/** Where a new key goes: where the flight is, or after its end. */
export function timeOfNewKey(keys: readonly FlightKey[], seconds: number): number {
  const [first, last] = [keys[0], keys[keys.length - 1]];
  if (first === undefined || last === undefined) return 0;
  const time = first.seconds + seconds;
  const isAtKey = keys.some((key) => Math.abs(key.seconds - time) < 1e-6);
  return isAtKey ? last.seconds + secondsPerKey : time;
}

interface Row {
  element: HTMLElement;
  remove: HTMLButtonElement;
  fill(key: FlightKey, name: string): void;
}

export function keyList(
  deck: FlightDeck,
  state: State,
  viewer: Viewer,
  open: () => void,
): HTMLElement {
  const rows = make("div", "flight-keys");
  rows.setAttribute("role", "group");
  rows.setAttribute("aria-label", "Keys");
  const note = make("p", "note");
  const keysNow = (): readonly FlightKey[] => deck.flight.value.keys;

  const made: Row[] = [];
  let shown: readonly FlightKey[] = [];

  const makeRow = (place: number): Row => {
    const edit = (by: (keys: readonly FlightKey[], at: number) => readonly FlightKey[]): void => {
      const key = shown[place];
      // A recording that ends with an edit has other keys than this one.
      deck.edit((keys) => (key && keys.includes(key) ? by(keys, keys.indexOf(key)) : keys));
    };
    const seconds = make("input", "percent");
    seconds.type = "number";
    seconds.step = "0.1";
    seconds.addEventListener("change", () => {
      const typed = seconds.valueAsNumber;
      edit((keys, at) => {
        const moved = withTime(keys, at, typed);
        if (moved !== undefined) return moved;
        state.notice.set("A key has a time of its own, in seconds");
        seconds.value = seconds.defaultValue;
        return keys;
      });
    });
    const show = button("Show", "", () =>
      deck.seek((shown[place]?.seconds ?? 0) - (keysNow()[0]?.seconds ?? 0)),
    );
    const replace = button("Replace", "", () => {
      const { camera } = viewer;
      if (camera !== null) edit((keys, at) => withCamera(keys, at, camera));
    });
    const remove = button("×", "", () => {
      edit(withoutKey);
      (made[Math.min(place, made.length - 1)]?.remove ?? add).focus();
    });
    const fill = (key: FlightKey, name: string): void => {
      seconds.value = seconds.defaultValue = String(Number(key.seconds.toFixed(3)));
      seconds.setAttribute("aria-label", `Seconds of ${name}`);
      show.title = `Show ${name}`;
      replace.title = `Let ${name} show what is seen now`;
      remove.title = `Remove ${name}`;
      for (const one of [show, replace, remove]) one.setAttribute("aria-label", one.title);
    };
    return { element: make("div", "flight-key", seconds, show, replace, remove), remove, fill };
  };

  /** Rows stay, and so does the focus in them. */
  const fill = (): void => {
    const keys = keysNow();
    const first = firstRow(keys.length, currentKey(keys, deck.seconds.value));
    shown = keys.slice(first, first + rowsShown);
    while (made.length > shown.length) made.pop()?.element.remove();
    while (made.length < shown.length) {
      const row = makeRow(made.length);
      made.push(row);
      rows.append(row.element);
    }
    shown.forEach((key, i) => made[i]?.fill(key, `key ${first + i + 1}`));
    note.hidden = keys.length <= rowsShown;
    setText(note, `Keys ${first + 1} to ${first + shown.length} of ${keys.length}`);
  };
  const addKey = (): void => {
    open();
    const { camera } = viewer;
    if (camera === null) return;
    let seconds = 0;
    deck.edit((keys) => {
      seconds = timeOfNewKey(keys, deck.seconds.value);
      return withKey(keys, { seconds, camera });
    });
    deck.seconds.set(seconds - (keysNow()[0]?.seconds ?? 0));
  };
  const add = button("Add key", "Let the flight show, at this time, what is seen now (N)", addKey);
  onKeys({ n: addKey });
  deck.flight.watch(fill);
  // Another part of a long flight, once it stands there.
  deck.activity.watch(({ kind }) => kind === "idle" && keysNow().length > rowsShown && fill());
  const box = make("details", "flight-box", make("summary", "label", "Keys"), rows, note);
  deck.flight.watch(({ keys }) => setText(box.firstElementChild ?? box, `Keys (${keys.length})`));
  return make("div", "field", box, make("div", "small-buttons", add));
}
