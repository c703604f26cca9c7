// SPDX-License-Identifier: Apache-2.0
import { State, Viewer } from "../embed/eyrie.js";

const state = new State();
const socket = new URL("../ws", location.href);
socket.protocol = socket.protocol === "https:" ? "wss:" : "ws:";
const viewer = new Viewer(document.querySelector("canvas"), socket.href, state);
state.numbers.watch((numbers) => {
  if (numbers === null) return;
  const error = `off by ${numbers.tauAchieved.toFixed(2)} pixels at most`;
  document.querySelector("output").value = numbers.exact ? `Exact picture, ${error}` : error;
});
document.querySelector("button").addEventListener("click", () => viewer.steering.goHome());
