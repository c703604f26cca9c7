// SPDX-License-Identifier: Apache-2.0
// What the browser tests share: a server process, a Chromium, and eyes for its pictures.
import { spawn } from "node:child_process";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";

const requireFromWeb = createRequire(
  fileURLToPath(new URL("../../web/package.json", import.meta.url)),
);

const axe = readFileSync(requireFromWeb.resolve("axe-core/axe.min.js"), "utf8");

/** What axe-core calls serious or worse. */
export async function seriousFindings(page) {
  await page.evaluate(axe); // as the debugger: the page's policy forbids it to others
  const { violations } = await page.evaluate(() => window.axe.run());
  return violations
    .filter(({ impact }) => impact === "serious" || impact === "critical")
    .map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html.slice(0, 120)).join(" ")}`);
}

const chromiumArguments = [
  "--headless=new",
  "--no-sandbox",
  "--disable-gpu",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
];

/** Beside the picture, while it is shown. */
export const panelWidth = 300;

export function check(condition, sentence) {
  if (!condition) throw new Error(sentence);
  console.log(`ok: ${sentence}`);
}

export function environment(name) {
  const value = process.env[name];
  if (!value) throw new Error(`set ${name} (CTest does)`);
  return value;
}

/** Starts a program that prints "Eyrie is at URL"; its group of processes ends with the test. */
export class ServerProcess {
  static async start(command, args, patienceSeconds) {
    const server = new ServerProcess(command, args);
    try {
      server.url = await server.#address(patienceSeconds);
    } catch (error) {
      server.kill();
      throw error;
    }
    return server;
  }

  constructor(command, args) {
    this.output = "";
    // A group of its own, so that the renderers it starts end with it.
    this.process = spawn(command, args, { detached: true, stdio: ["pipe", "pipe", "pipe"] });
    this.ended = new Promise((resolve) => {
      this.process.once("exit", resolve);
      this.process.once("error", resolve);
    });
    for (const stream of [this.process.stdout, this.process.stderr])
      stream.on("data", (data) => (this.output += data));
    this.process.stdin.on("error", () => {}); // it may have ended
  }

  say(line) {
    this.process.stdin.write(`${line}\n`);
  }

  kill() {
    try {
      process.kill(-this.process.pid, "SIGKILL");
    } catch {
      // It has ended already.
    }
    return this.ended;
  }

  async #address(patienceSeconds) {
    const deadline = Date.now() + patienceSeconds * 1000;
    let hasEnded = false;
    void this.ended.then(() => (hasEnded = true));
    while (Date.now() < deadline && !hasEnded) {
      const match = /Eyrie is at (http:\S+)/.exec(this.output);
      if (match) return match[1];
      await new Promise((resolve) => setTimeout(resolve, 20));
    }
    throw new Error(`the server printed no address; it said:\n${this.output}`);
  }
}

/** A page in a fresh Chromium, with a second one to look at screenshots. */
export class Browser {
  static async open({ chromium: furtherArguments = [] } = {}) {
    const { chromium } = requireFromWeb("playwright-core");
    const browser = new Browser();
    // Playwright gives each launch a fresh folder for the user's data.
    browser.chromium = await chromium.launch({
      executablePath: "/usr/bin/chromium",
      args: [...chromiumArguments, ...furtherArguments],
    });
    const viewport = { width: 1280 + panelWidth, height: 766 }; // 1280 x 720 under the bar
    browser.page = await browser.chromium.newPage({ viewport });
    browser.eyes = await browser.chromium.newPage();
    browser.page.on("pageerror", (error) => browser.errors.push(String(error)));
    browser.page.on("console", (message) => {
      // Chromium itself logs each refused connection while the server is gone, and each answer why.
      const isRefusal =
        /WebSocket connection to|net::ERR_CONNECTION_/.test(message.text()) ||
        /\/ws(\?|$)/.test(message.location().url);
      if (message.type() === "error" && !isRefusal) browser.errors.push(message.text());
    });
    return browser;
  }

  errors = [];

  close() {
    return this.chromium.close();
  }

  /** Another window at the same time, on such a device, whose errors count, too. */
  async openAnother(url, device = {}) {
    const page = await this.chromium.newPage(device);
    page.on("pageerror", (error) => this.errors.push(String(error)));
    await page.goto(url);
    return page;
  }

  /** A property of window.eyrie. */
  hook(name) {
    return this.page.evaluate((key) => window.eyrie?.[key], name);
  }

  /** Waits until `predicate`, which sees window.eyrie, holds in the page. */
  until(predicate, timeout = 60_000) {
    return this.page.waitForFunction(predicate, undefined, { timeout, polling: 10 });
  }

  /** Waits until the picture is neither being dimmed nor undimmed. */
  async eased() {
    await this.page.waitForTimeout(100);
    await this.until(() => document.querySelector("canvas").getAnimations().length === 0);
  }

  /** Waits until nothing more will be drawn. */
  async settled() {
    // What was set is sent with the next animation frame.
    await this.page.evaluate(() =>
      Promise.race([
        new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
        new Promise((done) => setTimeout(done, 2000)),
      ]),
    );
    for (;;) {
      await this.until(() => window.eyrie?.exact === true && !window.eyrie.waitingMilliseconds);
      await this.eased();
      // The picture before a change is at rest, too, until the page has sent it.
      const before = await this.page.evaluate(() => window.eyrie.frameNumber);
      await this.page.waitForTimeout(250);
      const after = await this.page.evaluate(
        () => window.eyrie.exact && !window.eyrie.waitingMilliseconds && window.eyrie.frameNumber,
      );
      if (after === before) return;
    }
  }

  /** The address once it is of what is seen: it changes once a second at most. */
  async link() {
    await this.settled();
    await this.page.waitForTimeout(1000);
    return this.page.url();
  }

  /** Every eighth pixel of the picture's middle as r, g, b, a one by one. */
  async picture() {
    const clip = { x: 200, y: 120, width: 700, height: 560 };
    const png = await this.page.screenshot({ clip });
    return this.eyes.evaluate(async (base64) => {
      const image = new Image();
      image.src = `data:image/png;base64,${base64}`;
      await image.decode();
      const [width, height] = [Math.floor(image.width / 8), Math.floor(image.height / 8)];
      const context = new OffscreenCanvas(width, height).getContext("2d");
      context.imageSmoothingEnabled = false;
      context.drawImage(image, 0, 0, width, height);
      return [...context.getImageData(0, 0, width, height).data];
    }, png.toString("base64"));
  }

  async drag(dx, dy, steps = 20) {
    const { mouse } = this.page;
    await mouse.move(500, 400);
    await mouse.down();
    for (let i = 1; i <= steps; ++i)
      await mouse.move(500 + (dx * i) / steps, 400 + (dy * i) / steps);
    await mouse.up();
  }

  /** The hash of what is on the canvas, as fabric/pixel_hash.h has it, made here anew. */
  canvasHash() {
    return this.page.evaluate(`(() => {
      ${hashOfPixels}
      return hashOfPixels(document.querySelector("#view"), window.eyrie);
    })()`);
  }

  /** The same of a PNG file. */
  pngHash(file) {
    return this.eyes.evaluate(`(async () => {
      ${hashOfPixels}
      const image = new Image();
      image.src = "data:image/png;base64,${file.toString("base64")}";
      await image.decode();
      return hashOfPixels(image, image);
    })()`);
  }

  /**
   * Milliseconds from an input at rest to each kind of picture of it: "drawn", "fine" and "exact".
   */
  timesToExact() {
    return this.page.evaluate(async () => {
      const times = {};
      const before = window.eyrie.frameNumber;
      const canvas = document.querySelector("#view");
      canvas.focus();
      const start = performance.now();
      canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", bubbles: true }));
      while (times.exact === undefined && performance.now() - start < 60_000) {
        await new Promise((resolve) => setTimeout(resolve, 2));
        if (window.eyrie.frameNumber === before) continue;
        const elapsed = performance.now() - start;
        times.drawn ??= elapsed;
        if (window.eyrie.still) times.fine ??= elapsed;
        if (window.eyrie.exact) times.exact = elapsed;
      }
      return times;
    });
  }

  /** Moves the tau slider to a power of two, as a hand would. */
  async setTau(log2) {
    await this.page.locator("#tau").fill(String(log2));
  }
}

/** Runs in a page. In whole numbers of any length, unlike what it is compared with. */
function hashOfPixels(source, { width, height }) {
  const copy = new OffscreenCanvas(width, height).getContext("2d", { alpha: false });
  copy.drawImage(source, 0, 0);
  const { data } = copy.getImageData(0, 0, width, height);
  let hash = 2166136261n;
  for (let i = 0; i < data.length; i += 4) {
    const word = BigInt(data[i] + 256 * data[i + 1] + 65536 * data[i + 2]);
    hash = ((hash ^ word) * 16777619n) & 0xffffffffn;
  }
  return Number(hash);
}

/** How many colours a picture has, coarsely. */
export function colourCount(picture) {
  const colours = new Set();
  for (let i = 0; i < picture.length; i += 4)
    colours.add(((picture[i] >> 4) << 8) | ((picture[i + 1] >> 4) << 4) | (picture[i + 2] >> 4));
  return colours.size;
}

/** The share of pixels that differ clearly. */
export function difference(a, b) {
  let different = 0;
  for (let i = 0; i < a.length; i += 4) {
    const worst = Math.max(...[0, 1, 2].map((c) => Math.abs(a[i + c] - b[i + c])));
    if (worst > 24) different += 1;
  }
  return different / (a.length / 4);
}

/** Mean brightness, 0 to 255. */
export function brightness(picture) {
  let sum = 0;
  for (let i = 0; i < picture.length; i += 4) sum += picture[i] + picture[i + 1] + picture[i + 2];
  return sum / ((picture.length / 4) * 3);
}

/**
 * Runs `test(browser, started)`; `started` keeps servers, to end them whatever happens. A failure
 * leaves a screenshot in EYRIE_TEST_OUTPUT. `options.chromium` are further arguments of Chromium.
 */
export async function run(name, test, options) {
  const servers = [];
  const browser = await Browser.open(options);
  const endAll = () => Promise.all(servers.map((server) => server.kill()));
  for (const signal of ["SIGINT", "SIGTERM"])
    process.once(signal, () => void endAll().then(() => process.exit(1)));
  try {
    await test(browser, (server) => {
      servers.push(server);
      return server;
    });
    check(
      browser.errors.length === 0,
      `no error on the page's console ${browser.errors.join("; ")}`,
    );
  } catch (error) {
    process.exitCode = 1;
    const path = `${process.env.EYRIE_TEST_OUTPUT ?? "."}/${name}-failure.png`;
    console.error(`FAILED: ${error instanceof Error ? error.message : error}`);
    await browser.page
      .screenshot({ path })
      .then(() => console.error(`screenshot: ${path}`))
      .catch(() => {});
    for (const server of servers) console.error(`server said:\n${server.output}`);
  } finally {
    await browser.close();
    await endAll();
  }
}
