// SPDX-License-Identifier: Apache-2.0
// Two pages in one session: one leads, the other sees the same and may take over.
import { check, environment, run, ServerProcess } from "./support.mjs";

const patience = { timeout: 30_000, polling: 50 };

const camera = (page) => page.evaluate(() => JSON.stringify(window.eyrie.camera));

/** Waits until the page has the server's picture bit for bit, of a newer frame than `after`. */
async function exact(page, after = 0) {
  await page.waitForFunction(
    (before) =>
      window.eyrie?.exact === true &&
      !window.eyrie.waitingMilliseconds &&
      window.eyrie.frameNumber > before,
    after,
    patience,
  );
  return page.evaluate(() => window.eyrie.pixelHash);
}

const frame = (page) => page.evaluate(() => window.eyrie.frameNumber);

/** Turns the view by a key. */
async function turn(page) {
  await page.focus("#view");
  await page.keyboard.press("ArrowLeft");
}

/** The middle of the mark that the last click left. */
async function mark(page) {
  const { x, y, width, height } = await page.locator("#pick-mark").boundingBox();
  return [x + width / 2, y + height / 2];
}

/** Clicks and waits for what is there, in world metres. */
async function pick(page, x, y) {
  await page.mouse.click(x, y);
  await page.locator("#pick", { hasText: "x, y, z" }).waitFor();
  const text = await page.locator("#pick .numbers").innerText();
  return /x, y, z\s+(\S+), (\S+), (\S+)/.exec(text).slice(1).map(Number);
}

const apart = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));

const says = (page, text) =>
  page.waitForFunction(
    (wanted) => document.querySelector("#session-place")?.textContent === wanted,
    text,
    patience,
  );

await run("together", async (browser, started) => {
  const { page: first } = browser;
  const server = started(
    await ServerProcess.start(
      environment("EYRIE_FAKE_SERVER"),
      [environment("EYRIE_WEB_FOLDER")],
      60,
    ),
  );
  await first.goto(server.url);
  await exact(first);
  const before = JSON.parse(await camera(first)).eye;
  await first.click("#share-session");
  await says(first, "1 viewer · you lead");
  check(new URL(first.url()).searchParams.get("session") !== null, "sharing names the session");
  await exact(first);
  const seen = await camera(first);
  check(apart(JSON.parse(seen).eye, before) < 0.01, "who shares a view goes on seeing it");

  const link = new URL(first.url());
  link.searchParams.set("role", "watch");
  link.hash = "";
  const second = await browser.openAnother(link.href);
  await says(second, "2 viewers · you watch");
  await says(first, "2 viewers · you lead");
  check((await exact(second)) === (await exact(first)), "who watches gets the same picture");
  check((await camera(second)) === seen, "and the camera with it");

  let frames = [await frame(first), await frame(second)];
  await turn(first);
  const moved = await exact(first, frames[0]);
  check((await exact(second, frames[1])) === moved, "a movement is seen by both");
  const turned = await camera(first);
  check(turned !== seen && (await camera(second)) === turned, "from the same place");

  await first.locator("#tau").fill("2");
  await first.getByLabel("Wireframe").check();
  await first.locator("#exaggeration").fill("0.5");
  const isLed = () =>
    document.querySelector("#tau").value === "2" &&
    document.querySelector("#exaggeration").value === "0.5" &&
    document.querySelector("input[value=wireframe]").checked;
  await second.waitForFunction(isLed, undefined, patience);
  check(true, "the controls of who watches stand as the picture is");
  await exact(second);
  await second.waitForFunction(
    () => location.hash.includes("tau=4&") && location.hash.includes("shading=wireframe"),
    undefined,
    patience,
  );
  check(true, `and so does the address (${new URL(second.url()).hash})`);
  await second.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await second.getByRole("button", { name: "Copy as curl" }).click();
  await second.locator("#notice", { hasText: "curl command copied" }).waitFor();
  const curl = await second.evaluate(() => navigator.clipboard.readText());
  check(
    curl.includes('"tauPixels":4,') && curl.includes("SHADING_WIREFRAME"),
    "and the command that is copied",
  );
  const shown = await frame(second);
  await second.locator("input[value=flat]").click();
  await second.locator("#notice", { hasText: "take the lead to change" }).waitFor();
  await second.focus("#view");
  await second.keyboard.press("\\");
  check(await second.waitForFunction(isLed), "who watches is told that they do not change it");
  check((await frame(second)) === shown, "and gets no other picture");

  // In a window of another shape the picture's sides are beyond its edges.
  await second.setViewportSize({ width: 700, height: 754 });
  await second.keyboard.press("p"); // the panel would cover it
  const scale = 708 / 720; // under the bar; the picture is of 1280 x 720
  const [x, y] = [350 + scale * (480 - 640), 46 + scale * (420 - 46)];
  const found = [await pick(first, 480, 420), await pick(second, x, y)];
  check(
    apart(...found) < 0.4,
    `the same spot has the same coordinates in every window (${found.join("; ")})`,
  );
  const off = apart(await mark(second), [x, y]);
  check(off < 2, `and its mark where it was clicked (${off.toFixed(2)} px off)`);
  await second.keyboard.press("Escape");
  await second.keyboard.press("p");
  await first.keyboard.press("Escape");

  await turn(second);
  await second.waitForTimeout(300);
  check((await camera(second)) === turned, "who watches moves nothing");

  frames = [await frame(first), await frame(second)];
  await first.focus("#view");
  await first.keyboard.press("t");
  await first.waitForFunction(
    (before) => JSON.stringify(window.eyrie.camera) !== before,
    turned,
    patience,
  );
  await exact(first, frames[0]);
  await exact(second, frames[1]);
  frames = [await frame(first), await frame(second)];
  await second.click("#take-lead");
  await says(second, "2 viewers · you lead");
  await says(first, "2 viewers · you watch");
  check(await first.locator("#walk-mode").isHidden(), "who loses the lead walks no more");
  await exact(second, frames[1]); // now of a window of its own shape
  frames = [await frame(first), await frame(second)];
  await turn(second);
  const own = await exact(second, frames[1]);
  await first.waitForFunction(
    (hash) => window.eyrie.exact && window.eyrie.pixelHash === hash,
    own,
    patience,
  );
  check(true, "who takes the lead moves both");
  const last = await camera(second);
  const isLast = () =>
    first.waitForFunction((c) => JSON.stringify(window.eyrie.camera) === c, last, patience);
  await isLast();
  check(last !== turned, "on from where the other was");

  await second.close();
  await says(first, "1 viewer · you lead");
  await isLast();
  check(true, "who stays has the lead, and the view");
});
