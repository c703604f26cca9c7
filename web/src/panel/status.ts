// SPDX-License-Identifier: Apache-2.0
// The chip that says whether all is well, and who renders.
import { RendererCondition } from "../protocol/messages";
import type { RendererState, SessionState } from "../protocol/messages";
import type { Connection, Numbers, State } from "../state";
import { byId, make, setText } from "./element";
import { deviceName, plural } from "./format";

export interface Status {
  level: "good" | "wait" | "bad";
  text: string;
  detail: string;
}

/** "2 renderers · llvmpipe (software)". */
export function rendererText(session: SessionState): string {
  const alive = session.renderers.filter((renderer) => renderer.alive);
  const total = session.renderers.length;
  const number =
    alive.length === total ? plural(total, "renderer") : `${alive.length} of ${total} renderers`;
  const names = new Set(
    alive.map(
      ({ device }) => deviceName(device?.device ?? "") + (device?.software ? " (software)" : ""),
    ),
  );
  return [number, ...names].join(" · ");
}

const conditionNames: ReadonlyMap<RendererCondition, string> = new Map([
  [RendererCondition.OPENING, "opening the scene"],
  [RendererCondition.LATE, "late"],
  [RendererCondition.DRAINING, "leaving"],
  [RendererCondition.DEAD, "dead"],
  [RendererCondition.REFUSED, "refused"],
]);

/** Who does not draw as usual: "renderer-2 dead, renderer-3 late", or "". */
export function degradedText(session: SessionState): string {
  return session.renderers
    .filter(({ condition }) => conditionNames.has(condition))
    .map(({ id, condition }) => `${id} ${conditionNames.get(condition) ?? ""}`)
    .join(", ");
}

/** "renderer-2: llvmpipe, dead since 14:03:05: no heartbeat for 2500 ms". */
export function rendererLine(renderer: RendererState): string {
  const { id, device, condition, why, sinceUnixMilliseconds: since } = renderer;
  const name = conditionNames.get(condition);
  const time = since === 0n ? "" : ` since ${new Date(Number(since)).toLocaleTimeString()}`;
  const state = name === undefined ? "" : `${name}${time}${why === "" ? "" : `: ${why}`}`;
  return `${id}: ${[device?.device ?? "", state].filter((text) => text !== "").join(", ")}`;
}

/** What the last picture lacks: "loading 3 pages", "2 pages unreadable", or "". */
export function missingText(numbers: Numbers | null): string {
  if (numbers === null) return "";
  const loading = numbers.pagesMissing - numbers.pagesFailed;
  const parts = [];
  if (loading > 0) parts.push(`loading ${plural(loading, "page")}`);
  if (numbers.pagesFailed > 0) parts.push(`${plural(numbers.pagesFailed, "page")} unreadable`);
  return parts.join(", ");
}

export function statusOf(
  connection: Connection,
  session: SessionState | null,
  stale: boolean,
  missing = "",
): Status {
  if (connection.kind === "connecting") return { level: "wait", text: "Connecting", detail: "" };
  if (connection.kind === "closed") return { level: "bad", text: "Closed", detail: "" };
  if (connection.kind === "lost")
    return {
      level: "bad",
      text: connection.refusal === "" ? "Reconnecting" : "Refused",
      detail: "",
    };
  if (session === null) return { level: "wait", text: "Connected", detail: "" };
  const detail = [missing, rendererText(session), degradedText(session), session.note]
    .filter((text) => text !== "")
    .join(" · ");
  const alive = session.renderers.filter((renderer) => renderer.alive).length;
  if (alive === 0) return { level: "bad", text: "No renderer", detail: "" };
  if (session.problem !== "") return { level: "bad", text: "Problem", detail };
  if (stale) return { level: "wait", text: "Waiting for a frame", detail };
  if (alive < session.renderers.length || session.note !== "")
    return { level: "wait", text: "Connected", detail };
  return { level: "good", text: "Connected", detail };
}

export function showStatus(state: State): void {
  const chip = byId("status", HTMLElement);
  const text = make("span", "chip-text");
  const detail = make("span", "chip-detail");
  chip.append(make("span", "chip-dot"), text, detail);
  const scene = byId("scene-name", HTMLElement);
  const update = (): void => {
    const session = state.session.value;
    const missing = missingText(state.numbers.value);
    const status = statusOf(state.connection.value, session, state.stale.value, missing);
    chip.dataset["level"] = status.level;
    setText(text, status.text);
    setText(detail, status.detail);
    chip.title = session?.renderers.map(rendererLine).join("\n") ?? "";
    setText(scene, session?.objectNames.join(", ") ?? "");
    scene.title = scene.textContent ?? "";
  };
  state.connection.watch(update);
  state.session.watch(update);
  state.stale.watch(update);
  let shown = "";
  state.numbers.watch((numbers) => {
    const missing = missingText(numbers);
    if (missing !== shown) update();
    shown = missing;
  });
}
