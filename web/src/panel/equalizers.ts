// SPDX-License-Identifier: Apache-2.0
// How the work is shared out: the trees of compounds, and how their equalizers work, for everybody.
// Read when it is opened, and after each change.
import type {
  CompoundView,
  EqualizerChange,
  EqualizerKind,
  EqualizerView,
} from "../protocol/configuration";
import { compoundsOf, readConfiguration, tuneEqualizer } from "../protocol/configuration";
import type { SessionState } from "../protocol/messages";
import { RendererCondition } from "../protocol/messages";
import type { State } from "../state";
import { byId, make, setText } from "./element";

const names: Record<EqualizerKind, string> = {
  load: "Load",
  tree: "Tree",
  dfr: "Frame rate by resolution",
  tile: "Tiles",
  view: "Views",
  monitor: "Monitor",
  framerate: "Steady rate",
};

/** Equalizer names the stripes, not the way they lie beside each other. */
export const modes = [
  ["SPLIT_MODE_2D", "Either way"],
  ["SPLIT_MODE_HORIZONTAL", "One above another"],
  ["SPLIT_MODE_VERTICAL", "Side by side"],
  ["SPLIT_MODE_DB", "Data"],
] as const;

/** What may be set of which kinds: numbers, of which a pair is asked for as "8 8". */
export interface NumberField {
  key: "damping" | "boundary" | "resistance" | "framerate" | "tileSize";
  name: string;
  title: string;
  kinds: readonly EqualizerKind[];
  /** How many numbers it is. */
  count: 1 | 2;
  usual: string;
}

export const fields: readonly NumberField[] = [
  {
    key: "damping",
    name: "Damping",
    title: "How little it does at a time, 0 to 1",
    kinds: ["load", "tree"],
    count: 1,
    usual: "0.5",
  },
  {
    key: "damping",
    name: "Damping",
    title: "How much of what is missing it makes up for at a time: 0 nothing, 1 all",
    kinds: ["dfr"],
    count: 1,
    usual: "0.5",
  },
  {
    key: "boundary",
    name: "Boundary",
    title: "Splits lie at multiples of these, pixels across and up",
    kinds: ["load", "tree"],
    count: 2,
    usual: "1 1",
  },
  {
    key: "resistance",
    name: "Resistance",
    title: "Splits do not move by less than these, pixels across and up",
    kinds: ["load", "tree"],
    count: 2,
    usual: "0 0",
  },
  {
    key: "framerate",
    name: "Frames a second",
    title: "That it holds by the size of the picture",
    kinds: ["dfr"],
    count: 1,
    usual: "10",
  },
  {
    key: "tileSize",
    name: "Tile",
    title: "Width and height, pixels",
    kinds: ["tile"],
    count: 2,
    usual: "64 64",
  },
];

/** What somebody has typed as a change, or why it is none. */
export function changeOf(field: NumberField, text: string): EqualizerChange | string {
  const numbers = text
    .trim()
    .split(/[\s,]+/)
    .map((word) => (word === "" ? Number.NaN : Number(word)));
  const wanted = field.count === 1 ? "a number" : "two numbers";
  if (numbers.length !== field.count || !numbers.every(Number.isFinite))
    return `${field.name}: ${wanted}, not “${text}”`;
  return { [field.key]: field.count === 1 ? numbers[0] : numbers };
}

/** "19 frames a second · 0.7 of the pixels of a side", or "". */
export function reportText({ kind, report }: Pick<EqualizerView, "kind" | "report">): string {
  const { framesPerSecond, zoom, imbalance } = report;
  const parts = [];
  if (framesPerSecond !== undefined)
    parts.push(
      `${kind === "framerate" ? "at most " : ""}${framesPerSecond.toFixed(1)} frames a second`,
    );
  if (zoom !== undefined) parts.push(`${zoom.toFixed(2)} of the pixels of a side`);
  if (imbalance !== undefined)
    parts.push(`the longest takes ${imbalance.toFixed(2)} times the mean`);
  return parts.join(" · ");
}

type Tune = (position: number, change: EqualizerChange) => void;

function checkbox(text: string, title: string, isOn: boolean, changed: (isOn: boolean) => void) {
  const input = make("input", "");
  input.type = "checkbox";
  input.checked = isOn;
  input.addEventListener("change", () => changed(input.checked));
  const label = make("label", "object-label", input, make("span", "", text));
  label.title = title;
  return label;
}

function numberField(
  field: NumberField,
  { position, settings }: EqualizerView,
  tune: Tune,
  complain: (why: string) => void,
): HTMLElement {
  const input = make("input", "text equalizer-number");
  input.type = "text";
  input.inputMode = "decimal";
  const value = settings[field.key];
  input.defaultValue = typeof value === "object" ? value.join(" ") : String(value ?? "");
  input.placeholder = field.usual;
  input.addEventListener("change", () => {
    const change = changeOf(field, input.value);
    if (typeof change === "string") {
      input.value = input.defaultValue;
      return complain(change);
    }
    input.defaultValue = input.value;
    tune(position, change);
  });
  const label = make("label", "row", make("span", "label", field.name), input);
  label.title = field.title;
  return label;
}

