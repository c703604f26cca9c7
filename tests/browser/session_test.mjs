// SPDX-License-Identifier: Apache-2.0
// What a program does to the session of a page, in the real program: it moves the camera, and the
// page goes on from there; it sends the page away, and the page stays away.
import { check, environment, run, ServerProcess } from "./support.mjs";

await run("session_test", async (browser, started) => {
  const { page } = browser;
  const serve = ["serve", environment("EYRIE_SCENE"), "--listen", "127.0.0.1:0"];
  const server = started(await ServerProcess.start(environment("EYRIE_BINARY"), serve, 90));
  const ask = async (method, body) => {
    const answer = await fetch(`${server.url}api/v1/sessions/tour`, {
      method,
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(body),
    });
    check(answer.ok, `${method} is answered`);
    return answer.json();
  };
  await page.goto(`${server.url}?session=tour`);
  await browser.until(() => window.eyrie?.frameNumber > 0, 60_000);
  await browser.settled();

  const before = await browser.hook("camera");
  const eye = before.eye.map((metres, i) => metres + 0.25 * (before.target[i] - metres));
  const moved = await ask("PATCH", { camera: { ...before, eye }, tauPixels: 3 });
  check(moved.viewers.length === 1 && moved.viewers[0].leads, "the page leads");
  await page.waitForFunction(
    (wanted) => Math.abs(window.eyrie.camera.eye[0] - wanted) < 1e-9,
    eye[0],
    { timeout: 30_000, polling: 50 },
  );
  await browser.settled();
  check((await browser.hook("viewSequence")) > 0, "the page has taken the view over");
  check(
    JSON.stringify((await browser.hook("camera")).eye) === JSON.stringify(eye),
    "and rests where it was taken",
  );

  const sequence = await browser.hook("viewSequence");
  await page.focus("#view");
  await page.keyboard.press("ArrowLeft");
  await browser.settled();
  check((await browser.hook("viewSequence")) > sequence, "its user moves on");
  const turned = (await browser.hook("camera")).eye;
  const far = Math.hypot(...turned.map((metres, i) => metres - eye[i]));
  const whole = Math.hypot(...before.target.map((metres, i) => metres - eye[i]));
  check(far > 0 && far < 0.5 * whole, "from there, and not from where it was");

  const watcher = await browser.openAnother(`${server.url}?session=tour&role=watch`);
  await watcher.waitForFunction(() => window.eyrie?.frameNumber > 0);
  const layout = await watcher.locator("#layout").inputValue();
  await watcher.locator("#layout").selectOption("Simple");
  await watcher.locator("#notice", { hasText: "take the lead to switch layouts" }).waitFor();
  check(
    (await watcher.locator("#layout").inputValue()) === layout &&
      (await watcher.locator("#banner").isHidden()),
    "who watches cannot switch layouts, is told so, and goes on seeing pictures",
  );
  await watcher.close();
  await page.bringToFront();

  await ask("DELETE");
  await browser.until(() => window.eyrie.connection === "closed", 30_000);
  await page.waitForTimeout(2000);
  check((await browser.hook("connection")) === "closed", "who was sent away stays away");
  check(
    (await page.locator("#banner").innerText()).includes("This session was closed"),
    "and is told so",
  );
  await page.reload();
  await browser.until(() => window.eyrie?.frameNumber > 0, 60_000);
});
