// SPDX-License-Identifier: Apache-2.0
import "./style.css";
import { exposeHooks } from "./hooks";
import { misreadOutput, outputOf } from "./output";
import { keepCover } from "./panel/cover";
import { keepDescription } from "./panel/description";
import { showDisplays } from "./panel/displays";
import { byId } from "./panel/element";
import { showEqualizers } from "./panel/equalizers";
import { showFlight } from "./panel/flight";
import { showMeasure } from "./panel/measure";
import { showMessages, showTooOld } from "./panel/message";
import { showNotice } from "./panel/notice";
import { showNumbers } from "./panel/numbers";
import { showPick } from "./panel/pick";
import { showPlots } from "./panel/plots";
import { showQuality } from "./panel/quality";
import { showReadout } from "./panel/readout";
import { showRenderers } from "./panel/renderers";
import { showScene } from "./panel/scene";
import { showSession } from "./panel/session";
import { signedIn, signIn, signInAgain } from "./panel/sign_in";
import { showStatus } from "./panel/status";
import { showTerrain } from "./panel/terrain";
import { setUpToolbar } from "./panel/toolbar";
import { keepAddress, showViews } from "./panel/views";
import { joiningOf, misreadJoining, newName, socketUrl } from "./place";
import { onUnknown } from "./protocol/ask";
import { State } from "./state";
import { PictureCanvas } from "./view/canvas";
import { Viewer } from "./viewer";

function start(): void {
  const canvas = byId("view", HTMLCanvasElement);
  if (!PictureCanvas.isSupported()) {
    showTooOld();
    return;
  }
  const state = new State();
  const misread = misreadOutput(window.location.search); // the address is put right below
  state.output.set(outputOf(window.location.search));
  const joining = joiningOf(window.location.search);
  const self = newName((bytes) => crypto.getRandomValues(bytes));
  // Who led before the connection was lost leads again, and nobody else; at once, too, where the
  // server does not know yet that it was lost.
  const url = (): string => {
    const place = state.session.value?.place;
    const role = place === undefined ? joining.role : place.leads ? "lead" : "watch";
    return socketUrl(window.location.href, { ...joining, role }, self);
  };
  const viewer = new Viewer(canvas, url, state);
  showStatus(state);
  showMessages(state);
  showQuality(state);
  showDisplays(state, viewer);
  showScene(state, viewer);
  showTerrain(state, viewer);
  showNumbers(state);
  showReadout(state);
  showPick(state);
  showMeasure(state, viewer);
  showViews(state, viewer);
  showSession(state, viewer, showFlight(state, viewer));
  showRenderers(state);
  showEqualizers(state);
  showPlots(state);
  showNotice(state);
  state.notice.set(misreadJoining(window.location.search) || misread);
  keepAddress(state, viewer);
  setUpToolbar(state, viewer);
  keepCover(state, canvas);
  keepDescription(state, canvas);
  exposeHooks(state, viewer);
  onUnknown(signInAgain);
  state.connection.watch(({ kind }) => {
    if (kind === "lost") void signInAgain();
    else if (kind === "connected") signedIn();
  });
}

byId("message", HTMLElement).hidden = true;
byId("unread", HTMLElement).remove();
void signIn().then(start);
