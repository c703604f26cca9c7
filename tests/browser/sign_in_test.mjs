// SPDX-License-Identifier: Apache-2.0
// The real program with tokens: who has none is asked for one, a wrong one is refused, and each
// role may do what it may. No token stays where others could find it.
import { randomBytes } from "node:crypto";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { check, environment, run, seriousFindings, ServerProcess } from "./support.mjs";

const patience = { timeout: 60_000, polling: 50 };
const tokens = Object.fromEntries(
  ["view", "control", "admin"].map((role) => [role, randomBytes(16).toString("hex")]),
);

const folder = mkdtempSync(join(tmpdir(), "eyrie-sign-in-"));
const tokenFile = join(folder, "tokens");
const letIn = (...roles) =>
  writeFileSync(tokenFile, roles.map((role) => `${role} ${tokens[role]}\n`).join(""), {
    mode: 0o600,
  });

const reason = (page) => page.textContent(".sign-in p");
const asks = (page) => page.waitForSelector(".sign-in input", { timeout: 15_000 });
const draws = (page) =>
  page.waitForFunction(() => window.eyrie?.frameNumber > 0, undefined, patience);
const camera = (page) => page.evaluate(() => JSON.stringify(window.eyrie.camera));
const says = (page, text) =>
  page.waitForFunction(
    (wanted) => document.querySelector("#session-place")?.textContent === wanted,
    text,
    patience,
  );

/** Types a token and waits for what comes of it. */
async function enter(page, token) {
  await page.fill(".sign-in input", token);
  await page.press(".sign-in input", "Enter");
}

/** What the server answers a script of the page. */
const status = (page, method, path, body) =>
  page.evaluate(
    async ([asked, url, text]) => {
      const headers = { "Content-Type": "application/json" };
      const options =
        text === undefined ? { method: asked } : { method: asked, headers, body: text };
      return (await fetch(url, options)).status;
    },
    [method, path, body],
  );

/** Everything that a script of the page, or who looks at the browser, may read. */
const readable = (page) =>
  page.evaluate(() =>
    JSON.stringify([
      window.location.href,
      document.cookie,
      { ...localStorage },
      { ...sessionStorage },
      window.history.state,
      document.documentElement.outerHTML,
      performance.getEntriesByType("resource").map(({ name }) => name),
    ]),
  );

async function checkKeptNowhere(page, token, whose) {
  const text = await readable(page);
  check(!text.includes(token), `no script can read the token of ${whose}`);
  const cookies = await page.context().cookies();
  check(
    cookies.length === 1 && cookies[0].httpOnly && cookies[0].sameSite === "Strict",
    "one cookie stands for it, which scripts and other sites do not get",
  );
  check(!cookies[0].value.includes(token), "and which does not tell it");
}

