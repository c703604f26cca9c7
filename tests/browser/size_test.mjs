// SPDX-License-Identifier: Apache-2.0
// How much a browser has to fetch before the page works, after gzip.
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { gzipSync } from "node:zlib";
import { check, environment } from "./support.mjs";

const web = environment("EYRIE_WEB_FOLDER");
const kilobytes = (files) =>
  files.reduce((sum, file) => sum + gzipSync(readFileSync(join(web, file))).length, 0) / 1000;
const assets = readdirSync(join(web, "assets")).map((name) => join("assets", name));
const page = kilobytes(["index.html", "icon.svg", ...assets]);
const viewer = kilobytes(["embed/eyrie.js", "embed/decode.worker.js"]);
check(page <= 150, `the page is at most 150 kB after gzip (${page.toFixed(1)})`);
check(viewer <= 60, `the viewer for other pages is at most 60 (${viewer.toFixed(1)})`);
