// SPDX-License-Identifier: Apache-2.0
// A hand that drags, and a record of the pictures that follow it.

const secondsAtMost = 30;

/**
 * Drags for `seconds`, and on until `least` moving pictures have come, for half a minute at most. Of
 * each picture that came: `time`, `latency` (input to drawn, the median of the last ones), `quality`
 * ("H.264" of one of a stream), `width`, `still`, `view`, and `late`, how long the one before it had
 * been out of date; milliseconds. `during` is called halfway; what came after it has `isAfter`.
 */
export async function recordDrag(page, seconds, { during, least = 0 } = {}) {
  await page.evaluate(() => {
    window.drawn = [];
    window.isAfter = false;
    let last = window.eyrie.frameNumber;
    let late = 0;
    window.recorder = setInterval(() => {
      const { eyrie } = window;
      if (eyrie.frameNumber !== last) {
        last = eyrie.frameNumber;
        window.drawn.push({
          time: performance.now(),
          latency: eyrie.inputToDrawnMilliseconds,
          quality: eyrie.video ? "H.264" : eyrie.quality,
          width: eyrie.width,
          still: eyrie.still,
          view: eyrie.viewSequence,
          late,
          isAfter: window.isAfter,
        });
        late = 0;
      }
      late = Math.max(late, eyrie.waitingMilliseconds);
    }, 2);
  });
  const { mouse } = page;
  await mouse.move(500, 400);
  await mouse.down();
  const start = Date.now();
  let isHalfway = false;
  const elapsed = () => (Date.now() - start) / 1000;
  const isEnough = () =>
    page.evaluate((count) => window.drawn.filter(({ still }) => !still).length >= count, least);
  const isDone = async () =>
    elapsed() >= secondsAtMost || (elapsed() >= seconds && (await isEnough()));
  for (let i = 0; !(await isDone()); ++i) {
    await mouse.move(500 + 200 * Math.sin(i / 50), 400 + 60 * Math.cos(i / 40));
    if (during && !isHalfway && elapsed() > seconds / 2) {
      isHalfway = true;
      during();
      await page.evaluate(() => (window.isAfter = true));
    }
  }
  await mouse.up();
  return page.evaluate(() => {
    clearInterval(window.recorder);
    return window.drawn;
  });
}

export const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];

/** The last pictures of a record. */
export function lastSeconds(drawn, seconds) {
  const end = drawn.at(-1).time;
  return drawn.filter(({ time }) => time > end - seconds * 1000);
}
