// SPDX-License-Identifier: Apache-2.0
// A reverse proxy that has a server below a path of its own, and nothing beside it.
import { createServer, request } from "node:http";
import { connect } from "node:net";

/**
 * Listens on a port of its own; `prefix` begins and ends with "/". `setsHost`: asks the server by its
 * own name, as proxies do that are not told to pass on the browser's.
 */
export async function prefixProxy(url, prefix, { setsHost = false } = {}) {
  const { hostname, port, host } = new URL(url);
  const headersOf = (asked) => (setsHost ? { ...asked.headers, host } : asked.headers);
  const pathOf = (asked) => asked.url.slice(prefix.length - 1);
  const proxy = createServer((asked, answer) => {
    if (!asked.url.startsWith(prefix)) return answer.writeHead(404).end();
    const { method } = asked;
    const headers = headersOf(asked);
    const passed = request({ hostname, port, method, path: pathOf(asked), headers }, (got) => {
      answer.writeHead(got.statusCode, got.headers);
      got.pipe(answer);
    });
    asked.pipe(passed);
  });
  proxy.on("upgrade", (asked, browser) => {
    if (!asked.url.startsWith(prefix)) return browser.destroy();
    const upstream = connect(Number(port), hostname);
    const headers = Object.entries(headersOf(asked)).map(([name, value]) => `${name}: ${value}`);
    upstream.write(`GET ${pathOf(asked)} HTTP/1.1\r\n${headers.join("\r\n")}\r\n\r\n`);
    for (const [from, to] of [
      [browser, upstream],
      [upstream, browser],
    ]) {
      from.pipe(to);
      from.on("error", () => to.destroy());
    }
  });
  await new Promise((resolve) => proxy.listen(0, hostname, resolve));
  proxy.unref(); // a program that ends is not kept by it
  return `http://${hostname}:${proxy.address().port}${prefix}`;
}
