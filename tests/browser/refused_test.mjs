// SPDX-License-Identifier: Apache-2.0
// A server that answers and takes no connection: the page says why, what to do, and leaves it alone
// for as long as the server wants.
import { prefixProxy } from "./prefix_proxy.mjs";
import { check, environment, run, ServerProcess } from "./support.mjs";

/** Sessions that an address may begin, as CrowdLimits has it. */
const sessions = 8;

await run("refused_test", async (browser, started) => {
  const { page } = browser;
  const web = environment("EYRIE_WEB_FOLDER");
  const server = started(await ServerProcess.start(environment("EYRIE_FAKE_SERVER"), [web], 20));
  let attempts = 0;
  page.on("websocket", () => (attempts += 1));

  const other = await browser.openAnother(server.url);
  await other.waitForFunction(() => window.eyrie?.frameNumber > 0);
  const sockets = await other.evaluateHandle(async (number) => {
    const opened = Array.from({ length: number }, () => new WebSocket(new URL("ws", location)));
    await Promise.all(opened.map((one) => new Promise((resolve) => (one.onopen = resolve))));
    return opened;
  }, sessions - 1);
  await page.goto(server.url);
  const message = page.locator("#message", { hasText: "Too many sessions" });
  await message.waitFor();
  check(
    (await message.innerText()).includes("close another window of the page"),
    "who is one window too many is told so, and what to do",
  );
  check((await page.locator("#status").innerText()).includes("Refused"), "the chip says it, too");
  await page.screenshot({ path: `${environment("EYRIE_TEST_OUTPUT")}/refused_test.png` });
  attempts = 0;
  await page.waitForTimeout(6000);
  check(attempts <= 2, `the server is asked as often as it wants (${attempts} times in 6 s)`);
  await sockets.evaluate((opened) => opened.forEach((one) => one.close()));
  await browser.until(() => window.eyrie.frameNumber > 0);
  check(await message.isHidden(), "and the page comes in when another has left");
  await other.close();

  const proxy = await prefixProxy(server.url, "/", { setsHost: true });
  await page.goto(proxy);
  const stranger = page.locator("#message", { hasText: "may not connect to this server" });
  await stranger.waitFor();
  const text = await stranger.innerText();
  check(
    text.includes(new URL(proxy).origin) && text.includes(new URL(server.url).host),
    "behind a proxy that hides where the page is, both addresses are named",
  );
  check(text.includes("has to pass on the browser's Host"), "and the remedy");
});
