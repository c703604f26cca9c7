// SPDX-License-Identifier: Apache-2.0
// A flight: recorded, played, edited key by key, kept, saved and loaded as files, and drawn picture
// by picture.
import { FlightDeck } from "../flight/deck";
import { flightJson, flightOfJson } from "../flight/file";
import { pathOf } from "../flight/paths";
import { keepFlight, readFlights, removeFlight } from "../flight/store";
import type { State } from "../state";
import { browserStorage } from "../storage";
import type { Viewer } from "../viewer";
import { download } from "./clipboard";
import { button, byId, make, setText } from "./element";
import { keyList } from "./flight_keys";
import { plural } from "./format";
import { onKeys } from "./keys";

/** No path of an hour is longer. */
const mostBytes = 64 * 2 ** 20;
const usualRate = 30;

/** "my flight" as a file's name. */
export const fileName = (name: string): string =>
  name.replace(/[^\p{L}\p{N}._-]+/gu, "-").replace(/^[-.]+|-+$/g, "") || "flight";

export const time = (seconds: number): string => `${seconds.toFixed(1)} s`;

/** The flight in a file; throws an Error for the user to read. */
async function readFile(file: File, state: State, viewer: Viewer) {
  if (file.size > mostBytes) throw new Error("it is larger than 64 MiB");
  const name = file.name.replace(/\.[^.]*$/, "");
  const text = await file.text();
  if (text.trimStart().startsWith("{")) return { flight: flightOfJson(text, name), note: "" };
  const { min, max } = state.session.value?.sceneBounds ?? {};
  if (min === undefined || max === undefined) throw new Error("no scene is open yet");
  const bounds = { min: [min.x, min.y, min.z], max: [max.x, max.y, max.z] } as const;
  return pathOf(text, name, bounds, viewer.camera?.fovyDegrees ?? 45);
}

/** Loading would take the place of what is recorded. */
function mayLoad(deck: FlightDeck, load: HTMLButtonElement, title: string): void {
  load.disabled = deck.activity.value.kind === "recording";
  load.title = load.disabled ? "End the recording first (B)" : title;
}

function scrubber(deck: FlightDeck): HTMLElement {
  const label = make("label", "label", "Time");
  const output = make("output", "value");
  const slider = make("input", "slider");
  slider.type = "range";
  slider.id = "flight-time";
  slider.min = "0";
  slider.step = "0.01";
  label.htmlFor = output.htmlFor.value = slider.id;
  slider.addEventListener("input", () => deck.seek(Math.min(Number(slider.value), deck.length)));
  const update = (): void => {
    const isRecording = deck.activity.value.kind === "recording";
    const now = deck.seconds.value;
    slider.disabled = isRecording || deck.length === 0;
    slider.max = String(Math.ceil(deck.length * 100) / 100);
    slider.value = String(now);
    const text = isRecording ? time(now) : `${time(now)} of ${time(deck.length)}`;
    setText(output, text);
    slider.setAttribute("aria-valuetext", text);
  };
  deck.flight.watch(update);
  deck.seconds.watch(update);
  deck.activity.watch(update);
  return make("div", "field", make("div", "row", label, output), slider);
}

function keptFlights(deck: FlightDeck, state: State): HTMLElement {
  const list = make("ul", "bookmarks");
  const name = make("input", "text");
  name.type = "text";
  name.id = "flight-name";
  name.maxLength = 80;
  name.placeholder = "Name of the flight";
  name.setAttribute("aria-label", name.placeholder);
  const update = (): void => {
    for (const load of list.querySelectorAll<HTMLButtonElement>(".bookmark > :first-child"))
      mayLoad(deck, load, `Load ${load.textContent}`);
  };
  const fill = (): void => {
    const rows = readFlights(browserStorage()).map((flight) => {
      const load = button(flight.name, `Load ${flight.name}`, () => deck.load(flight));
      const remove = button("×", `Remove ${flight.name}`, () => {
        removeFlight(browserStorage(), flight.name);
        fill();
        name.focus();
      });
      remove.setAttribute("aria-label", remove.title);
      return make("li", "bookmark", load, remove);
    });
    list.replaceChildren(...rows);
    list.hidden = rows.length === 0;
    update();
  };
  const keep = make("button", "small", "Keep");
  keep.type = "submit";
  keep.title = "Keep this flight under the name, in this browser";
  const form = make("form", "row", name, keep);
  name.addEventListener("input", () =>
    deck.flight.set({ ...deck.flight.value, name: name.value.trim() }),
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const flight = deck.flight.value;
    if (flight.keys.length === 0 || flight.name === "")
      return state.notice.set("A flight that is kept has a name and a key");
    const isKept = keepFlight(browserStorage(), flight);
    state.notice.set(
      isKept
        ? `Kept as ${flight.name}`
        : "This browser keeps no more flights: it is full, or forbids it",
    );
    fill();
  });
  deck.flight.watch((flight) => {
    if (name.value.trim() !== flight.name) name.value = flight.name;
  });
  fill();
  deck.activity.watch(update);
  return make("div", "field", form, list);
}

