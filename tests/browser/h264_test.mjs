// SPDX-License-Identifier: Apache-2.0
// Moving pictures as H.264 over a slow link: that they show what they are to show, that the picture at
// rest is exact, and that JPEGs come where a stream cannot be decoded.
import { check, environment, run, ServerProcess } from "./support.mjs";
import { slowLink } from "./slow_link.mjs";

/** Turns the view by keys until `isEnough` says so in the page, for so many milliseconds; whether it did. */
function turnUntil(page, isEnough, limit = 40_000) {
  return page.evaluate(
    async ([source, limit]) => {
      const canvas = document.querySelector("#view");
      canvas.focus();
      const isDone = new Function(`return (${source})()`);
      const end = performance.now() + limit;
      for (let i = 0; performance.now() < end; ++i) {
        const key = i % 80 < 40 ? "ArrowLeft" : "ArrowRight";
        canvas.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
        await new Promise((resolve) => setTimeout(resolve, 30));
        if (isDone()) return true;
      }
      return false;
    },
    [isEnough.toString(), limit],
  );
}

/**
 * Decibels between the last moving picture of the view at which it now stops and its exact picture;
 * null where that was no H.264.
 */
function likenessAtRest(page) {
  return page.evaluate(async () => {
    const canvas = document.querySelector("#view");
    const copy = new OffscreenCanvas(1, 1);
    const context = copy.getContext("2d", { alpha: false, willReadFrequently: true });
    const grab = ({ width, height }) => {
      [copy.width, copy.height] = [width, height];
      context.imageSmoothingQuality = "high";
      context.drawImage(canvas, 0, 0, width, height);
      return context.getImageData(0, 0, width, height);
    };
    let moving = null;
    const end = performance.now() + 20_000;
    while (!window.eyrie.exact && performance.now() < end) {
      const { video, viewSequence, frameNumber } = window.eyrie;
      const pixels = video ? grab(window.eyrie) : null;
      // Only what was there all the time.
      if (pixels && window.eyrie.frameNumber === frameNumber) moving = { pixels, viewSequence };
      await new Promise((resolve) => setTimeout(resolve, 5));
    }
    const { viewSequence } = window.eyrie;
    if (moving?.viewSequence !== viewSequence) return null;
    const { width, height } = moving.pixels;
    const exact = grab(moving.pixels);
    let sum = 0;
    for (let i = 0; i < exact.data.length; ++i) sum += (exact.data[i] - moving.pixels.data[i]) ** 2;
    const decibels = 10 * Math.log10((255 ** 2 * 3 * width * height) / sum);
    return { decibels, isWhole: width === window.eyrie.width };
  });
}

/** The fields of a protobuf message by their numbers: numbers, or bytes of what has a length. */
function fieldsOf(message) {
  const fields = new Map();
  let at = 0;
  const varint = () => {
    let value = 0;
    for (let shift = 1; ; shift *= 128) {
      const byte = message[at++];
      value += (byte & 127) * shift;
      if (byte < 128) return value;
    }
  };
  while (at < message.length) {
    const tag = varint();
    const type = tag & 7;
    const number = Math.floor(tag / 8);
    if (type === 0) {
      fields.set(number, varint());
    } else {
      const length = type === 2 ? varint() : type === 1 ? 8 : 4;
      fields.set(number, message.subarray(at, at + length));
      at += length;
    }
  }
  return fields;
}

/** The VideoPlace (a Frame's field 17) of a message with a picture of a stream (16); null for others. */
function placeInStream(message) {
  const frame = fieldsOf(message).get(2);
  const fields = frame && fieldsOf(frame);
  return fields?.has(16) ? fieldsOf(fields.get(17)) : null;
}

await run("h264_test", async (browser, started) => {
  const { page } = browser;
  const server = started(
    await ServerProcess.start(
      environment("EYRIE_FAKE_SERVER"),
      [environment("EYRIE_WEB_FOLDER"), "--h264"],
      20,
    ),
  );
  const { url, close } = await slowLink(server.url, { megabits: 12, delay: 10 });

  // Loses a picture of a stream, when told to, and tells whether the next can be decoded without it.
  let drops = 0;
  let next = null;
  await page.routeWebSocket(/\/ws/, (socket) => {
    const upstream = socket.connectToServer();
    upstream.onMessage((message) => {
      const place = typeof message === "string" ? null : placeInStream(message);
      if (drops > 0 && place !== null) {
        drops -= 1;
        next = null; // not known yet
        return;
      }
      if (place !== null) next ??= { isKey: place.get(3) === 1 };
      socket.send(message);
    });
  });
  await page.goto(url);
  await browser.settled();

  check(
    await turnUntil(page, () => window.eyrie.video),
    "over a slow link the moving view comes as H.264",
  );
  let likeness = null;
  for (let i = 0; i < 10 && likeness === null; ++i) {
    await turnUntil(page, () => window.eyrie.video);
    likeness = await likenessAtRest(page);
  }
  // A browser that has no time is sent smaller ones, to be compared with the exact one made smaller.
  check(
    likeness !== null && likeness.decibels > (likeness.isWhole ? 30 : 22),
    `a picture of the stream is like the exact one (${likeness?.decibels.toFixed(1)} dB)`,
  );
  await browser.settled();
  check(
    (await browser.canvasHash()) === (await browser.hook("pixelHash")),
    "the picture at rest is the server's, bit for bit",
  );

  await page.evaluate(() => {
    setInterval(() => (window.sawVideo ||= window.eyrie.video), 1);
  });
  let endsStream = false;
  // Where a stream happens to begin anew right after the picture that is lost, it goes on.
  for (let i = 0; i < 5 && !endsStream; ++i) {
    check(await turnUntil(page, () => window.eyrie.video), "the stream goes on");
    [drops, next] = [1, { isKey: false }];
    const sawJpegs = await turnUntil(
      page,
      () => {
        const { video, still, quality } = window.eyrie;
        return !video && !still && quality > 0;
      },
      20_000,
    );
    if (!sawJpegs && next?.isKey) continue;
    check(sawJpegs, "where a picture of the stream is lost, JPEGs come in its place");
    if (drops > 0) continue; // they came for another reason
    await page.evaluate(() => {
      window.sawVideo = false;
      window.turnsUntil = performance.now() + 1500;
    });
    await turnUntil(page, () => performance.now() > window.turnsUntil);
    endsStream = !(await page.evaluate(() => window.sawVideo));
    check(endsStream || next?.isKey, "nothing more of it is shown but from a key on");
  }
  check(endsStream, "and no stream again");
  await browser.settled();
  check(await browser.hook("exact"), "and the picture at rest is exact");

  // ---- A browser without WebCodecs
  const plain = await browser.chromium.newPage();
  await plain.addInitScript(() => delete window.VideoDecoder);
  await plain.goto(url);
  await plain.waitForFunction(() => window.eyrie?.exact === true);
  await plain.evaluate(() => {
    window.sawVideo = false;
    setInterval(() => (window.sawVideo ||= window.eyrie.video), 1);
    window.turnsUntil = performance.now() + 2500;
  });
  await turnUntil(plain, () => performance.now() > window.turnsUntil);
  check(!(await plain.evaluate(() => window.sawVideo)), "who cannot decode H.264 gets none");
  await plain.close();
  close();
});
