// SPDX-License-Identifier: Apache-2.0
// The page's tools against a server of made-up pictures: views kept and shared, things measured,
// plots, all by the keyboard; and what axe-core finds.
import { readFileSync } from "node:fs";
import { check, environment, run, seriousFindings, ServerProcess } from "./support.mjs";

const web = environment("EYRIE_WEB_FOLDER");
await run("tools_test", async (browser, started) => {
  const { page } = browser;
  const server = started(await ServerProcess.start(environment("EYRIE_FAKE_SERVER"), [web], 20));
  await page.goto(server.url);
  await browser.settled();
  const cameraNow = async () => JSON.stringify(await browser.hook("camera"));
  const home = await cameraNow();

  await page.keyboard.press("1");
  await browser.settled();
  const top = await browser.hook("camera");
  check(Math.abs(top.eye[0] - top.target[0]) < 2 && top.eye[2] > 100, "1 looks down from the top");
  await page.keyboard.press("2");
  check((await browser.hook("camera")).eye[1] < 0, "2 looks from the south");
  await page.getByRole("button", { name: "Isometric" }).click();
  await browser.settled();
  const isometric = await cameraNow();

  const link = await browser.link();
  check(link.includes("#eye="), "the address is a link to the view");
  await page.getByLabel("Name of the bookmark").fill("corner");
  await page.keyboard.press("Enter");
  await page.locator("#notice", { hasText: "Kept as corner" }).waitFor();
  await page.locator("canvas#view").focus();
  await page.keyboard.press("r");
  await browser.settled();
  check((await cameraNow()) === home, "R leaves it for the whole scene");
  await page.getByRole("button", { name: "corner", exact: true }).click();
  check((await cameraNow()) === isometric, "a bookmark shows the view again");
  await browser.settled();

  await page.goto("about:blank");
  await page.goto(link);
  await browser.settled();
  check((await cameraNow()) === isometric, "a link shows the view in a new page");
  check(
    await page.getByRole("button", { name: "corner", exact: true }).isVisible(),
    "bookmarks outlast the page",
  );
  const held = new URL(link);
  held.hash += "&tau=4&budget=20&shading=wireframe";
  await page.goto(held.href);
  await browser.settled();
  check(
    (await page.locator("#tau").inputValue()) === "2" &&
      (await page.getByLabel("Fixed frame time").isChecked()) &&
      (await page.locator("#budget").inputValue()) === "20" &&
      (await page.getByLabel("Wireframe").isChecked()),
    "the controls of quality stand as a link asks for",
  );
  await page.getByLabel("Fixed error").check();
  await page.getByLabel("Smooth").check();
  await browser.setTau(0);
  const takenBack = await browser.link();
  check(
    !/tau=4|budget|wireframe/.test(takenBack),
    `and take back what it asked for (${new URL(takenBack).hash})`,
  );
  await page.getByLabel("Name of the bookmark").press("Enter");
  await page.locator("#notice", { hasText: "has a name" }).waitFor();
  check((await page.locator(".bookmark").count()) === 1, "a bookmark without a name is none");
  await page.getByRole("button", { name: "Remove corner" }).click();
  check((await page.locator(".bookmark").count()) === 0, "and can be removed");
  await page.evaluate(() => (window.location.hash = "eye=1,2&at=3"));
  await page.locator("#notice", { hasText: "cannot be read" }).waitFor();
  check((await cameraNow()) === isometric, "a damaged link is said to be one and left out");

  const forbidden = await browser.chromium.newPage();
  forbidden.on("pageerror", (error) => browser.errors.push(String(error)));
  await forbidden.addInitScript(() => {
    const get = () => {
      throw new DOMException("Access is denied for this document.", "SecurityError");
    };
    Object.defineProperty(window, "localStorage", { get });
  });
  await forbidden.goto(`${server.url}?session=two words`);
  await forbidden.locator("#notice", { hasText: "names no session" }).waitFor();
  check(true, "an address that names no session is said to");
  await forbidden.waitForFunction(() => window.eyrie?.exact === true);
  await forbidden.getByLabel("Name of the bookmark").fill("corner");
  await forbidden.keyboard.press("Enter");
  await forbidden.locator("#notice", { hasText: "forbids it" }).waitFor();
  check(
    (await forbidden.locator("#equalizers").innerText()) !== "",
    "where the browser forbids to keep anything the page has all else",
  );
  await forbidden.close();
  await page.bringToFront();

  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await page.locator("canvas#view").focus();
  await page.keyboard.press("k");
  await page.locator("#notice", { hasText: "Command copied" }).waitFor();
  const command = await page.evaluate(() => navigator.clipboard.readText());
  check(
    command.includes("eyrie render SCENE --camera camera.json") &&
      command.includes(JSON.stringify(JSON.parse(isometric).eye)),
    "K copies the command that renders the view",
  );
  const savedHash = async () => {
    const saving = page.waitForEvent("download");
    await page.keyboard.press("o");
    return browser.pngHash(readFileSync(await (await saving).path()));
  };
  check(
    (await savedHash()) === (await browser.hook("pixelHash")),
    "O saves the server's picture bit for bit",
  );
  await page.keyboard.press("1");
  const hash = await savedHash();
  await browser.settled();
  check(hash === (await browser.hook("pixelHash")), "and just after a movement where that led to");

  await page.keyboard.press("m");
  check(await page.locator("#measure").isVisible(), "M measures");
  await page.keyboard.press("Space");
  await page.locator("#measure", { hasText: "One more point" }).waitFor();
  await page.mouse.click(640, 500);
  await page.locator("#measure", { hasText: "Length" }).waitFor();
  const text = await page.locator("#measure").innerText();
  check(/Length\s+\S+ m ± 50\d mm/.test(text), "a length has the errors of both its ends");
  await page.mouse.click(500, 450);
  await page.locator("#measure", { hasText: "Area" }).waitFor();
  check(
    ((await page.locator(".measure-dots").getAttribute("d")).match(/M/g) ?? []).length === 3,
    "three points are marked, and have an area",
  );
  await page.locator("canvas#view").focus();
  await page.keyboard.press("v");
  await page.locator("#measure .chart").waitFor();
  check(
    (await page.locator("#measure").innerText()).includes("within 255 mm of the source"),
    "V draws the heights along the last line, with their points' error",
  );
  await page.getByLabel("Place along the line").focus();
  await page.keyboard.press("ArrowRight");
  check(
    /along: -?0\.\d+ m/.test(await page.locator("#measure").innerText()),
    "and arrows read them",
  );

  await page.locator("canvas#view").focus();
  await page.keyboard.press("g");
  await page.keyboard.press("ArrowLeft");
  await page.locator("#plots .dot.last").first().waitFor();
  check(
    (await page.locator("#plots").innerText()).includes("Mbit/s"),
    "G plots time, error and bandwidth",
  );
  await browser.settled();

  const other = await browser.openAnother(server.url);
  await other.waitForFunction(() => window.eyrie?.exact === true);
  const mine = JSON.stringify(await other.evaluate(() => window.eyrie.camera));
  const frame = await other.evaluate(() => window.eyrie.frameNumber);
  await page.bringToFront();
  await browser.drag(40, 10);
  await browser.settled();
  const others = await other.evaluate(() => ({ ...window.eyrie }));
  check(
    JSON.stringify(others.camera) === mine && others.frameNumber === frame,
    "a second browser on the session keeps its view, and is sent nothing",
  );
  await other.close();

  await page.locator("#tau").focus();
  const beforeKeys = await cameraNow();
  await page.keyboard.press("ArrowRight");
  check((await cameraNow()) === beforeKeys, "arrows belong to the slider that has the focus");
  await page.keyboard.press("Escape"); // what was clicked
  const panel = page.locator("#panel");
  await panel.evaluate((element) => (element.scrollTop = 0));
  await panel.focus();
  for (const key of ["ArrowDown", "Space"]) {
    const scrolled = await panel.evaluate((element) => element.scrollTop);
    await page.keyboard.press(key);
    await page.waitForFunction((by) => document.querySelector("#panel").scrollTop > by, scrolled);
  }
  await page.keyboard.press("Home");
  await page.waitForFunction(() => document.querySelector("#panel").scrollTop === 0);
  check(
    (await cameraNow()) === beforeKeys && (await page.locator("#pick").isHidden()),
    "or scroll the panel while that has it, as Space and Home do,",
  );
  await page.keyboard.press("+");
  check((await cameraNow()) !== beforeKeys, "and plus to the view,");
  await page.keyboard.press("f");
  check(await page.locator("#mode").isVisible(), "as F does,");
  await page.getByLabel("Smooth").focus();
  await page.keyboard.press("f");
  check(await page.locator("#mode").isHidden(), "on a radio button, too;");
  const atTau = await page.locator("#tau").inputValue();
  await page.getByLabel("Name of the bookmark").focus();
  const beforeText = await cameraNow();
  await page.keyboard.type("wr");
  check((await cameraNow()) === beforeText, "but in a text letters are letters");
  await page.getByLabel("Name of the bookmark").fill("");
  check(atTau === "0.25", "and the slider has moved");

  await page.getByLabel("Edited").check();
  await page.locator("#flight summary").first().click();
  await page.keyboard.press("n");
  await page.getByText("Keys (1)").click();
  for (const colorScheme of ["dark", "light"]) {
    await page.emulateMedia({ colorScheme });
    for (const part of ["page", "help"]) {
      if (part === "help") await page.keyboard.press("h");
      const findings = await seriousFindings(page);
      check(
        findings.length === 0,
        `axe finds nothing serious (${colorScheme}, ${part}) ${findings.join("; ")}`,
      );
      if (part === "help") await page.keyboard.press("h");
    }
  }
  await page.keyboard.press("h");
  const states = () => page.locator(".help-now").allInnerTexts();
  const before = await states();
  check(
    before.includes("on") && before.includes("exact") && before.includes("off"),
    `the sheet of controls shows how they stand (${before.join(", ")})`,
  );
  await page.keyboard.press("c");
  const after = await states();
  check(
    after.some((text) => text.startsWith("every ")),
    `and follows the keys that are tried (${after.join(", ")})`,
  );
  await page.keyboard.press("c");
  await page.keyboard.down("c");
  await page.keyboard.down("c"); // as a key that is held
  await page.keyboard.up("c");
  check(
    (await states()).some((text) => text.startsWith("every ")),
    "a key that is held switches once",
  );
  await page.keyboard.press("c");
  await page.keyboard.press("Escape");
  await page.locator("canvas#view").focus();
  await page.keyboard.press("m");
  check(await page.locator("#measure").isHidden(), "M ends measuring");
  check(
    (await page.locator(".measure-dots").getAttribute("d")) === "",
    "and takes its points away",
  );
});