/** Records and plays, by buttons and keys alike; says on the picture what goes on. */
function controls(deck: FlightDeck, open: () => void): HTMLElement {
  const is = (kind: string): boolean => deck.activity.value.kind === kind;
  const toggleRecording = (): void => {
    open();
    if (is("recording")) deck.stop();
    else deck.record();
  };
  const togglePlaying = (): void => (is("playing") ? deck.stop() : deck.play());
  const record = button("Record", "Record what is flown, or end it (B)", toggleRecording);
  const play = button("Play", "Play the flight from here on, or stop (Y)", togglePlaying);
  const badge = byId("recording", HTMLButtonElement);
  const recorded = make("span", "");
  badge.append(
    recorded,
    make("span", "by-keys", "; B ends it"),
    make("span", "by-touch", "; touch here to end it"),
  );
  badge.title = "End the recording (B)";
  badge.addEventListener("click", () => is("recording") && deck.stop());
  const update = (): void => {
    for (const [element, kind, names] of [
      [record, "recording", ["Record", "End recording"]],
      [play, "playing", ["Play", "Stop"]],
    ] as const) {
      element.classList.toggle("is-on", is(kind));
      setText(element, names[Number(is(kind))] ?? "");
    }
    badge.hidden = !is("recording");
    setText(recorded, `Recording ${time(deck.seconds.value)}`);
  };
  deck.activity.watch(update);
  deck.seconds.watch(update);
  onKeys({ b: toggleRecording, y: togglePlaying });
  return make("div", "small-buttons", record, play);
}

function files(deck: FlightDeck, state: State, viewer: Viewer): HTMLElement {
  const load = async (file: File): Promise<void> => {
    try {
      const { flight, note } = await readFile(file, state, viewer);
      deck.load(flight);
      const facts = `${plural(flight.keys.length, "key")}, ${time(deck.length)}`;
      state.notice.set(note === "" ? `Loaded ${facts}` : `${note}; ${facts}`);
    } catch (error) {
      state.notice.set(`${file.name} is no flight: ${error instanceof Error ? error.message : ""}`);
    }
  };
  const input = make("input", "");
  input.type = "file";
  input.id = "flight-file";
  input.accept = ".json,.txt,.path,application/json,text/plain";
  input.hidden = true;
  input.addEventListener("change", () => {
    const file = input.files?.[0];
    if (file !== undefined) void load(file);
    input.value = "";
  });
  const save = (): void => {
    const flight = deck.flight.value;
    if (flight.keys.length === 0) return state.notice.set("There is no flight to save yet");
    const json = new Blob([flightJson(flight)], { type: "application/json" });
    download(json, `${fileName(flight.name)}.json`);
  };
  const title = "JSON, or a camera path of eqPly or of eyes and normals";
  const loadFile = button("Load flight", title, () => input.click());
  deck.activity.watch(() => mayLoad(deck, loadFile, title));
  return make(
    "div",
    "small-buttons field",
    button("Save flight", "As JSON, which eyrie bench --flight plays", save),
    loadFile,
    input,
  );
}

function pictures(deck: FlightDeck, state: State): HTMLElement {
  const rate = make("input", "percent");
  rate.type = "number";
  rate.id = "flight-rate";
  rate.min = "1";
  rate.max = "120";
  rate.value = String(usualRate);
  const label = make("label", "label", "Per second");
  label.htmlFor = rate.id;
  label.title = "Pictures a second";
  rate.setAttribute("aria-label", label.title);
  const draw = async (): Promise<void> => {
    const framesPerSecond = Number(rate.value);
    if (deck.flight.value.keys.length === 0)
      return state.notice.set("There is no flight to draw yet");
    if (!(framesPerSecond >= 1 && framesPerSecond <= 120))
      return state.notice.set("A second has 1 to 120 pictures");
    try {
      const zip = await deck.draw(framesPerSecond);
      if (zip === undefined) return state.notice.set("Stopped: no pictures are saved");
      download(zip, `${fileName(deck.flight.value.name)}.zip`);
    } catch (error) {
      state.notice.set(error instanceof Error ? error.message : "The pictures cannot be saved");
    }
  };
  const start = button(
    "Save pictures",
    "Every picture of the flight, exact, as PNG in a ZIP",
    () => (deck.activity.value.kind === "drawing" ? deck.stop() : void draw()),
  );
  deck.activity.watch((activity) =>
    setText(
      start,
      activity.kind === "drawing"
        ? `Stop (${activity.frame} of ${activity.frames})`
        : "Save pictures",
    ),
  );
  return make("div", "field row flight-pictures", label, rate, start);
}

export function showFlight(state: State, viewer: Viewer): FlightDeck {
  const deck = new FlightDeck(viewer.steering, viewer, (text) => state.notice.set(text));
  const details = make("details", "plots", make("summary", "heading", "Flight"));
  details.title = "Fly and record, play, edit (B, Y, N)";
  const open = (): void => void (details.open = true);
  details.append(
    controls(deck, open),
    scrubber(deck),
    keyList(deck, state, viewer, open),
    keptFlights(deck, state),
    files(deck, state, viewer),
    pictures(deck, state),
  );
  byId("flight", HTMLElement).append(details);
  return deck;
}
