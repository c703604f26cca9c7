// SPDX-License-Identifier: Apache-2.0
// Moving otherwise than by mouse: fingers, and feet on the ground. And what a browser is told that
// cannot show pictures.
import { check, environment, run, ServerProcess, panelWidth } from "./support.mjs";

const web = environment("EYRIE_WEB_FOLDER");

const apart = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));
const distance = ({ eye, target }) => apart(eye, target);
const azimuth = ({ eye, target }) => Math.atan2(eye[1] - target[1], eye[0] - target[0]);

const forward = ({ eye, target }) => target.map((value, i) => value - eye[i]);

/** Whatever moved with the frame that is due has moved. */
const twoFrames = () =>
  new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));

/** Fingers that go straight from their first places to their last ones, by real touch events. */
async function swipe(page, fingers, steps = 12) {
  const session = await page.context().newCDPSession(page);
  const points = (share) =>
    fingers.map(([from, to], id) => ({
      id,
      x: from[0] + (to[0] - from[0]) * share,
      y: from[1] + (to[1] - from[1]) * share,
    }));
  const touch = (type, touchPoints) =>
    session.send("Input.dispatchTouchEvent", { type, touchPoints });
  await touch("touchStart", points(0));
  for (let i = 1; i <= steps; ++i) await touch("touchMove", points(i / steps));
  await touch("touchEnd", []);
  await session.detach();
}

