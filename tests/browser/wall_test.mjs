// SPDX-License-Identifier: Apache-2.0
// Two pages in one session, each a screen of a corner of two walls: they show the same pictures
// together, and points are picked through the walls.
import { slowLink } from "./slow_link.mjs";
import { check, environment, run, ServerProcess } from "./support.mjs";

const patience = { timeout: 60_000, polling: 20 };

const says = (page, text) =>
  page.waitForFunction(
    (wanted) => document.querySelector("#session-place")?.textContent === wanted,
    text,
    patience,
  );

const swaps = (page) => page.evaluate(() => window.eyrie.swaps.map((swap) => ({ ...swap })));

/** Waits until a picture behind the barrier has been drawn that is newer than `after`. */
async function swapped(page, after) {
  await page.waitForFunction(
    (before) => window.eyrie.swaps.some(({ swap, drawn }) => swap > before && drawn > 0),
    after,
    patience,
  );
}

const exact = (page) => page.waitForFunction(() => window.eyrie?.exact === true, null, patience);

/** Waits for the exact picture of the leader's canvas as it is now: without its panel it is wider. */
async function settled(leader, watcher) {
  await leader.waitForFunction(
    () => {
      const { width, height } = document.querySelector("#view").getBoundingClientRect();
      const picture = window.eyrie;
      return picture.exact && Math.abs(picture.width / picture.height - width / height) < 0.01;
    },
    null,
    patience,
  );
  const size = await leader.evaluate(() => [window.eyrie.width, window.eyrie.height]);
  await watcher.waitForFunction(
    ([width, height]) =>
      window.eyrie.exact && window.eyrie.width === width && window.eyrie.height === height,
    size,
    patience,
  );
}

// ---- The judge's own walls and rays: three corners of each, as fake_server.cpp has them.
const walls = {
  left: {
    lowerLeft: [-1.7, -0.6, -0.2],
    lowerRight: [0, -0.6, -1.2],
    upperLeft: [-1.7, 0.6, -0.2],
  },
  right: { lowerLeft: [0, -0.6, -1.2], lowerRight: [1.7, -0.6, -0.2], upperLeft: [0, 0.6, -1.2] },
};
const plus = (a, b, by = 1) => a.map((value, i) => value + by * b[i]);
const cross = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];
const unit = (v) => v.map((value) => value / Math.hypot(...v));

/** Where the line from an eye through a place of a wall meets the ground z = 0; NaN where nowhere. */
function groundThrough(camera, eyeX, wall, x, y) {
  const ahead = unit(plus(camera.target, camera.eye, -1));
  const right = unit(cross(ahead, camera.up));
  const up = cross(right, ahead);
  const inWorld = ([a, b, c]) => plus(plus(plus(camera.eye, right, a), up, b), ahead, -c);
  const across = plus(wall.lowerRight, wall.lowerLeft, -1);
  const rising = plus(wall.upperLeft, wall.lowerLeft, -1);
  const eye = inWorld([eyeX, 0, 0]);
  const onWall = inWorld(plus(plus(wall.lowerLeft, across, x), rising, y));
  const along = plus(onWall, eye, -1);
  const t = -eye[2] / along[2];
  return t > 0 ? plus(eye, along, t) : [NaN, NaN, NaN];
}

/** Two places of a wall through which the plain is seen, well within its borders. */
function placesOn(camera, eyeX, wall) {
  const places = [];
  for (let x = 0.05; x < 1; x += 0.05)
    for (let y = 0.05; y < 0.8; y += 0.05) {
      const [east, north] = groundThrough(camera, eyeX, wall, x, y);
      if (Math.min(east, north) > 5 && Math.max(east, north) < 95) places.push([x, y]);
    }
  if (places.length < 2) throw new Error("the plain is not in the picture");
  return [places[0], places.at(-1)];
}

/**
 * Clicks at a share of the picture, which covers the canvas, and compares the card with the judge, and
 * the mark with the click.
 */
async function pickAt(page, wall, eyeX, x, y) {
  const box = await page.locator("#view").boundingBox();
  const picture = await page.evaluate(() => ({ ...window.eyrie }));
  const scale = Math.max(box.width / picture.width, box.height / picture.height);
  const [left, top] = [
    box.x + box.width / 2 + (x - 0.5) * scale * picture.width,
    box.y + box.height / 2 + (0.5 - y) * scale * picture.height,
  ];
  await page.mouse.click(left, top);
  await page.locator("#pick", { hasText: "1234.56 m" }).waitFor(patience);
  const card = await page.locator("#pick").innerText();
  const numbers = /x, y, z\s+(\S+), (\S+), (\S+)/.exec(card);
  if (numbers === null) throw new Error(`the card has no place: ${card}`);
  const camera = await page.evaluate(() => window.eyrie.camera);
  const judged = groundThrough(camera, eyeX, wall, x, y);
  const off = [1, 2, 3].map((i) => Math.abs(Number(numbers[i]) - judged[i - 1]));
  const mark = await page.locator("#pick-mark").boundingBox();
  const beside =
    mark === null
      ? Infinity
      : Math.hypot(mark.x + mark.width / 2 - left, mark.y + mark.height / 2 - top);
  await page.keyboard.press("Escape");
  // A pixel of the canvas, and what the card rounds to.
  return {
    isRight: Math.max(...off) < 0.5 && beside < 2,
    text: `${Math.max(...off).toFixed(3)} m beside the judge's, and marked ${beside.toFixed(2)} px beside`,
  };
}

