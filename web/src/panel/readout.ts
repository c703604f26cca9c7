// SPDX-License-Identifier: Apache-2.0
// One line on the picture that is there whatever else is: how fast pictures come and how late, how
// far off this one is, and how it was sent.
import type { Numbers, State } from "../state";
import { bandwidth } from "../view/history";
import { byId, make, setText } from "./element";
import { milliseconds, pixels } from "./format";
import { frameText, sentText } from "./numbers";
import { tauHint } from "./quality";

const second = 1000;

export interface Readout {
  speed: string;
  error: string;
  /** The error is not what was asked for, or something is missing. */
  isWarning: boolean;
  sent: string;
}

export function readoutOf(numbers: Numbers, bitsPerSecond: number): Readout {
  const { fps, inputToDrawnMilliseconds: late, tauAchieved, complete } = numbers;
  const speed = [
    frameText(numbers, "fps"),
    ...(Number.isNaN(late) ? [] : [milliseconds(late)]),
    ...(fps === 0 ? [] : [`${(bitsPerSecond / 1e6).toFixed(1)} Mbit/s`]),
  ];
  return {
    speed: speed.join(" · "),
    error: pixels(tauAchieved),
    isWarning: !complete || tauHint(numbers) !== "",
    sent: complete ? sentText(numbers) : `${sentText(numbers)}, incomplete`,
  };
}

export function showReadout(state: State): void {
  const speed = make("span", "");
  const error = make("span", "");
  const sent = make("span", "");
  const line = byId("readout", HTMLElement);
  line.append(speed, " · ", error, " · ", sent);
  let frames: { time: number; bytes: number }[] = [];
  let lastFrame = 0;
  state.numbers.watch((numbers) => {
    line.hidden = numbers === null;
    if (numbers === null) return;
    const now = performance.now();
    frames = frames.filter(({ time }) => time > now - second);
    // What changes without a frame, the rate, brings no bytes.
    if (numbers.frameNumber !== lastFrame) frames.push({ time: now, bytes: numbers.pictureBytes });
    lastFrame = numbers.frameNumber;
    const text = readoutOf(numbers, bandwidth(frames, now, second, 1)[0] ?? 0);
    setText(speed, text.speed);
    setText(error, text.error);
    setText(sent, text.sent);
    error.classList.toggle("is-warning", text.isWarning);
  });
}
