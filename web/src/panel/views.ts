// SPDX-License-Identifier: Apache-2.0
// Ways to views and from them: standard ones, bookmarks, the link, the command, the picture as a
// file.
import { addBookmark, readBookmarks, removeBookmark } from "../bookmarks";
import { standardViews } from "../camera/standard";
import { cameraJson, curlCommand, imageRequest, pythonScript, renderCommand } from "../command";
import { decodeView, encodeView } from "../share";
import type { SharedView } from "../share";
import type { State } from "../state";
import { browserStorage } from "../storage";
import type { Viewer } from "../viewer";
import { copyText, download } from "./clipboard";
import { configuredFor } from "./displays";
import { button, byId, make } from "./element";
import { onKeys } from "./keys";
import { posterField } from "./poster";

/** How long an exact picture may take to come, when one is to be saved. */
const exactWithin = 10_000;
/** The address changes no oftener: browsers refuse that, Safari from 100 times in half a minute on. */
const addressEvery = 1000;

function bookmarkList(state: State, viewer: Viewer): HTMLElement {
  const list = make("ul", "bookmarks");
  const name = make("input", "text");
  name.type = "text";
  name.id = "bookmark-name";
  name.maxLength = 80;
  name.placeholder = "Name of this view";
  name.setAttribute("aria-label", "Name of the bookmark");
  const fill = (): void => {
    const rows = readBookmarks(browserStorage()).map((bookmark) => {
      const go = button(bookmark.name, `Show ${bookmark.name}`, () => viewer.show(bookmark.view));
      const remove = button("×", `Remove ${bookmark.name}`, () => {
        removeBookmark(browserStorage(), bookmark.name);
        fill();
        name.focus();
      });
      remove.setAttribute("aria-label", remove.title);
      return make("li", "bookmark", go, remove);
    });
    list.replaceChildren(...rows);
    list.hidden = rows.length === 0;
  };
  const form = make("form", "row");
  const add = make("button", "small", "Keep");
  add.type = "submit";
  add.title = "Keep this view under the name";
  form.append(name, add);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const view = viewer.sharedView();
    const title = name.value.trim();
    if (view === null || title === "") return state.notice.set("A view that is kept has a name");
    const isKept = addBookmark(browserStorage(), title, view);
    state.notice.set(
      isKept
        ? `Kept as ${title}`
        : "This browser keeps no more bookmarks: it is full, or forbids it",
    );
    name.value = "";
    fill();
  });
  fill();
  return make("div", "field", form, list);
}

/** The exact picture, or why there is none; the view comes to rest first where it moves. */
export async function exactPicture(
  { connection }: Pick<State, "connection">,
  viewer: Pick<Viewer, "exactNow">,
): Promise<Blob | string> {
  const deadline = performance.now() + exactWithin;
  const isConnected = (): boolean => connection.value.kind === "connected";
  while (viewer.exactNow() === undefined && isConnected() && performance.now() < deadline)
    await new Promise((resolve) => setTimeout(resolve, 50));
  const picture = viewer.exactNow();
  if (picture !== undefined) return picture.png;
  return isConnected()
    ? "There is no exact picture to save yet"
    : "There is no exact picture to save without a connection to the server";
}

/** The commands, for buttons and keys alike. */
function commands(state: State, viewer: Viewer) {
  const copy = async (what: string, text: string): Promise<void> =>
    state.notice.set((await copyText(text)) ? `${what} copied` : `${what}: copying is forbidden`);
  const withView = (action: (view: SharedView) => Promise<void>) => () => {
    const view = viewer.sharedView();
    if (view !== null) void action(view);
  };
  const requestOf = (view: SharedView) => imageRequest(view, viewer.pictureSize, viewer.output);
  const page = (): string => window.location.href;
  return {
    link: withView((view) => {
      const url = new URL(window.location.href);
      url.hash = encodeView(view);
      return copy("Link", url.href);
    }),
    command: withView((view) => {
      const throughWall = (state.shown.value?.seen ?? null) !== null;
      const canvases = state.session.value?.canvases ?? [];
      const configured = configuredFor(canvases, viewer.output, throughWall);
      const text = renderCommand(view, viewer.pictureSize, viewer.output, configured);
      return copy("Command", text);
    }),
    camera: withView((view) => copy("Camera", cameraJson(view.camera))),
    curl: withView((view) => copy("curl command", curlCommand(requestOf(view), page()))),
    python: withView((view) => copy("Python script", pythonScript(requestOf(view), page()))),
    save: () =>
      void exactPicture(state, viewer).then((picture) => {
        if (typeof picture === "string") state.notice.set(picture);
        else download(picture, "eyrie.png");
      }),
  };
}

/** Keeps the address a link to the view that is shown, and follows it when it is edited. */
export function keepAddress(
  state: Pick<State, "numbers" | "notice">,
  viewer: Pick<Viewer, "sharedView" | "show">,
): void {
  let fragment = "";
  let writtenAt = -Infinity;
  let timer: number | undefined;
  const write = (): void => {
    timer = undefined;
    if (fragment === window.location.hash) return;
    writtenAt = performance.now();
    window.history.replaceState(null, "", fragment);
  };
  const follow = (): void => {
    window.clearTimeout(timer);
    timer = undefined;
    const { hash } = window.location;
    if (hash.length <= 1) return;
    const view = decodeView(hash);
    if (view === undefined) state.notice.set("The link's view cannot be read; it is left out");
    else viewer.show(view);
  };
  follow();
  window.addEventListener("hashchange", follow);
  state.numbers.watch((numbers) => {
    const view = viewer.sharedView();
    if (numbers?.exact !== true || view === null) return;
    fragment = `#${encodeView(view)}`;
    const wait = writtenAt + addressEvery - performance.now();
    if (wait <= 0) write();
    else timer ??= window.setTimeout(write, wait);
  });
}

export function showViews(state: State, viewer: Viewer): void {
  const { link, command, camera, curl, python, save } = commands(state, viewer);
  const standard = make("div", "small-buttons");
  standard.setAttribute("role", "group");
  standard.setAttribute("aria-label", "Standard views");
  const keys: Record<string, (time: number) => void> = { l: link, k: command, o: save };
  standardViews.forEach((view, i) => {
    const key = String(i + 1);
    standard.append(
      button(view.name, `${view.name} (${key})`, () => viewer.steering.goTo(i, performance.now())),
    );
    keys[key] = (time) => viewer.steering.goTo(i, time);
  });
  onKeys(keys);
  byId("views", HTMLElement).append(
    make("h2", "heading", "Views"),
    standard,
    bookmarkList(state, viewer),
    make(
      "div",
      "small-buttons field",
      button("Copy link", "A link to this view (L)", link),
      button("Copy command", "eyrie render, for this picture (K)", command),
      button("Copy camera", "As JSON, for --camera", camera),
      button("Copy as curl", "A request to this server for this picture", curl),
      button("Copy as Python", "The same as a script", python),
      button("Save picture", "The exact picture as a PNG file (O)", save),
    ),
    posterField(state, viewer),
  );
}
