// SPDX-License-Identifier: Apache-2.0
// A device with a finer screen than CSS counts on, and no mouse.
import { check, environment, panelWidth, run, ServerProcess } from "./support.mjs";

const viewport = { width: 900 + panelWidth, height: 546 };
const device = { viewport, deviceScaleFactor: 2, hasTouch: true };

await run("device_test", async (browser, started) => {
  const web = environment("EYRIE_WEB_FOLDER");
  const server = started(await ServerProcess.start(environment("EYRIE_FAKE_SERVER"), [web], 20));
  browser.page = await browser.openAnother(server.url, device);
  const { page } = browser;
  await browser.settled();

  const canvas = await page.evaluate(() => {
    const { width, height, clientWidth, clientHeight } = document.querySelector("#view");
    return { width, height, clientWidth, clientHeight };
  });
  check(
    canvas.clientWidth === 900 && canvas.clientHeight === 500,
    "the canvas is 900 x 500 in CSS",
  );
  check(
    (await browser.hook("width")) === 1800 && (await browser.hook("height")) === 1000,
    "the picture at rest has all pixels of a screen with twice as many",
  );
  check(canvas.width === 1800 && canvas.height === 1000, "and so has the canvas that shows it");
  check(
    (await browser.canvasHash()) === (await browser.hook("pixelHash")),
    "each of them the server's",
  );

  const target = async () => (await browser.hook("camera")).target;
  const before = await target();
  await page.touchscreen.tap(300, 300);
  await page.locator("#pick", { hasText: "hill" }).waitFor();
  check(
    JSON.stringify(await target()) === JSON.stringify(before),
    "a tap says what is there, and leaves the view",
  );
  const point = async () => /x, y, z\n(.*)/.exec(await page.locator("#pick").innerText())[1];
  const tapped = await point();
  await page.waitForTimeout(700); // longer than between the taps of a double one
  await page.touchscreen.tap(300, 300);
  await page.touchscreen.tap(300, 300);
  await browser.until(() => Math.abs(window.eyrie.camera.target[2]) < 1e-6); // on the ground
  check(JSON.stringify(await target()) !== JSON.stringify(before), "a double tap turns to a point");
  await browser.settled();
  await page.waitForFunction(() => {
    const mark = document.querySelector("#pick-mark").getBoundingClientRect();
    return (
      Math.abs(mark.x + mark.width / 2 - 450) < 2 && Math.abs(mark.y + mark.height / 2 - 296) < 2
    );
  });
  check(
    (await point()) === tapped,
    `the one that was tapped (${tapped}), which is in the middle now`,
  );

  await page.setViewportSize({ width: 320, height: 568 });
  const isWithin = await page.evaluate(() =>
    [...document.querySelectorAll(".tools button, #pick .value")].every((element) => {
      const { left, right } = element.getBoundingClientRect();
      const box = element.closest("#pick")?.getBoundingClientRect() ?? { left: 0, right: 320 };
      return left >= box.left && right <= box.right;
    }),
  );
  check(isWithin, "on the narrowest screens all buttons and values are within it");

  // The longest that the chip says.
  await page.locator("#status .chip-text").evaluate((text) => {
    text.textContent = "Waiting for a frame";
  });
  const crowded = [];
  for (let width = 320; width <= 1000; width += 20) {
    await page.setViewportSize({ width, height: 568 });
    const isFree = await page.evaluate(() => {
      const chip = document.querySelector("#status").getBoundingClientRect();
      const tools = document.querySelector(".tools").getBoundingClientRect();
      const text = document.querySelector("#status .chip-text");
      const isWhole = text.scrollWidth <= text.clientWidth;
      const isOutside = text.getBoundingClientRect().right > chip.right;
      const isUnseen = getComputedStyle(text).clipPath !== "none";
      const holds = isUnseen || (isWhole && !isOutside);
      return chip.right <= tools.left && tools.right <= window.innerWidth && holds;
    });
    if (!isFree) crowded.push(width);
  }
  check(crowded.length === 0, `the bar has room for all of it at any width ${crowded.join()}`);

  await page.keyboard.press("b");
  const overlaps = [];
  for (const width of [320, 480, 701, 800, 1100]) {
    await page.setViewportSize({ width, height: 568 });
    const isOver = await page.evaluate(() => {
      const [recording, ...others] = ["#recording", "#readout", "#pick"].map((name) =>
        document.querySelector(name).getBoundingClientRect(),
      );
      return others.some(
        ({ left, right, top, bottom }) =>
          Math.min(right, recording.right) > Math.max(left, recording.left) &&
          Math.min(bottom, recording.bottom) > Math.max(top, recording.top),
      );
    });
    if (isOver) overlaps.push(width);
  }
  check(overlaps.length === 0, `nor does what is said on the picture overlap ${overlaps.join()}`);
});
