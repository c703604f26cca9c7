// SPDX-License-Identifier: Apache-2.0
// What all charts are drawn with: numbers, scales, marks and words for a point.
const byId = (id) => document.getElementById(id);

/** What the program wrote, with null for an error without a bound, which is "Infinity" there. */
function readable(data) {
  return JSON.parse(JSON.stringify(data), (_, value) => (value === "Infinity" ? null : value));
}

/** Three digits, or all of a large number; "∞" for none. */
function number(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "∞";
  if (Math.abs(value) >= 1000) return Math.round(value).toLocaleString("en");
  return Number(value.toPrecision(digits)).toString();
}
const compact = (value) =>
  value >= 1e6 ? `${number(value / 1e6)} M` : value >= 1e4 ? `${number(value / 1e3)} k` : number(value);
const mebibytes = (bytes) => `${number(bytes / 2 ** 20)} MiB`;

/** Makes an element of the page. */
function html(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}

/** Makes an element of a drawing. */
function mark(name, attributes, text = "") {
  const node = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  if (text) node.textContent = text;
  return node;
}

/** A drawing of its own size that says to those who do not see it what it shows. */
function drawing(width, height, description) {
  return mark("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": description });
}

const path = (points) => points.map(([x, y], i) => `${i ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");
const curve = (points, colour, more = {}) =>
  mark("path", { d: path(points), fill: "none", stroke: colour, "stroke-width": 2.25, "stroke-linejoin": "round", ...more });

function linear([from, to], [low, high]) {
  return (value) => low + ((value - from) / (to - from || 1)) * (high - low);
}
function logarithmic([from, to], range) {
  const scale = linear([Math.log(from), Math.log(to)], range);
  return (value) => scale(Math.log(value));
}

/** Some four round numbers from 0 to the most. */
function ticks(most) {
  if (!(most > 0)) return [0];
  const power = 10 ** Math.floor(Math.log10(most / 4));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => most / s <= 6.5);
  return Array.from({ length: Math.floor(most / step) + 1 }, (_, i) => i * step);
}

/** Powers of `base` from one to the other. */
function powers(base, from, to) {
  const first = Math.ceil(Math.log(from) / Math.log(base) - 1e-9);
  const last = Math.floor(Math.log(to) / Math.log(base) + 1e-9);
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, i) => base ** (first + i));
}

/** Moves labels apart that would cover each other: by as little as `gap` needs, in order. */
function apart(labels, gap) {
  const sorted = [...labels].sort((a, b) => a.y - b.y);
  for (let i = 1; i < sorted.length; ++i) sorted[i].y = Math.max(sorted[i].y, sorted[i - 1].y + gap);
  return sorted;
}

const tip = html("div", { class: "tip", hidden: "" });
document.body.append(tip);

/** Words for a mark, shown where the pointer is or the focus; read out as its name. */
function explained(node, words) {
  node.setAttribute("tabindex", "0");
  node.setAttribute("role", "img");
  node.setAttribute("aria-label", words);
  const show = () => {
    const box = node.getBoundingClientRect();
    tip.textContent = words;
    tip.hidden = false;
    tip.style.left = `${Math.max(8, Math.min(box.right + 10, innerWidth - tip.offsetWidth - 8))}px`;
    tip.style.top = `${Math.max(8, box.top - tip.offsetHeight - 6)}px`;
  };
  const hide = () => { tip.hidden = true; };
  for (const [event, handler] of [["pointerenter", show], ["focus", show], ["pointerleave", hide], ["blur", hide]])
    node.addEventListener(event, handler);
  return node;
}

/** [["name", colour], ...] */
function legend(entries) {
  const list = html("ul", { class: "legend" });
  for (const [name, colour] of entries) list.append(html("li", {}, html("i", { style: `background:${colour}` }), name));
  return list;
}

/** Sets words with some of them **strong**. */
function say(node, words) {
  words.split("**").forEach((part, i) => node.append(i % 2 ? html("strong", {}, part) : part));
}

const seriesColours = ["var(--time)", "var(--series-1)", "var(--series-2)", "var(--series-3)"];
const processes = (run) =>
  run.renderers === 0 ? "one process" : run.renderers === 1 ? "1 renderer" : `${run.renderers} renderers, ${run.compound}`;
/** Runs by who drew them: [["one process", [run, ...]], ...]. */
function series(list) {
  const groups = new Map();
  for (const run of list) groups.set(processes(run), [...(groups.get(processes(run)) ?? []), run]);
  return [...groups];
}
