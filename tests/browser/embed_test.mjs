// SPDX-License-Identifier: Apache-2.0
// The viewer in a page of one's own, as public/examples shows it, and its types.
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { fileURLToPath } from "node:url";
import { prefixProxy } from "./prefix_proxy.mjs";
import { check, colourCount, environment, run, ServerProcess } from "./support.mjs";

const web = environment("EYRIE_WEB_FOLDER");
const tsc = fileURLToPath(new URL("../../web/node_modules/typescript/bin/tsc", import.meta.url));

/** What the compiler finds wrong in a script that is checked against the types that are served. */
function typeErrors(script) {
  const options = "--noEmit --allowJs --checkJs --skipLibCheck --target es2022 --module esnext";
  const more = ["--moduleResolution", "bundler", "--lib", "es2022,dom,dom.iterable"];
  const result = spawnSync(process.execPath, [tsc, ...options.split(" "), ...more, script]);
  return result.stdout.toString();
}

await run("embed_test", async (browser, started) => {
  const { page } = browser;
  const server = started(await ServerProcess.start(environment("EYRIE_FAKE_SERVER"), [web], 20));
  await page.goto(new URL("examples/embed.html", server.url).href);
  await page.locator("output", { hasText: "Exact picture, off by" }).waitFor();
  const box = await page.locator("canvas").boundingBox();
  const shot = async () => {
    const png = await page.screenshot({ clip: box });
    return browser.eyes.evaluate(async (base64) => {
      const image = new Image();
      image.src = `data:image/png;base64,${base64}`;
      await image.decode();
      const context = new OffscreenCanvas(80, 45).getContext("2d");
      context.drawImage(image, 0, 0, 80, 45);
      return [...context.getImageData(0, 0, 80, 45).data];
    }, png.toString("base64"));
  };
  const home = await shot();
  check(
    colourCount(home) > 20,
    "a page with nothing but a canvas and a short script shows a scene",
  );
  check((await page.locator("canvas").count()) === 1, "and has no element but its own");

  // What it says while the view moves may be there for a moment only.
  await page.evaluate(() => {
    const output = document.querySelector("output");
    window.said = [];
    new MutationObserver(() => window.said.push(output.value)).observe(output, {
      childList: true,
      characterData: true,
      subtree: true,
    });
  });
  const exactAgain = async () => {
    await page.waitForFunction(
      () =>
        window.said.some((text) => text.startsWith("off by")) &&
        window.said.at(-1).startsWith("Exact picture"),
    );
    await page.evaluate(() => (window.said = []));
  };
  await page.mouse.move(box.x + 300, box.y + 200);
  await page.mouse.down();
  await page.mouse.move(box.x + 500, box.y + 240, { steps: 40 });
  await page.mouse.up();
  await exactAgain();
  check(JSON.stringify(await shot()) !== JSON.stringify(home), "dragging turns it");
  await page.getByRole("button", { name: "Whole scene" }).click();
  await exactAgain();
  check(
    JSON.stringify(await shot()) === JSON.stringify(home),
    "the page's own button moves it back",
  );

  const below = await prefixProxy(server.url, "/below/here/");
  await page.goto(below);
  await browser.settled();
  check(
    await page.locator("#panel").isVisible(),
    "the server's own page works below a path of a proxy",
  );
  await page.goto(new URL("examples/embed.html", below).href);
  await page.locator("output", { hasText: "Exact picture, off by" }).waitFor();
  check(true, "and so do those that embed the viewer");

  check(typeErrors(`${web}/examples/embed.js`) === "", "the example agrees with the types served");
  const folder = mkdtempSync(`${tmpdir()}/eyrie-embed-`);
  try {
    writeFileSync(
      `${folder}/wrong.js`,
      `import { State } from "${web}/embed/eyrie.js";\nnew State().numbers.watch((n) => n.tauAchievd);\n`,
    );
    check(
      typeErrors(`${folder}/wrong.js`).includes("tauAchievd"),
      "which find a word that is misspelt",
    );
  } finally {
    rmSync(folder, { recursive: true });
  }
});