async function test(browser, started) {
  const { page } = browser;
  letIn("view", "control", "admin");
  const start = async (listen) => {
    const serve = ["serve", environment("EYRIE_SCENE"), "--listen", listen];
    return started(
      await ServerProcess.start(
        environment("EYRIE_BINARY"),
        [...serve, "--token-file", tokenFile],
        90,
      ),
    );
  };
  const server = await start("127.0.0.1:0");

  await page.goto(server.url);
  await asks(page);
  check((await reason(page)).includes("wants a token"), "who has no token is asked for one");
  const findings = await seriousFindings(page);
  check(findings.length === 0, `anybody can use the form ${findings.join("; ")}`);
  check(
    (await status(page, "GET", "api/v1/scene")) === 401 &&
      (await page.evaluate(() => window.eyrie)) === undefined,
    "and sees nothing before",
  );
  const tools = await page.$$eval(".tools button", (all) => all.map(({ disabled }) => disabled));
  const saysNothing = await page.locator("#status").isHidden();
  check(saysNothing && tools.every(Boolean), "nor anything to press that does nothing");
  await enter(page, " ");
  check((await reason(page)).includes("wants a token"), "nothing typed in is no token");

  const wrong = randomBytes(16).toString("hex");
  await enter(page, wrong);
  await page.waitForFunction(
    () => document.querySelector(".sign-in p")?.textContent.includes("does not know this token"),
    undefined,
    patience,
  );
  check(true, "a wrong token is said to be wrong");
  check((await page.context().cookies()).length === 0, "and gets no cookie");
  check(!(await readable(page)).includes(wrong), "and is kept nowhere");

  // A link that is opened in the same tab.
  await page.evaluate((token) => (window.location.hash = `token=${token}`), tokens.view);
  await draws(page);
  check((await page.$(".sign-in")) === null, "a right one lets in");
  check(await page.locator("#home").isEnabled(), "to all that there is");
  await checkKeptNowhere(page, tokens.view, "a viewer");
  check((await status(page, "GET", "api/v1/scene")) === 200, "who may look sees the scene");
  const scene = JSON.stringify({ objects: [] });
  check((await status(page, "PUT", "api/v1/scene", scene)) === 403, "and cannot change it");

  // A link with a token in it, to a session that the viewer is in.
  check(await page.isHidden("#share-session"), "who may only look begins no session to lead");
  const link = new URL("?session=review", server.url);
  await page.goto(link.href);
  await says(page, "1 viewer · nobody leads");
  await page.waitForFunction(
    () => document.querySelector("#message h2")?.textContent === "Nobody leads",
    undefined,
    patience,
  );
  check(await page.isHidden("#take-lead"), "nor is told to lead one");
  link.hash = `#token=${tokens.control}&tau=2`;
  const other = await browser.openAnother(link.href);
  await draws(other);
  const hash = await other.evaluate(() => window.location.hash);
  check(!hash.includes("token"), `the address gives the token up at once (${hash})`);
  await checkKeptNowhere(other, tokens.control, "who steers");
  check(await other.evaluate(() => document.referrer === ""), "nor does a referrer have it");
  await says(other, "2 viewers · you lead");
  await says(page, "2 viewers · you watch");
  check(
    (await status(other, "PATCH", "api/v1/configuration", "{}")) === 200,
    "who may steer, does",
  );
  check((await status(other, "POST", "api/v1/imports", "{}")) === 403, "and may not do more");

  const before = await camera(other);
  await other.focus("#view");
  await other.keyboard.press("ArrowLeft");
  await page.waitForFunction(
    (old) => JSON.stringify(window.eyrie.camera) !== old,
    before,
    patience,
  );
  await browser.until(() => window.eyrie.exact, 60_000);
  const moved = await camera(page);
  check(moved === (await camera(other)), "what is steered is seen by who looks");
  await page.focus("#view");
  await page.keyboard.press("ArrowLeft");
  await page.waitForFunction(
    () => document.querySelector("#notice")?.textContent.includes("You watch this session"),
    undefined,
    patience,
  );
  check((await camera(other)) === moved, "who may look moves nothing, and is told so");
  await says(other, "2 viewers · you lead");
  await other.close();

  await page.goto(server.url);
  await draws(page);
  check((await page.$(".sign-in")) === null, "the cookie lets in again");
  await page.evaluate(() => (window.isSamePage = true));
  letIn("control", "admin");
  await server.kill();
  const next = await start(new URL(server.url).host);
  await asks(page);
  check(
    await page.evaluate(() => window.isSamePage),
    "who is in and lost when the token is withdrawn is asked for another, and keeps the page",
  );
  await enter(page, tokens.control);
  await page.waitForFunction(
    () => document.querySelector(".sign-in") === null,
    undefined,
    patience,
  );
  await page.waitForFunction(() => document.querySelector("#banner").hidden, undefined, patience);
  check(await page.evaluate(() => window.isSamePage), "goes on there with that");
  letIn("admin");
  await page.reload();
  await asks(page);
  check((await reason(page)).includes("wants a token"), "until its token is withdrawn");

  check(
    [server, next].every(({ output }) =>
      Object.values(tokens).every((one) => !output.includes(one)),
    ),
    "the log has no token",
  );
  // Chromium itself logs each answer that is an error: these were wanted.
  const wanted = /status of 40[13] /;
  check(
    browser.errors.some((error) => wanted.test(error)),
    "refusals are seen in the console",
  );
  browser.errors = browser.errors.filter((error) => !wanted.test(error));
}

try {
  await run("sign_in_test", test);
} finally {
  rmSync(folder, { recursive: true });
}