function modeField({ position, settings }: EqualizerView, tune: Tune): HTMLElement {
  const select = make("select", "select");
  for (const [value, name] of modes) {
    const option = make("option", "", name);
    option.value = value;
    select.append(option);
  }
  select.value = settings.mode ?? "SPLIT_MODE_2D";
  select.addEventListener("change", () => tune(position, { mode: select.value }));
  const label = make("label", "row", make("span", "label", "Cuts"), select);
  label.title = "Which way it cuts";
  return label;
}

function equalizer(view: EqualizerView, tune: Tune, complain: (why: string) => void): HTMLElement {
  const { kind, position, isOn, isFrozen } = view;
  const group = make(
    "fieldset",
    "equalizer",
    make("legend", "label", `${names[kind]} equalizer`),
    make(
      "div",
      "row",
      checkbox("On", "Off: its compounds are as they are configured", isOn, (on) =>
        tune(position, { on }),
      ),
      checkbox("Frozen", "Its compounds stay as they are now", isFrozen, (frozen) =>
        tune(position, { frozen }),
      ),
    ),
  );
  if (kind === "load" || kind === "tree") group.append(modeField(view, tune));
  for (const field of fields)
    if (field.kinds.includes(kind)) group.append(numberField(field, view, tune, complain));
  group.append(make("p", "note equalizer-report", reportText(view)));
  return group;
}

function compoundItem(
  { name, share, equalizers, compounds }: CompoundView,
  tune: Tune,
  complain: (why: string) => void,
): HTMLElement {
  const item = make("li", "compound", make("span", "", name));
  if (share !== "") item.append(make("span", "note compound-share", share));
  item.append(...equalizers.map((one) => equalizer(one, tune, complain)));
  if (compounds.length > 0)
    item.append(
      make("ul", "compounds", ...compounds.map((one) => compoundItem(one, tune, complain))),
    );
  return item;
}

/** In the order in which they are shown. */
const equalizersOf = (compounds: readonly CompoundView[]): EqualizerView[] =>
  compounds.flatMap((one) => [...one.equalizers, ...equalizersOf(one.compounds)]);

/** Whether something is typed in that has not been entered yet. */
function isTyping(tree: HTMLElement): boolean {
  const input = document.activeElement;
  return (
    input instanceof HTMLInputElement && tree.contains(input) && input.value !== input.defaultValue
  );
}

/** Other layouts may bring other compounds, and so may other renderers to the same layouts. */
export function sharersOf(session: SessionState | null): string {
  const { READY, LATE } = RendererCondition;
  return JSON.stringify([
    session?.canvases.map(({ layouts }) => layouts),
    session?.renderers
      .filter(({ condition }) => condition === READY || condition === LATE)
      .map(({ id }) => id),
  ]);
}

export function showEqualizers(state: State): void {
  const details = make("details", "plots", make("summary", "heading", "Work sharing"));
  details.title = "The compounds of the configuration, and their equalizers; for everybody";
  const tree = make("ul", "compounds");
  tree.id = "compounds";
  tree.setAttribute("aria-label", "Compounds");
  const problem = make("p", "note");
  problem.setAttribute("role", "status");
  details.append(tree, problem);
  const complain = (why: unknown): void => {
    problem.textContent = why instanceof Error ? why.message : String(why);
  };
  let isOutdated = false;
  let isUnread = false; // what is shown may not be what the server has
  const show = async (): Promise<void> => {
    try {
      const compounds = compoundsOf(await readConfiguration());
      isUnread = false;
      isOutdated = isTyping(tree);
      if (isOutdated) return;
      // What has the focus keeps it.
      const focused = [...tree.querySelectorAll("input, select")].indexOf(
        document.activeElement as Element,
      );
      tree.replaceChildren(...compounds.map((one) => compoundItem(one, tune, complain)));
      const again = tree.querySelectorAll<HTMLElement>("input, select")[focused];
      again?.focus();
    } catch (error) {
      isUnread = true;
      complain(error);
    }
  };
  const tune: Tune = (position, change) => {
    problem.textContent = "";
    tuneEqualizer(position, change).catch(complain).then(show, complain);
  };
  let isAsking = false; // for reports, which may last until somebody gives a token
  const showReports = async (): Promise<void> => {
    const all = equalizersOf(compoundsOf(await readConfiguration(true)));
    if (isUnread) {
      problem.textContent = "";
      await show();
    }
    const lines = tree.querySelectorAll<HTMLElement>(".equalizer-report");
    if (lines.length === all.length)
      lines.forEach((line, position) => setText(line, reportText(all[position]!)));
  };
  // A server that does not answer is told of elsewhere.
  window.setInterval(() => {
    if (!details.open || document.hidden || isAsking) return;
    isAsking = true;
    showReports()
      .catch(() => undefined)
      .finally(() => (isAsking = false));
  }, 1000);
  details.addEventListener("toggle", () => {
    problem.textContent = "";
    if (details.open) void show();
  });
  tree.addEventListener("focusout", () => {
    if (isOutdated) void show();
  });
  let shown = "";
  state.session.watch((session) => {
    const now = sharersOf(session);
    if (now !== shown && details.open) {
      problem.textContent = "";
      void show();
    }
    shown = now;
  });
  byId("equalizers", HTMLElement).append(details);
}
