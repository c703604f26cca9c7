// SPDX-License-Identifier: Apache-2.0
// A flight against a server of made-up pictures: recorded by keys, edited, played, kept, saved,
// loaded again, and drawn picture by picture.
import { readFileSync } from "node:fs";
import { check, environment, run, ServerProcess } from "./support.mjs";

const web = environment("EYRIE_WEB_FOLDER");

const apart = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));

/** Whatever moved with the frame that is due has moved. */
const twoFrames = () =>
  new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));

/** The names and contents of a ZIP of stored files. */
function filesOf(zip) {
  const end = zip.length - 22;
  const files = new Map();
  let at = zip.readUInt32LE(end + 16);
  for (let i = 0; i < zip.readUInt16LE(end + 10); ++i) {
    const nameSize = zip.readUInt16LE(at + 28);
    const name = zip.toString("utf8", at + 46, at + 46 + nameSize);
    const start = zip.readUInt32LE(at + 42) + 30 + nameSize;
    files.set(name, zip.subarray(start, start + zip.readUInt32LE(at + 24)));
    at += 46 + nameSize;
  }
  return files;
}

await run("flight_test", async (browser, started) => {
  const { page } = browser;
  const server = started(await ServerProcess.start(environment("EYRIE_FAKE_SERVER"), [web], 20));
  await page.goto(server.url);
  await browser.settled();
  const notice = (text) => page.locator("#notice", { hasText: text }).waitFor();
  const canvas = page.locator("canvas#view");
  const camera = () => browser.hook("camera");
  const saved = async (name) => {
    const coming = page.waitForEvent("download", { timeout: 120_000 });
    await page.getByRole("button", { name, exact: true }).click();
    const download = await coming;
    return { name: download.suggestedFilename(), content: readFileSync(await download.path()) };
  };
  const savedFlight = async () => JSON.parse((await saved("Save flight")).content.toString());

  await page.keyboard.press("b");
  check(await page.locator("#recording").isVisible(), "B records, which the picture says");
  const start = await camera();
  for (let i = 0; i < 12; ++i) await page.keyboard.press("ArrowRight", { delay: 30 });
  await page.keyboard.press("w", { delay: 200 });
  // Flying takes one more step after its key.
  await page.evaluate(twoFrames);
  const end = await camera();
  await canvas.focus();
  await page.keyboard.press("b");
  await notice("of the distance at most");
  check(await page.locator("#recording").isHidden(), "and ends it, saying how well keys fit");

  await page.getByLabel("Name of the flight").fill("cub u");
  const recorded = await savedFlight();
  const last = recorded.keys.at(-1);
  check(
    recorded.name === "cub u" && recorded.keys.length > 1,
    "the flight is saved under its name",
  );
  check(
    recorded.keys[0].seconds === 0 || recorded.keys[0].seconds === undefined,
    "it starts where the view first moved",
  );
  check(
    apart(recorded.keys[0].camera.eye, start.eye) < 1e-9 && apart(last.camera.eye, end.eye) < 1e-9,
    "its ends are the views that it was recorded between",
  );

  await page.getByLabel("Name of the flight").press("Enter");
  await notice("Kept as cub u");
  await canvas.focus();
  const loads = ["Load flight", "cub u"].map((name) =>
    page.getByRole("button", { name, exact: true }),
  );
  const areDisabled = () => Promise.all(loads.map((load) => load.isDisabled()));
  await page.keyboard.press("b");
  check(
    (await areDisabled()).every(Boolean) &&
      (await loads[0].getAttribute("title")).includes("End the recording"),
    "no other flight takes the place of what is recorded",
  );
  await page.keyboard.press("b");
  await notice("Nothing moved");
  check(!(await areDisabled()).some(Boolean), "until that has ended");
  await page.keyboard.press("r");
  await page.keyboard.press("y");
  await page.waitForFunction(
    (z) => Math.hypot(...window.eyrie.camera.eye.map((v, i) => v - z[i])) < 1e-9,
    end.eye,
    { timeout: 60_000 },
  );
  check(true, "Y plays it to its end");

  await page.keyboard.press("y");
  await page.waitForTimeout(50);
  await page.keyboard.press("r");
  const home = JSON.stringify(await camera());
  await page.waitForTimeout(300);
  check(JSON.stringify(await camera()) === home, "a hand that steers takes over from the flight");

  await page.getByText(/^Keys \(\d+\)$/).click();
  await page.keyboard.press("3");
  await browser.settled();
  const east = await camera();
  const before = (await savedFlight()).keys.length;
  const focused = () => page.evaluate(() => document.activeElement.getAttribute("aria-label"));
  await page.getByLabel("Let key 2 show what is seen now", { exact: true }).press("Enter");
  check((await focused()) === "Let key 2 show what is seen now", "a key's button keeps the focus");
  await page.getByLabel("Seconds of key 1", { exact: true }).fill("-1.5");
  await page.getByLabel("Seconds of key 1", { exact: true }).press("Tab");
  check((await focused()) === "Show key 1", "and Tab goes on from the time that was typed in");
  let edited = await savedFlight();
  check(
    edited.keys[0].seconds === -1.5 && apart(edited.keys[1].camera.eye, east.eye) < 1e-9,
    "keys move in time and are replaced by what is seen",
  );
  await page.getByLabel("Seconds of key 1", { exact: true }).fill(String(edited.keys[1].seconds));
  await page.getByLabel("Seconds of key 1", { exact: true }).press("Enter");
  await notice("a time of its own");
  check((await savedFlight()).keys[0].seconds === -1.5, "two keys at one time are refused");
  await page.getByLabel("Remove key 1", { exact: true }).click();
  check((await savedFlight()).keys.length === before - 1, "a key is removed");
  await page.locator("#flight-time").press("End");
  await canvas.focus();
  await page.keyboard.press("1");
  await page.keyboard.press("n");
  edited = await savedFlight();
  check(
    edited.keys.length === before && edited.keys.at(-1).camera.eye[2] > 100,
    "N adds what is seen after the end",
  );

  const load = async (name, text) =>
    page.locator("#flight-file").setInputFiles({
      name,
      mimeType: "text/plain",
      buffer: Buffer.from(text),
    });
  await load("back.json", JSON.stringify(recorded));
  await notice("Loaded");
  check(
    JSON.stringify(await savedFlight()) === JSON.stringify(recorded),
    "a saved flight is the same when it is loaded again",
  );
  await load("broken.json", '{"keys":[{"secs":1}]}');
  await notice("broken.json is no flight");
  check(
    JSON.stringify(await savedFlight()) === JSON.stringify(recorded),
    "a file that is none is said to be none, and changes nothing",
  );
  await page.getByRole("button", { name: "cub u", exact: true }).click();
  await load("path.txt", "0 0 0\n1  0 0 -4  0 0 0\n3  0 0 -2  0 0 0\n");
  await notice("An eqPly path");
  const path = await savedFlight();
  check(
    path.name === "path" && apart(path.keys[0].camera.eye, [50, 50, 205]) < 1e-9,
    "a camera path of eqPly is loaded, the scene as its model",
  );

  await page.getByLabel("Pictures a second").fill("20");
  const zip = await saved("Save pictures");
  const files = filesOf(zip.content);
  check(
    zip.name === "path.zip" &&
      [...files.keys()].join() === "flight.json,00001.png,00002.png,00003.png",
    "the flight is saved, and every picture of it",
  );
  check(
    (await browser.pngHash(files.get("00003.png"))) === (await browser.hook("pixelHash")),
    "exact, bit for bit",
  );
  check(!files.get("00001.png").equals(files.get("00003.png")), "and the first is not the last");

  await page.goto("about:blank");
  await page.goto(server.url);
  await browser.settled();
  await page.locator("#flight summary").first().click();
  await page.getByRole("button", { name: "cub u", exact: true }).click();
  check((await savedFlight()).name === "cub u", "a kept flight outlasts the page");
  await page.getByRole("button", { name: "Remove cub u" }).click();
  await page.getByRole("button", { name: "cub u", exact: true }).waitFor({ state: "detached" });
  check(true, "and can be removed");
});
