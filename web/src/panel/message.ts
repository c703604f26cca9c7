// SPDX-License-Identifier: Apache-2.0
// What to say in place of a picture, or above one that is no longer live.
import type { SessionState } from "../protocol/messages";
import type { Connection, State } from "../state";
import { byId, make, setText } from "./element";

export interface Message {
  title: string;
  text: string;
  /** A command that helps. */
  command?: string;
}

export interface Situation {
  connection: Connection;
  session: SessionState | null;
  hasPicture: boolean;
  /** The worker that draws did not start. */
  cannotDraw?: boolean;
}

const startServer = "eyrie serve scene.json";
const startRenderer = "eyrie renderer --coordinator HOST:PORT";

const closedText =
  "Somebody who looks after this server has closed it. Load the page again to come back.";

const hasRenderer = (session: SessionState): boolean =>
  session.renderers.some((renderer) => renderer.alive);

/** How long the connection has been lost: "3 s". */
export function lossText(connection: Connection, now: number): string {
  if (connection.kind !== "lost") return "";
  return `${Math.max(0, Math.floor((now - connection.since) / 1000))} s`;
}

/** "No file." of the server's "no file"; "" of nothing. What begins with a name keeps that. */
function sentence(text: string): string {
  const end = text === "" || /[.!?…]$/.test(text) ? "" : ".";
  return `${text.replace(/^[a-z]+(?=[ ,]|$)/, (word) => word.charAt(0).toUpperCase() + word.slice(1))}${end}`;
}

/** What the scripts are built for, and workers that are modules; index.html says the same. */
const useAnother =
  "open this page in Chrome 94, Firefox 114, Safari 16.4 or newer; or have pictures without a browser:";
const withoutBrowser = "eyrie render --help";

/** Fills the view while there has never been a picture. */
export function messageFor(situation: Situation): Message | null {
  const { connection, session, hasPicture, cannotDraw = false } = situation;
  if (hasPicture) return null;
  if (cannotDraw)
    return {
      title: "Pictures cannot be drawn",
      text: `The page's worker did not start. Load the page again; if that does not help, this browser is too old for it: ${useAnother}`,
      command: withoutBrowser,
    };
  if (connection.kind === "lost" && connection.refusal !== "")
    return {
      title: "The server takes no connection",
      text: `${sentence(connection.refusal)} The page tries again by itself.`,
    };
  if (connection.kind === "lost")
    return {
      title: "Eyrie does not answer",
      text: "No server answers at this address. The page connects by itself as soon as one is running:",
      command: startServer,
    };
  if (connection.kind === "closed") return { title: "This session was closed", text: closedText };
  if (connection.kind === "connecting" || session === null)
    return { title: "Connecting", text: "Asking the server for the scene." };
  if (!hasRenderer(session) && session.problem !== "")
    return { title: "No renderer is running", text: sentence(session.problem) };
  if (!hasRenderer(session))
    return {
      title: "No renderer is running",
      text: "The coordinator is up, but nothing draws for it. Start a renderer that registers there:",
      command: startRenderer,
    };
  if (session.problem !== "")
    return { title: "There is no picture", text: sentence(session.problem) };
  if (session.sceneBounds === undefined)
    return { title: "Opening the scene", text: "The renderers are reading it." };
  if (session.place?.led === false) {
    const remedy = ": from here by Take the lead, under Together in the panel";
    return {
      title: "Nobody leads",
      text: `The picture appears when somebody who may steer leads this session${session.place.mayControl ? remedy : ""}.`,
    };
  }
  return { title: "Drawing the first picture", text: "It appears in a moment." };
}

/** One line above the last picture while it is not live. */
export function bannerFor({ connection, session, hasPicture }: Situation): string | null {
  if (!hasPicture) return null;
  if (connection.kind === "lost" && connection.refusal !== "")
    return `${sentence(connection.refusal)} This is the last picture; the page tries again by itself.`;
  if (connection.kind === "lost")
    return `Connection lost. This is the last picture; the page connects again by itself. If that lasts, see that the server runs: ${startServer}`;
  if (connection.kind === "closed") return `This session was closed. ${closedText}`;
  if (session === null) return null;
  if (!hasRenderer(session))
    return `No renderer is left; this is the last picture. ${sentence(session.problem) || `Start one with: ${startRenderer}`}`;
  return session.problem === "" ? null : `This is the last picture. ${sentence(session.problem)}`;
}

/** In a browser that cannot show pictures there is nothing to press either. */
export function showTooOld(): void {
  const message = byId("message", HTMLElement);
  message.append(
    make(
      "div",
      "message-box",
      make("h2", "message-title", "This browser is too old"),
      make("p", "message-text", `It has no OffscreenCanvas, which Eyrie draws with: ${useAnother}`),
      make("code", "message-command", withoutBrowser),
    ),
  );
  message.hidden = false;
  byId("panel", HTMLElement).hidden = true;
  for (const button of document.querySelectorAll("button")) button.disabled = true;
}

export function showMessages(state: State): void {
  const message = byId("message", HTMLElement);
  const banner = byId("banner", HTMLElement);
  const stage = byId("stage", HTMLElement);
  const title = make("h2", "message-title");
  const text = make("p", "message-text");
  const command = make("code", "message-command");
  const bannerText = make("span", "");
  const timer = make("span", "timer");
  timer.setAttribute("aria-hidden", "true"); // or it would be read out every second
  banner.append(bannerText, timer);
  message.append(make("div", "message-box", title, text, command));
  const update = (): void => {
    const situation: Situation = {
      connection: state.connection.value,
      session: state.session.value,
      hasPicture: state.numbers.value !== null,
      cannotDraw: state.cannotDraw.value,
    };
    const shown = messageFor(situation);
    message.hidden = shown === null;
    setText(title, shown?.title ?? "");
    setText(text, shown?.text ?? "");
    setText(command, shown?.command ?? "");
    command.hidden = shown?.command === undefined;
    const line = bannerFor(situation);
    banner.hidden = line === null;
    setText(bannerText, line ?? "");
    setText(timer, lossText(situation.connection, performance.now()));
    stage.classList.toggle("is-dimmed", line !== null);
  };
  state.connection.watch(update);
  state.session.watch(update);
  state.numbers.watch(update);
  state.cannotDraw.watch(update);
  // The seconds since the loss.
  window.setInterval(() => {
    if (state.connection.value.kind === "lost") update();
  }, 1000);
}
