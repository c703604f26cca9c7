// SPDX-License-Identifier: Apache-2.0
// The page against a server of made-up pictures: what a person does, and what they are told.
import {
  brightness,
  check,
  colourCount,
  difference,
  environment,
  run,
  ServerProcess,
} from "./support.mjs";
import { slowLink } from "./slow_link.mjs";

const web = environment("EYRIE_WEB_FOLDER");
const startServer = (...args) =>
  ServerProcess.start(environment("EYRIE_FAKE_SERVER"), [web, ...args], 20);

await run("page_test", async (browser, started) => {
  const { page } = browser;
  const server = started(await startServer());
  const port = new URL(server.url).port;

  const opened = Date.now();
  await page.goto(server.url);
  await browser.until(() => window.eyrie?.frameNumber > 0);
  console.log(`first picture after ${Date.now() - opened} ms`);
  await browser.settled();
  const home = await browser.picture();
  check(colourCount(home) > 20, "the page shows a picture");
  check(
    (await page.locator("#status").innerText()).includes("1 renderer"),
    "the chip counts renderers",
  );
  check(await page.locator("#message").isHidden(), "no message covers the picture");

  await browser.drag(150, 40);
  await browser.settled();
  const dragged = await browser.picture();
  check(difference(home, dragged) > 0.1, "dragging turns the scene");
  const latency = await browser.hook("inputToDrawnMilliseconds");
  check(latency > 0 && latency < 5000, `input to drawn is measured (${latency.toFixed(1)} ms)`);

  check(
    (await browser.canvasHash()) === (await browser.hook("pixelHash")),
    "at rest every pixel on the canvas is the server's",
  );
  check(
    (await page.locator("#numbers").innerText()).includes("· exact"),
    "and the page says that it is exact",
  );
  const times = await browser.timesToExact();
  console.log(
    `from a key: drawn ${times.drawn.toFixed(0)} ms, nearly exact ${times.fine.toFixed(0)} ms, ` +
      `exact ${times.exact.toFixed(0)} ms`,
  );
  await browser.settled();
  check(
    (await browser.canvasHash()) === (await browser.hook("pixelHash")),
    "and again after a movement",
  );

  const frames = await browser.hook("frameNumber");
  await page.waitForTimeout(700);
  check((await browser.hook("frameNumber")) === frames, "nothing is drawn while nothing changes");

  const shown = await browser.hook("viewSequence");
  await page.keyboard.press("r");
  await page.waitForFunction((before) => window.eyrie.viewSequence > before, shown);
  await browser.settled();
  check(difference(home, await browser.picture()) < 0.01, "R shows the home view again");

  for (const [key, name] of [
    ["ArrowLeft", "an arrow key orbits"],
    ["+", "plus zooms"],
    ["w", "W flies"],
  ]) {
    const before = JSON.stringify(await browser.hook("camera"));
    await page.keyboard.down(key);
    await page.waitForFunction((old) => JSON.stringify(window.eyrie.camera) !== old, before);
    await page.keyboard.up(key);
    check(true, name);
  }
  check(await page.locator("#mode").isVisible(), "flying says how to end it");
  await page.keyboard.press("Escape");
  check(await page.locator("#mode").isHidden(), "Escape ends flying");

  await page.mouse.move(400, 300);
  const far = await browser.hook("camera");
  await page.mouse.wheel(0, -300);
  await page.waitForFunction((z) => window.eyrie.camera.eye[2] !== z, far.eye[2]);
  check(true, "the wheel zooms");

  const fine = await browser.hook("triangles");
  await browser.setTau(3);
  await browser.until(() => window.eyrie.tauAchieved > 5);
  check((await browser.hook("triangles")) < fine / 4, "a larger error draws fewer triangles");
  await browser.setTau(-2);
  await page.locator(".hint", { hasText: "finest data drawn" }).waitFor();
  check(true, "an error that cannot be met is said so");

  await browser.setTau(0);
  await page.getByLabel("Fixed frame time").check();
  await page.locator("#budget").fill("10");
  const inTime = browser.until(() => window.eyrie.budgetMilliseconds === 10);
  await browser.drag(80, 0);
  await inTime;
  check(true, "a moving view is drawn for the frame time asked for");
  await page.getByText("12 ms, foreseen 9.0 ms").waitFor();
  check(true, "which is shown beside the time foreseen and taken");
  await page.waitForFunction(() => window.eyrie.exact && window.eyrie.budgetMilliseconds === 0);
  check(true, "and at rest for the error");
  await page.getByLabel("Fixed error").check();
  await browser.setTau(-2);

  await page.locator("#saturation").fill("0");
  await browser.settled();
  const grey = await browser.picture();
  const colourful = grey.filter((_, i) => i % 4 === 0 && Math.abs(grey[i] - grey[i + 1]) > 12);
  check(colourful.length < grey.length / 400, "saturation takes the colour away");
  await page.locator("#saturation").dblclick();

  await page.getByLabel("Edited").check();
  check(await page.locator(".strip").isVisible(), "editing colours shows a strip of them");
  await page.getByText("Add colour").click();
  check((await page.locator(".primitive:not(.names)").count()) === 7, "and a row for each");
  await page.getByLabel("Tints").check();
  check(await page.locator(".strip").isHidden(), "which goes with the editing");
  await page.keyboard.press("c");
  check(await page.getByText("every ").isVisible(), "C draws contour lines");

  await page.keyboard.press("x");
  await page.locator(".hint", { hasText: "nothing is promised" }).waitFor();
  check(true, "a frozen cut is said to promise nothing");
  await page.keyboard.press("x");

  await browser.drag(0, -400);
  await browser.settled();
  await page.waitForFunction(() => window.eyrie.camera.eye[2] >= 2 - 1e-5);
  check(true, "a camera led into the ground stays above it");
  await page.keyboard.press("u");
  await page.keyboard.press("r");
  await browser.drag(0, -400);
  await page.waitForFunction(() => window.eyrie.camera.eye[2] < 0);
  check(true, "U lets it go below");
  await page.keyboard.press("u");
  await page.keyboard.press("r");
  await browser.settled();
  await page.locator("canvas#view").focus();

  await page.mouse.click(480, 420);
  await page.locator("#pick", { hasText: "1234.56 m" }).waitFor();
  const card = await page.locator("#pick").innerText();
  check(card.includes("hill") && /25\d mm at most/.test(card), "a click says what is there");
  const mark = await page.locator("#pick-mark").boundingBox();
  const off = Math.hypot(mark.x + mark.width / 2 - 480, mark.y + mark.height / 2 - 420);
  check(off < 2, `and marks it (${off.toFixed(2)} px off)`);
  await page.keyboard.press("Escape");
  check(await page.locator("#pick").isHidden(), "Escape takes that away");
  check(await page.locator("#pick-mark").isHidden(), "with its mark");
  await page.mouse.dblclick(480, 420);
  await page.waitForFunction(() => Math.abs(window.eyrie.camera.target[2]) < 1e-6);
  await browser.settled();
  await page.waitForFunction(() => {
    const mark = document.querySelector("#pick-mark").getBoundingClientRect();
    const x = mark.x + mark.width / 2;
    const y = mark.y + mark.height / 2;
    return Math.abs(x - 640) < 2 && Math.abs(y - 406) < 2;
  });
  check(true, "a double click turns to the point");
  await page.keyboard.press("Escape");
  await page.mouse.click(640, 60);
  await page.locator("#pick", { hasText: "Nothing there" }).waitFor();
  check(true, "a click into the sky finds nothing");
  await page.keyboard.press("Escape");
  await page.keyboard.press("r");
  await browser.settled();

  await page.mouse.click(480, 420);
  await page.locator("#pick", { hasText: "hill" }).waitFor();
  await page.keyboard.press("h");
  check(await page.locator("#help").isVisible(), "H opens the sheet of controls");
  await page.keyboard.press("Escape");
  await page.locator("#help").waitFor({ state: "hidden" });
  await page.getByLabel("Name of the bookmark").press("Escape");
  check(
    await page.locator("#pick").isVisible(),
    "which Escape closes and nothing beside it, as in a text it closes nothing",
  );
  await page.locator("canvas#view").focus();
  server.say("no renderer");
  await page.locator("#banner", { hasText: "No renderer" }).waitFor();
  check(true, "a lost renderer is said so above the last picture");
  const boxes = await page.evaluate(() =>
    ["banner", "readout", "pick"].map((id) => {
      const { top, bottom } = document.getElementById(id).getBoundingClientRect();
      return { top, bottom };
    }),
  );
  const [banner, readout, pick] = boxes;
  check(
    readout.bottom <= banner.top && banner.bottom <= pick.top,
    "between the readout and what a click found, neither of which it hides",
  );
  server.say("renderer");
  await page.locator("#banner").waitFor({ state: "hidden" });
  check(true, "and the page recovers when it is back");

  await browser.settled();
  const live = await browser.picture();
  const camera = JSON.stringify(await browser.hook("camera"));
  await server.kill();
  await page.locator("#banner", { hasText: "Connection lost" }).waitFor();
  await page.locator("#readout", { hasText: /^waiting / }).waitFor();
  await browser.eased();
  check(
    brightness(await browser.picture()) < brightness(live) * 0.7,
    "a lost server dims the last picture",
  );

  const restarted = Date.now();
  const again = started(await startServer(port));
  await page.waitForFunction(() => window.eyrie.connection === "connected");
  console.log(`connected again ${Date.now() - restarted} ms after the start`);
  await browser.settled();
  check(JSON.stringify(await browser.hook("camera")) === camera, "the camera survives a restart");
  check(await page.locator("#banner").isHidden(), "and the picture is live again");

  const link = await slowLink(again.url, { megabits: 10_000, delay: 0 });
  await page.goto(link.url);
  await browser.settled();
  const resting = await browser.hook("frameNumber");
  await page.waitForTimeout(12_000);
  check(
    (await browser.hook("frameNumber")) === resting &&
      (await browser.hook("connection")) === "connected",
    "a view at rest stays connected, without frames",
  );
  // It may be there for some milliseconds only: the first attempt is made at once.
  await page.evaluate(() => {
    const banner = document.querySelector("#banner");
    const look = () => (window.wasTold ||= banner.textContent.includes("Connection lost"));
    new MutationObserver(look).observe(banner, { childList: true, subtree: true });
  });
  link.fallSilent();
  await page.focus("#view");
  await page.keyboard.press("ArrowLeft");
  const turned = JSON.stringify(await browser.hook("camera"));
  const silent = Date.now();
  await browser.until(() => window.wasTold === true, 30_000);
  check(true, "a connection that dies without being closed is said to be lost");
  await browser.until(() => window.eyrie.connection === "connected");
  console.log(`connected again ${Date.now() - silent} ms after the silence began`);
  await browser.settled();
  check(JSON.stringify(await browser.hook("camera")) === turned, "and made again by itself");
  check(await page.locator("#banner").isHidden(), "with the view that was asked for meanwhile");
  link.close();
});
