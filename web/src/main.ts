// SPDX-License-Identifier: Apache-2.0
import "./style.css";
import { exposeHooks } from "./hooks";
import { outputOf } from "./output";
import { keepDescription } from "./panel/description";
import { showDisplays } from "./panel/displays";
import { byId } from "./panel/element";
import { showMeasure } from "./panel/measure";
import { showMessages } from "./panel/message";
import { showNotice } from "./panel/notice";
import { showNumbers } from "./panel/numbers";
import { showPick } from "./panel/pick";
import { showPlots } from "./panel/plots";
import { showQuality } from "./panel/quality";
import { signIn, signInAgain } from "./panel/sign_in";
import { showStatus } from "./panel/status";
import { showTerrain } from "./panel/terrain";
import { setUpToolbar } from "./panel/toolbar";
import { keepAddress, showViews } from "./panel/views";
import { State } from "./state";
import { PictureCanvas } from "./view/canvas";
import { Viewer } from "./viewer";

/** /ws beside the page. */
function socketUrl(): string {
  const url = new URL("ws", window.location.href);
  url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
  return url.href;
}

function start(): void {
  const canvas = byId("view", HTMLCanvasElement);
  if (!PictureCanvas.isSupported()) {
    const message = byId("message", HTMLElement);
    message.textContent =
      "This browser is too old: Eyrie needs OffscreenCanvas (Chrome 69, Firefox 105, Safari 16.4 or newer).";
    message.hidden = false;
    return;
  }
  const state = new State();
  state.output.set(outputOf(window.location.search));
  const viewer = new Viewer(canvas, socketUrl(), state);
  showStatus(state);
  showMessages(state);
  showQuality(state);
  showDisplays(state, viewer);
  showTerrain(state, viewer);
  showNumbers(state);
  showPick(state);
  showMeasure(state, viewer);
  showViews(state, viewer);
  showPlots(state);
  showNotice(state);
  keepAddress(state, viewer);
  setUpToolbar(state, viewer);
  keepDescription(state, canvas);
  exposeHooks(state, viewer);
  state.connection.watch(({ kind }) => {
    if (kind === "lost") void signInAgain();
  });
}

void signIn().then(start);