await run("wall", async (browser, started) => {
  const { page: left } = browser;
  const server = started(
    await ServerProcess.start(
      environment("EYRIE_FAKE_SERVER"),
      [environment("EYRIE_WEB_FOLDER")],
      60,
    ),
  );
  server.say("wall");
  // The second screen has everything later: who does not wait for it is found out.
  const link = await slowLink(server.url, { megabits: 40, delay: 60 });
  started({ kill: () => link.close() });
  const at = (url, query) => new URL(`/?session=corner&${query}`, url).href;
  await left.goto(at(server.url, "segment=left"));
  await says(left, "1 viewer · you lead");
  // As large as the first: pictures have the leader's size, and none of them is to be cropped.
  const right = await browser.openAnother(at(link.url, "role=watch&segment=right&eye=right"), {
    viewport: left.viewportSize(),
  });
  await says(left, "2 viewers · you lead · 2 screens together");
  await says(right, "2 viewers · you watch · 2 screens together");
  check(true, "both know that they are shown together");

  await left.focus("#view");
  for (let i = 0; i < 12; ++i) {
    const last = (await swaps(left)).at(-1)?.swap ?? 0;
    await left.keyboard.press(i % 2 === 0 ? "ArrowLeft" : "ArrowRight");
    await swapped(left, last);
  }
  await exact(left);
  await exact(right);
  const [ofLeft, ofRight] = [await swaps(left), await swaps(right)];
  const both = ofLeft.filter(({ swap }) => ofRight.some((other) => other.swap === swap));
  check(both.length >= 12, `${both.length} pictures were shown by both`);
  const others = new Map(ofRight.map((swap) => [swap.swap, swap]));
  // Clocks of two processes of one machine may differ by as much.
  const slack = 5;
  const isTogether = ({ swap, ready, drawn }) => {
    const other = others.get(swap);
    return drawn > other.ready - slack && other.drawn > ready - slack;
  };
  check(both.every(isTogether), "neither shows a picture before the other has it");
  const isInStep = ({ swap }, i) =>
    i === 0 || others.get(both[i - 1].swap).drawn < drawnOf(swap) + slack;
  const drawnOf = (swap) => ofLeft.find((each) => each.swap === swap).drawn;
  check(both.every(isInStep), "nor the next one before the other shows this one");
  check(
    ofLeft.every(({ swap }, i) => i === 0 || swap > ofLeft[i - 1].swap),
    "nor an older one after it",
  );
  const camera = (page) => page.evaluate(() => JSON.stringify(window.eyrie.camera));
  check((await camera(left)) === (await camera(right)), "both are of one camera");
  const hash = (page) => page.evaluate(() => window.eyrie.pixelHash);
  check((await hash(left)) !== (await hash(right)), "and each shows its own wall");

  for (const page of [left, right]) await page.click("#panel-toggle");
  await settled(left, right);
  for (const [x, y] of placesOn(JSON.parse(await camera(left)), 0, walls.left)) {
    const picked = await pickAt(left, walls.left, 0, x, y);
    check(picked.isRight, `what is clicked at is picked through the wall, ${picked.text}`);
  }
  const [[x, y]] = placesOn(JSON.parse(await camera(right)), 0.1, walls.right);
  const eyes = await pickAt(right, walls.right, 0.1, x, y);
  check(eyes.isRight, `and by the eye that sees it, ${eyes.text}`);

  const attic = await browser.openAnother(at(server.url, "role=watch&segment=attic"));
  await attic.waitForFunction(
    () => document.body.innerText.includes('No segment is called "attic"; there are "left"'),
    null,
    patience,
  );
  check(true, "an address of a screen that is not there says which there are");
  await attic.close();

  await right.close();
  await says(left, "1 viewer · you lead");
  const before = await left.evaluate(() => window.eyrie.frameNumber);
  await left.focus("#view");
  await left.keyboard.press("ArrowLeft");
  await left.waitForFunction((last) => window.eyrie.frameNumber > last, before, patience);
  check(true, "who is left alone goes on");
});
