// SPDX-License-Identifier: Apache-2.0
// A link with a rate and a delay between a browser and a server, made of two sockets and a clock:
// what comes queues for the rate, as in a router with a quarter of a megabyte of memory, and then
// takes the delay.
import { connect, createServer } from "node:net";

const packetBytes = 1500;
const queueBytes = 256 * 1024;

class Direction {
  #queue = [];
  #queued = 0;
  #freeAt = 0;
  #timer;
  #isSilent = false;

  constructor(from, to, link, isLimited) {
    from.on("data", (data) => {
      if (this.#isSilent) return;
      for (let i = 0; i < data.length; i += packetBytes)
        this.#add(data.subarray(i, i + packetBytes), link, isLimited);
      if (this.#queued > queueBytes) from.pause();
    });
    this.#timer = setInterval(() => {
      const now = performance.now();
      while (this.#queue.length > 0 && this.#queue[0].at <= now) {
        const { bytes } = this.#queue.shift();
        this.#queued -= bytes.length;
        to.write(bytes);
      }
      if (this.#queued < queueBytes) from.resume();
    }, 1);
    from.on("close", () => {
      clearInterval(this.#timer);
      if (!this.#isSilent) to.destroy();
    });
    from.on("error", () => {});
  }

  /** Passes nothing on any more, not even the end. */
  fallSilent() {
    this.#isSilent = true;
    this.#queue = [];
  }

  #add(bytes, { megabits, delay }, isLimited) {
    const now = performance.now();
    const taken = isLimited ? (bytes.length * 8) / (megabits * 1000) : 0;
    this.#freeAt = Math.max(this.#freeAt, now) + taken;
    this.#queue.push({ at: this.#freeAt + delay, bytes });
    this.#queued += bytes.length;
  }
}

/**
 * Listens on a port of its own and passes everything on to `url`'s. `link.megabits`, towards the
 * browser, and `link.delay`, milliseconds each way, may be changed while it works. `fallSilent` has
 * the connections that there are die without being closed; new ones work.
 */
export async function slowLink(url, link) {
  const { hostname, port } = new URL(url);
  const directions = [];
  const server = createServer((browser) => {
    const upstream = connect(Number(port), hostname);
    browser.setNoDelay(true);
    upstream.setNoDelay(true);
    directions.push(new Direction(upstream, browser, link, true));
    directions.push(new Direction(browser, upstream, link, false));
  });
  await new Promise((resolve) => server.listen(0, hostname, resolve));
  server.unref(); // a program that ends is not kept by it
  const { port: own } = server.address();
  const fallSilent = () => directions.splice(0).forEach((direction) => direction.fallSilent());
  return { url: `http://${hostname}:${own}/`, fallSilent, close: () => server.close() };
}
