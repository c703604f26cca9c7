// SPDX-License-Identifier: Apache-2.0
// A device with a finer screen than CSS counts on, and no mouse.
import { check, environment, panelWidth, run, ServerProcess } from "./support.mjs";

const viewport = { width: 900 + panelWidth, height: 546 };
const device = { viewport, deviceScaleFactor: 2, hasTouch: true };

/** Runs in the page: what overlaps of what is seen. */
function coveredPairs() {
  const seen = ["readout", "recording", "pick", "measure", "notice", "mode", "panel"].map((id) => {
    const element = document.getElementById(id);
    const box = element.getBoundingClientRect();
    const frame = element.closest(".cards, body").getBoundingClientRect();
    return {
      id,
      left: Math.max(box.left, frame.left),
      right: Math.min(box.right, frame.right),
      top: Math.max(box.top, frame.top),
      bottom: Math.min(box.bottom, frame.bottom),
    };
  });
  return seen.flatMap((a, i) =>
    seen
      .slice(i + 1)
      .filter(
        (b) =>
          Math.min(a.right, b.right) > Math.max(a.left, b.left) &&
          Math.min(a.bottom, b.bottom) > Math.max(a.top, b.top),
      )
      .map((b) => `${a.id} and ${b.id}`),
  );
}

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

  // As much as can be said at once.
  await page.keyboard.press("m");
  for (const key of ["Shift+ArrowRight", "Shift+ArrowDown", "Shift+ArrowLeft"]) {
    await page.keyboard.press(key);
    await browser.settled();
    await page.keyboard.press(" ");
    await page.locator("#pick", { hasText: "hill" }).waitFor();
  }
  await page.locator("#measure", { hasText: "Area" }).waitFor();
  await page.keyboard.press("v");
  await page.locator("#measure .chart").waitFor();
  await page.keyboard.press("b");
  await page.keyboard.press("f");
  const covered = [];
  for (const [width, height] of [
    [1280, 720],
    [800, 500],
    [640, 400],
    [320, 568],
  ]) {
    await page.setViewportSize({ width, height });
    for (const isPanelShown of [true, false]) {
      if ((await page.locator("#panel").isVisible()) !== isPanelShown)
        await page.keyboard.press("p");
      await page.keyboard.press("k"); // says that the command is copied
      await page.locator("#notice:not(.is-empty)").waitFor();
      covered.push(...(await page.evaluate(coveredPairs)).map((pair) => `${width}: ${pair}`));
    }
    for (const name of ["Close", "×"])
      await page.locator(".pick").getByText(name, { exact: true }).click({ trial: true });
  }
  check(
    covered.length === 0,
    `nothing that is said on the picture covers another, nor the panel ${covered.join()}`,
  );
});