await run("move_test", async (browser, started) => {
  const { page } = browser;
  const server = started(await ServerProcess.start(environment("EYRIE_FAKE_SERVER"), [web], 20));
  await page.goto(server.url);
  await browser.settled();
  const camera = () => browser.hook("camera");
  const home = await camera();

  // ---- Fingers
  await swipe(page, [
    [
      [400, 400],
      [520, 400],
    ],
  ]);
  const orbited = await camera();
  check(
    apart(orbited.target, home.target) < 1e-9 &&
      Math.abs(distance(orbited) - distance(home)) < 1e-6,
    "one finger turns about the target",
  );
  check(azimuth(orbited) < azimuth(home) - 0.3, "and the scene follows it");

  await swipe(page, [
    [
      [400, 400],
      [480, 440],
    ],
    [
      [500, 400],
      [580, 440],
    ],
  ]);
  const panned = await camera();
  check(
    apart(panned.target, orbited.target) > 1 && Math.abs(azimuth(panned) - azimuth(orbited)) < 1e-6,
    "two fingers side by side pan",
  );
  check(Math.abs(distance(panned) - distance(orbited)) < 1e-6, "and nothing else");

  await swipe(page, [
    [
      [450, 400],
      [350, 400],
    ],
    [
      [550, 400],
      [650, 400],
    ],
  ]);
  const nearer = await camera();
  check(
    Math.abs(distance(nearer) / distance(panned) - 1 / 3) < 0.02,
    "fingers three times as far apart come three times as near",
  );

  const turn = Math.PI / 2;
  const at = (angle) => [500 + 100 * Math.cos(angle), 400 + 100 * Math.sin(angle)];
  for (let i = 0; i < 6; ++i) {
    const [from, to] = [(turn * i) / 6, (turn * (i + 1)) / 6];
    await swipe(page, [
      [at(from), at(to)],
      [at(from + Math.PI), at(to + Math.PI)],
    ]);
  }
  const turned = await camera();
  const by = ((azimuth(turned) - azimuth(nearer) + 3 * Math.PI) % (2 * Math.PI)) - Math.PI;
  check(Math.abs(by - turn) < 0.05, `fingers turned by 90° turn the scene (${by.toFixed(3)} rad)`);
  await browser.settled();

  const box = (selector) => page.locator(selector).boundingBox();
  const [beside, canvas] = [await box("#panel"), await box("#view")];
  check(
    canvas.width === 1280 && canvas.x + canvas.width <= beside.x && beside.width === panelWidth,
    "beside the panel the picture is as wide as what is left",
  );
  check(
    await page.evaluate(() => {
      document.querySelector("#plots").scrollIntoView();
      return document.documentElement.scrollTop + document.body.scrollTop === 0;
    }),
    "and nothing but the panel scrolls",
  );
  await page.keyboard.press("p");
  await browser.until(() => window.eyrie.width === 1580 && window.eyrie.exact);
  check((await box("#view")).width === 1280 + panelWidth, "without it, as the window");
  await page.keyboard.press("p");
  await browser.until(() => window.eyrie.width === 1280 && window.eyrie.exact);
  await page.setViewportSize({ width: 360, height: 640 });
  const help = await page.getByRole("button", { name: "Help" }).boundingBox();
  const chip = await page.locator("#status").boundingBox();
  const first = await page.getByRole("button", { name: "Home" }).boundingBox();
  check(
    help.x + help.width <= 360 && chip.x + chip.width <= first.x,
    "every button is on a telephone's screen, beside what says that all is well",
  );
  await browser.settled();
  const readout = page.locator("#readout");
  const line = await readout.boundingBox();
  check(await page.locator("#panel").isVisible(), "the panel is shown");
  const panel = await page.locator("#panel").boundingBox();
  check(
    line.x >= 0 && line.x + line.width <= 360 && line.y + line.height < panel.y,
    "speed and error are on a telephone's screen, beside the panel",
  );
  await page.keyboard.press("p");
  await readout.filter({ hasText: /^at rest · \d.* ms · 0\.90 px · exact$/ }).waitFor();
  check(await page.locator("#panel").isHidden(), "and without it");
  await page.keyboard.press("p");
  await page.setViewportSize({ width: 1280 + panelWidth, height: 766 });
  await browser.settled();

  // ---- Feet
  await page.keyboard.press("r");
  await browser.settled();
  await page.keyboard.press("t");
  await browser.until(() => Math.abs(window.eyrie.camera.eye[2] - 1.7) < 1e-6);
  check(await page.locator("#walk-mode").isVisible(), "T stands on the ground, at eye height");
  const stood = await camera();
  check(apart(stood.eye.slice(0, 2), home.target.slice(0, 2)) < 1e-6, "where the view looked at");
  await browser.settled();
  const shown = await camera();
  check(apart(shown.eye, stood.eye) < 1e-9, "nearer the ground than other views may come");
  const opened = await browser.openAnother(await browser.link());
  await opened.waitForFunction(() => window.eyrie?.exact && !window.eyrie.waitingMilliseconds);
  check(
    apart(await opened.evaluate(() => window.eyrie.camera.eye), stood.eye) < 1e-9,
    "which the address leads back to",
  );
  await opened.close();
  await page.bringToFront();

  // Steps come with the browser's frames.
  const walkSome = async () => {
    const { eye } = await camera();
    await page.keyboard.down("w");
    await page.waitForFunction(
      (from) => Math.hypot(...window.eyrie.camera.eye.map((v, i) => v - from[i])) > 0.3,
      eye,
    );
    await page.keyboard.up("w");
  };
  await walkSome();
  const walked = await camera();
  const way = apart(walked.eye, stood.eye);
  check(way > 0.3 && Math.abs(walked.eye[2] - 1.7) < 1e-6, `W walks (${way.toFixed(2)} m)`);
  await browser.drag(100, 0);
  const looked = await camera();
  check(
    apart(looked.eye, walked.eye) < 1e-9 && apart(looked.target, walked.target) > 0.1,
    "dragging looks around",
  );
  check(await page.locator("#walk-mode").isVisible(), "and the walk goes on");
  await page.keyboard.press("]");
  await browser.until(() => window.eyrie.camera.eye[2] > 100);
  await page.keyboard.press("\\");
  await browser.until(() => Math.abs(window.eyrie.camera.eye[2] - 1.7) < 1e-6);
  check(await page.locator("#walk-mode").isVisible(), "as it does on exaggerated heights");
  const height = looked.eye[2];
  await swipe(
    page,
    [
      [
        [400, 300],
        [400, 480],
      ],
      [
        [520, 300],
        [520, 480],
      ],
    ],
    40,
  );
  const drawn = await camera();
  const ahead = looked.target.map((value, i) => value - looked.eye[i]);
  const gone = drawn.eye.map((value, i) => value - looked.eye[i]);
  check(
    gone[0] * ahead[0] + gone[1] * ahead[1] > 1 && Math.abs(drawn.eye[2] - height) < 0.01,
    "two fingers draw the ground near, and walk",
  );
  await page.mouse.move(500, 400);
  await page.mouse.wheel(0, 240);
  await browser.until(() => window.eyrie.camera.eye[2] > 1.9);
  for (let i = 0; i < 12; ++i) await page.mouse.wheel(0, 240);
  await browser.until(() => window.eyrie.camera.eye[2] > 50);
  check(true, "the wheel makes a taller walker");
  await page.keyboard.down("Shift");
  await page.keyboard.down("w");
  await page.waitForTimeout(4000);
  await page.keyboard.up("w");
  await page.keyboard.up("Shift");
  const edge = await camera();
  check(
    edge.eye.slice(0, 2).every((value) => value >= 0 && value <= 100),
    `who runs on stays on the ground (${edge.eye.map((value) => value.toFixed(1)).join(", ")})`,
  );
  await page.keyboard.press("Escape");
  check(await page.locator("#walk-mode").isHidden(), "Escape ends the walk");
  // From wherever that run has come to, so that what is ahead is ground.
  await page.evaluate(() => (window.location.hash = "eye=20,20,30&at=50,50,0"));
  await browser.until(() => window.eyrie.camera.target[0] === 50);
  await browser.settled();
  await page.keyboard.press("t");
  await browser.until(() => Math.abs(window.eyrie.camera.eye[2] - 1.7) < 1e-6);
  await page.keyboard.press("b");
  await walkSome();
  await page.evaluate(twoFrames);
  const recorded = await camera();
  await page.keyboard.press("b");
  await page.locator("#notice", { hasText: "of the distance at most" }).waitFor();
  await browser.settled();
  await page.keyboard.press("Escape");
  check(
    Math.abs((await camera()).eye[2] - 2) < 1e-6,
    "where a walk ends no picture is needed to know how high the eye is then",
  );
  const left = await camera();
  check(
    apart(forward(left), forward(recorded)) < 1e-9,
    "where it ends the eye is lifted as high as other views are, and looks on the same way",
  );
  await page.keyboard.press("y");
  await page.getByRole("button", { name: "Play", exact: true }).waitFor({ state: "attached" });
  await browser.settled();
  check(apart((await camera()).eye, recorded.eye) < 1e-9, "a recorded walk plays on the ground");
  await page.keyboard.press("ArrowRight");
  await browser.settled();
  check(
    Math.abs((await camera()).eye[2] - recorded.eye[2]) < 1e-6,
    "where a hand steers on from it, without a jump",
  );
  await page.keyboard.press("t");
  await browser.until(() => Math.abs(window.eyrie.camera.eye[2] - 1.7) < 1e-6);
  await page.keyboard.press("2");
  check(await page.locator("#walk-mode").isHidden(), "so does another view");
  await page.evaluate(() => (window.location.hash = "eye=500,0,100&at=900,0,0"));
  await browser.until(() => window.eyrie.camera.target[0] === 900);
  await browser.settled();
  await page.keyboard.press("t");
  await page.locator("#notice", { hasText: "no ground to stand on" }).waitFor();
  check(await page.locator("#walk-mode").isHidden(), "nobody stands where there is no ground");

  // ---- Browsers that cannot show pictures
  const scriptless = await browser.chromium.newPage({ javaScriptEnabled: false });
  await scriptless.goto(server.url);
  check(
    (await scriptless.locator("#message").innerText()).includes("Firefox 114"),
    "a browser that runs no scripts, or cannot read these, is told so by the page itself",
  );
  await scriptless.close();

  const another = await browser.chromium.newPage();
  await another.route("**/decode.worker*.js", (route) =>
    route.fulfill({ contentType: "text/javascript", body: "export {}; no module" }),
  );
  await another.goto(server.url);
  await another.locator("#message", { hasText: "worker did not start" }).waitFor();
  check(true, "one that cannot start the worker is told that");
  await another.close();

  await page.addInitScript(() => delete window.OffscreenCanvas);
  await page.goto("about:blank");
  await page.goto(server.url);
  await page.locator("#message", { hasText: "This browser is too old" }).waitFor();
  check(
    (await page.locator("#message").innerText()).includes("Firefox 114"),
    "a browser that cannot show pictures is told why, and which can",
  );
});
