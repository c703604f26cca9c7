// SPDX-License-Identifier: Apache-2.0
// The demo in the real program: renderers, coordinator and page.
import {
  brightness,
  check,
  colourCount,
  difference,
  environment,
  run,
  ServerProcess,
} from "./support.mjs";

/**
 * Turns the view by a key, and compares the picture that comes first, of several JPEGs, with the
 * exact one that follows: how many there were, and the mean difference of the pixels' values, NaN
 * where it was smaller.
 */
function movingBesideExact(page) {
  return page.evaluate(async () => {
    const canvas = document.querySelector("#view");
    const frame = () => new Promise((resolve) => requestAnimationFrame(resolve));
    const pixels = () => {
      const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
      copy.drawImage(canvas, 0, 0);
      return copy.getImageData(0, 0, canvas.width, canvas.height).data;
    };
    const before = window.eyrie.viewSequence;
    document.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", bubbles: true }));
    document.dispatchEvent(new KeyboardEvent("keyup", { key: "ArrowLeft", bubbles: true }));
    let [moving, count] = [null, 0];
    while (!(window.eyrie.viewSequence > before && window.eyrie.exact)) {
      await frame();
      if (window.eyrie.viewSequence === before || window.eyrie.still) continue;
      [moving, count] = [pixels(), window.eyrie.tiles];
    }
    await frame();
    const exact = pixels();
    if (moving?.length !== exact.length) return { count, difference: Number.NaN };
    const sum = exact.reduce((all, value, i) => all + Math.abs(value - moving[i]), 0);
    return { count, difference: sum / exact.length };
  });
}

await run("demo_test", async (browser, started) => {
  const { page } = browser;
  const serve = ["serve", environment("EYRIE_SCENE"), "--listen", "127.0.0.1:0"];
  const server = started(await ServerProcess.start(environment("EYRIE_BINARY"), serve, 90));

  const opened = Date.now();
  await page.goto(server.url);
  await browser.until(() => window.eyrie?.frameNumber > 0, 60_000);
  console.log(`first picture after ${Date.now() - opened} ms`);
  await browser.settled();
  const home = await browser.picture();
  check(colourCount(home) > 20, "the page shows the demo");
  console.log(`status: ${(await page.locator("#status").innerText()).replaceAll("\n", " ")}`);

  await browser.drag(200, 60, 60);
  const fps = await browser.hook("fps");
  await browser.settled();
  check(difference(home, await browser.picture()) > 0.05, "dragging turns the scene");
  const latency = await browser.hook("inputToDrawnMilliseconds");
  console.log(`while dragging: ${fps} frames/s, input to drawn ${latency.toFixed(1)} ms`);
  const times = await browser.timesToExact();
  console.log(
    `from a key: drawn ${times.drawn.toFixed(0)} ms, nearly exact ${times.fine.toFixed(0)} ms, ` +
      `exact ${times.exact.toFixed(0)} ms`,
  );
  await browser.settled();
  check(
    (await browser.canvasHash()) === (await browser.hook("pixelHash")),
    "at rest every pixel on the canvas is the server's",
  );

  // On a machine that was busy for a moment the first may be smaller, or coarser, as for a slow link.
  const isRight = ({ count, difference }) => count === 2 && difference < 3;
  let tiles = await movingBesideExact(page);
  for (let again = 0; again < 8 && !isRight(tiles); ++again) {
    await browser.settled();
    tiles = await movingBesideExact(page);
  }
  check(
    isRight(tiles),
    `moving pictures are the ${tiles.count} tiles that renderers encoded, ` +
      `${tiles.difference.toFixed(2)} levels beside the exact one`,
  );
  await browser.settled();

  const fine = await browser.hook("triangles");
  check(fine > 0, `triangles are counted (${fine})`);
  const sequence = await browser.hook("viewSequence");
  await browser.setTau(4);
  await page.waitForFunction(
    (before) => window.eyrie.viewSequence > before && window.eyrie.still,
    sequence,
  );
  const coarse = await browser.hook("triangles");
  check(coarse < fine, `a larger error draws fewer triangles (${coarse})`);

  await browser.settled();
  const byPixels = await browser.picture();
  await page.locator("#layout").selectOption("DB dynamic");
  await page.waitForTimeout(300);
  await browser.settled();
  check((await page.locator("#layout").inputValue()) === "DB dynamic", "the layout is switched");
  check(difference(byPixels, await browser.picture()) === 0, "and shows the same picture");

  const live = await browser.picture();
  await server.kill();
  await page.locator("#banner", { hasText: "Connection lost" }).waitFor();
  await browser.eased();
  check(
    brightness(await browser.picture()) < brightness(live) * 0.8,
    "a lost server dims the last picture",
  );
});
