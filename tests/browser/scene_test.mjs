// SPDX-License-Identifier: Apache-2.0
// What the page changes of a scene and how it is drawn, in the real program: objects hidden, the sun
// moved, renderers told apart, equalizers tuned; and the same picture by curl, by Python and as a
// poster.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { check, difference, environment, run, seriousFindings, ServerProcess } from "./support.mjs";

await run("scene_test", async (browser, started) => {
  const { page } = browser;
  const serve = ["serve", environment("EYRIE_SCENE"), "--listen", "127.0.0.1:0"];
  const server = started(await ServerProcess.start(environment("EYRIE_BINARY"), serve, 90));
  const ask = async (path, body) => {
    const answer = await fetch(`${server.url}api/v1/${path}`, body);
    check(answer.ok, `${path} is answered`);
    return answer;
  };

  await page.goto(server.url);
  await browser.until(() => window.eyrie?.frameNumber > 0, 60_000);
  await browser.settled();
  const all = await browser.picture();
  const triangles = await browser.hook("triangles");

  const objects = page.locator("#objects .object > .object-label input");
  check((await objects.count()) === 2, "the tree has the scene's objects");
  check(
    /Terrain · .* triangles[^]*Mesh · .* triangles/.test(
      await page.locator("#objects").innerText(),
    ),
    "and says what they are",
  );
  await objects.nth(1).focus();
  await page.keyboard.press("Space");
  await browser.settled();
  const hidden = await browser.picture();
  check(difference(all, hidden) > 0.005, "the keyboard hides an object");
  check((await browser.hook("triangles")) < triangles, "whose triangles are not counted");
  const link = await browser.link();
  await page.goto("about:blank");
  await page.goto(link);
  await browser.settled();
  check(difference(hidden, await browser.picture()) === 0, "a link hides it, too");
  await page
    .getByRole("button", { name: /^Show .* alone/ })
    .nth(1)
    .click();
  await browser.settled();
  check(
    (await objects.nth(1).isChecked()) && !(await objects.nth(0).isChecked()),
    "an object can be shown alone",
  );
  const from = JSON.stringify(await browser.hook("camera"));
  await page
    .getByRole("button", { name: /^Bring / })
    .nth(1)
    .click();
  await browser.settled();
  check(JSON.stringify(await browser.hook("camera")) !== from, "and brought into view");
  await page.getByRole("button", { name: "Show all" }).click();
  await page.locator("canvas#view").focus();
  await page.keyboard.press("r");
  await browser.settled();
  check(difference(all, await browser.picture()) === 0, "all come back");

  await page.locator("#objects summary").nth(1).click();
  await page.getByRole("combobox", { name: /^Shading of / }).selectOption("Wireframe");
  await browser.settled();
  const wired = await browser.picture();
  check(difference(all, wired) > 0.0005, "an object has a shading of its own");
  await page.getByRole("checkbox", { name: "One colour" }).check();
  await browser.settled();
  check(difference(wired, await browser.picture()) > 0.0005, "and a colour");

  await page.keyboard.press("j");
  await browser.settled();
  const afternoon = await browser.picture();
  await page.locator("#sun-elevation").fill("5");
  await browser.settled();
  check(difference(afternoon, await browser.picture()) > 0.05, "a low sun is another light");

  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  const folder = mkdtempSync(join(tmpdir(), "eyrie-scene-test-"));
  try {
    const hash = await browser.hook("pixelHash");
    for (const [name, command] of [
      ["Copy as curl", ["bash", "-c"]],
      ["Copy as Python", ["python3", "-c"]],
    ]) {
      await page.getByRole("button", { name }).click();
      await page.locator("#notice", { hasText: "copied" }).waitFor();
      const text = await page.evaluate(() => navigator.clipboard.readText());
      const [program, option] = command;
      rmSync(join(folder, "view.png"), { force: true });
      execFileSync(program, [option, text], { cwd: folder, stdio: "inherit" });
      check(
        (await browser.pngHash(readFileSync(join(folder, "view.png")))) === hash,
        `${name}: the picture on the page, bit for bit`,
      );
      // The next one has a notice of its own.
      await page.evaluate(() => (document.querySelector("#notice").textContent = ""));
    }
  } finally {
    rmSync(folder, { recursive: true });
  }

  const ownLink = await browser.link();
  const own = await browser.picture();
  await page.goto("about:blank");
  await page.goto(ownLink);
  await browser.settled();
  check(difference(own, await browser.picture()) === 0, "a link has looks of objects, too");
  await page.locator("#objects summary").nth(1).click();
  await page.getByRole("combobox", { name: /^Shading of / }).selectOption("As all");
  await page.getByRole("checkbox", { name: "One colour" }).uncheck();
  await browser.settled();

  await page.locator("#poster-side").selectOption("4096");
  const told = page.locator("#notice", { hasText: "Poster saved; its error is at most" });
  const [download] = await Promise.all([
    page.waitForEvent("download", { timeout: 120_000 }),
    told.waitFor({ timeout: 120_000 }),
    page.locator("#poster").click(),
  ]);
  const poster = readFileSync(await download.path());
  check(poster.readUInt32BE(16) === 4096, "a poster is as wide as was asked for");
  const height = poster.readUInt32BE(20);
  const whole = await ask("image", {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({
      camera: await browser.hook("camera"),
      width: 4096,
      height,
      look: { sun: { azimuthDegrees: 315, elevationDegrees: 5 } },
    }),
  });
  check(
    (await browser.pngHash(poster)) ===
      (await browser.pngHash(Buffer.from(await whole.arrayBuffer()))),
    "and, drawn in bands, the picture drawn at once, bit for bit",
  );

  await page.locator(".renderer").nth(1).waitFor();
  check(/\d ms/.test(await page.locator(".renderer").first().innerText()), "each renderer's time");
  const plain = await browser.picture();
  await page.locator("#tint").click();
  check((await page.locator("#parts .part").count()) >= 2, "tints show who drew which part");
  await page.locator("#layout").selectOption("DB dynamic");
  await page.waitForFunction(() => document.querySelectorAll("#parts .part").length === 0);
  // The page asks for the tint once a picture says that it was cut by data.
  const isTinted = async () => {
    for (let i = 0; i < 60; ++i) {
      await browser.settled();
      if (difference(plain, await browser.picture()) > 0.05) return true;
      await page.waitForTimeout(200);
    }
    return false;
  };
  check(await isTinted(), "and who drew which data");
  await page.locator("#tint").click();
  await browser.settled();
  check(difference(plain, await browser.picture()) === 0, "and leave nothing behind");

  await page.getByText("Work sharing").click();
  await page.locator(".equalizer").first().waitFor();
  const configuration = async () => (await ask("configuration")).json();
  const tuned = async (key, value) => {
    for (let i = 0; i < 200; ++i) {
      const { state } = await configuration();
      if (JSON.stringify(state.equalizers[0][key]) === value) return true;
      await page.waitForTimeout(50);
    }
    return false;
  };
  await page.locator(".equalizer").first().getByLabel("Frozen").check();
  check(await tuned("frozen", "true"), "an equalizer is frozen");
  // What is read of it after a change comes while the next is typed in.
  const damping = page.locator(".equalizer").first().getByLabel("Damping");
  let read = () => {};
  const isTypedIn = new Promise((resolve) => (read = resolve));
  await page.route("**/api/v1/configuration", async (route) => {
    if (route.request().method() === "GET") await isTypedIn;
    await route.continue();
  });
  const isRead = page.waitForResponse(
    (response) =>
      response.url().endsWith("/configuration") && response.request().method() === "GET",
  );
  await damping.fill("0.25");
  await page.keyboard.press("Enter");
  check(await tuned("damping", "0.25"), "and tuned");
  await damping.fill("fast");
  read();
  await (await isRead).finished();
  await page.waitForTimeout(100);
  check((await damping.inputValue()) === "fast", "what is typed in stays");
  await page.keyboard.press("Enter");
  await page.locator("#equalizers", { hasText: "Damping: a number, not “fast”" }).waitFor();
  await damping.blur();
  await page.waitForFunction(
    () => document.querySelector(".equalizer .equalizer-number").value === "0.25",
  );
  check(true, "until it is left, refused");

  await page.locator("canvas#view").focus();
  await page.keyboard.press("x");
  await page.keyboard.press("m");
  await page.keyboard.press("Space");
  await page.locator("#measure", { hasText: "One more point" }).waitFor();
  const scene = await (await ask("scene")).json();
  await ask("scene", {
    method: "PUT",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ ...scene, objects: scene.objects.slice(0, 1) }),
  });
  await page.waitForFunction(() => document.querySelectorAll("#objects .object").length === 1);
  await browser.settled();
  check(
    (await page.locator("#pick").isHidden()) &&
      (await page.locator("#measure", { hasText: "Click two points" }).isVisible()) &&
      (await page.locator("#frozen").getAttribute("aria-pressed")) === "false",
    "another scene has none of the points and of the cut that were held in the one before",
  );

  for (const colorScheme of ["dark", "light"]) {
    await page.emulateMedia({ colorScheme });
    const findings = await seriousFindings(page);
    check(
      findings.length === 0,
      `axe finds nothing serious (${colorScheme}) ${findings.join("; ")}`,
    );
  }
});
