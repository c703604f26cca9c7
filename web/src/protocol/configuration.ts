// SPDX-License-Identifier: Apache-2.0
// The configuration that pictures are made by, over REST: what its compounds are, and how their
// equalizers work. eyrie/v1/configuration.proto as JSON, of which only what is shown is read.
import { ask } from "./ask";

export type EqualizerKind = "load" | "tree" | "dfr" | "tile" | "view" | "monitor" | "framerate";

/** As written, and what has been changed since; what is absent is as by default. */
export interface EqualizerSettings {
  mode?: string;
  damping?: number;
  boundary?: readonly number[];
  resistance?: readonly number[];
  framerate?: number;
  tileSize?: readonly number[];
}

export interface EqualizerView {
  /** Among all equalizers: changes name it so. */
  position: number;
  kind: EqualizerKind;
  isOn: boolean;
  isFrozen: boolean;
  settings: EqualizerSettings;
  report: EqualizerReport;
}

/** What it has come to; what is absent it does not say, or does not know yet. */
export interface EqualizerReport {
  framesPerSecond?: number;
  zoom?: number;
  imbalance?: number;
}

export interface CompoundView {
  name: string;
  /** What it has of its parent, and how it takes turns. */
  share: string;
  equalizers: readonly EqualizerView[];
  compounds: readonly CompoundView[];
}

export type EqualizerChange = EqualizerSettings & { on?: boolean; frozen?: boolean };

interface Compound {
  name?: string;
  channel?: {
    name?: string;
    position?: object;
    destination?: { layout?: Place; view?: Place; canvas?: Place; segment?: Place };
  };
  viewport?: number[];
  range?: number[];
  period?: number;
  phase?: number;
  pixel?: number[];
  subpixel?: number[];
  equalizers?: Record<string, EqualizerSettings & { size?: number[] }>[];
  compounds?: Compound[];
}

interface Place {
  name?: string;
  index?: number;
}

interface Tuning extends EqualizerSettings {
  equalizer?: number;
  on?: boolean;
  frozen?: boolean;
}

/** GET /configuration, as far as it is read. */
export interface ConfigurationAnswer {
  configuration?: { compounds?: Compound[] };
  state?: { equalizers?: Tuning[] };
  equalizers?: EqualizerReport[];
}

const placeText = (place: Place | undefined): string =>
  place?.name ?? (place?.index === undefined ? "" : String(place.index));

function nameOf({ name, channel }: Compound): string {
  if (name !== undefined && name !== "") return name;
  if (channel?.name !== undefined) return channel.name;
  const { destination } = channel ?? {};
  if (destination === undefined) return "compound";
  const view = placeText(destination.view);
  const layout = placeText(destination.layout);
  return `${layout === "" ? "canvas" : layout}${view === "" || view === "0" ? "" : `, view ${view}`}`;
}

const list = (numbers: readonly number[]): string =>
  numbers.map((one) => Number(one.toPrecision(3))).join(" ");

function shareOf({ viewport, range, period, phase, pixel, subpixel }: Compound): string {
  const parts = [];
  if (viewport !== undefined) parts.push(`viewport ${list(viewport)}`);
  if (range !== undefined) parts.push(`range ${list(range)}`);
  if (period !== undefined) parts.push(`frames ${phase ?? 0} of ${period}`);
  if (pixel !== undefined) parts.push(`pixel ${list(pixel)}`);
  if (subpixel !== undefined) parts.push(`subpixel ${list(subpixel)}`);
  return parts.join(", ");
}

/** The trees of compounds, with how their equalizers stand. */
export function compoundsOf(answer: ConfigurationAnswer): CompoundView[] {
  const { configuration, state, equalizers } = answer;
  const tuned = new Map((state?.equalizers ?? []).map((one) => [one.equalizer ?? 0, one]));
  let position = 0;
  const equalizerOf = (written: Record<string, EqualizerSettings & { size?: number[] }>) => {
    const [kind, { size, ...settings }] = Object.entries(written)[0] ?? ["load", {}];
    const {
      equalizer = position,
      on = true,
      frozen = false,
      ...changed
    } = tuned.get(position) ?? {};
    const report = equalizers?.[position] ?? {};
    position += 1;
    const view: EqualizerView = {
      position: equalizer,
      kind: kind as EqualizerKind,
      isOn: on,
      isFrozen: frozen,
      settings: { ...settings, ...(size === undefined ? {} : { tileSize: size }), ...changed },
      report,
    };
    return view;
  };
  const viewOf = (compound: Compound): CompoundView => ({
    name: nameOf(compound),
    share: shareOf(compound),
    // Those of a compound count before those of its children.
    equalizers: (compound.equalizers ?? []).map(equalizerOf),
    compounds: (compound.compounds ?? []).map(viewOf),
  });
  return (configuration?.compounds ?? []).map(viewOf);
}

const address = "api/v1/configuration";

/** The server's own words for what is wrong. */
async function problemOf(response: Response): Promise<Error> {
  const problem = (await response.json().catch(() => ({}))) as { detail?: string };
  return new Error(problem.detail ?? `the server answers ${response.status}`);
}

/** With what equalizers have come to, if so asked. Throws an Error, for the user to read, where there is none. */
export async function readConfiguration(isMeasured = false): Promise<ConfigurationAnswer> {
  const response = await ask(isMeasured ? `${address}?measured=true` : address, {
    cache: "no-store",
  });
  if (!response.ok) throw await problemOf(response);
  return (await response.json()) as ConfigurationAnswer;
}

/** For everybody, from the next frame on. Throws an Error, for the user to read. */
export async function tuneEqualizer(position: number, change: EqualizerChange): Promise<void> {
  const response = await ask(address, {
    method: "PATCH",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ equalizers: [{ equalizer: position, ...change }] }),
  });
  if (!response.ok) throw await problemOf(response);
}
