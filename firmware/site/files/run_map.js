// A run that is looked at again: its map and tracks at any of its times, from above.
import { say } from "./dom.js";
import { get } from "./session.js";

const NS = "http://www.w3.org/2000/svg";
const MOST_TILES = 150; // of one level
const COLOURS = ["var(--r1, #56b4e9)", "var(--r2, #e69f00)", "var(--r3, #009e73)", "var(--r4, #cc79a7)", "var(--r5, #f0e442)", "var(--r6, #d55e00)"];

const section = document.getElementById("look");
const svg = section.querySelector("svg"), slider = section.querySelector("input"), at = section.querySelector(".at");
let shown = null; // {base, map, tracks, level}

function drawn(what, attributes) {
  const node = document.createElementNS(NS, what);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  return node;
}

/** The finest level that has not too many tiles. */
function levelOf({ layers, metres_per_pixel: scales }) {
  const count = (level) => layers.reduce((sum, { tiles }) => sum + tiles.filter((tile) => tile.level === level).length, 0);
  return scales.findIndex((_, level) => count(level) <= MOST_TILES || level === scales.length - 1);
}

function boundsOf({ map, tracks }) {
  const xs = [], ys = [];
  for (const { bounds } of map.layers) if (bounds) xs.push(bounds.left, bounds.right), ys.push(bounds.bottom, bounds.top);
  for (const { poses } of tracks) for (const [, x, y] of poses) xs.push(x), ys.push(y);
  const least = (all) => all.reduce((a, b) => Math.min(a, b), Infinity), most = (all) => all.reduce((a, b) => Math.max(a, b), -Infinity);
  return xs.length ? { left: least(xs), right: most(xs), bottom: least(ys), top: most(ys) } : { left: -5, right: 5, bottom: -5, top: 5 };
}

function imageOf(layer, tile, time) {
  const side = shown.map.tile_side * shown.map.metres_per_pixel[tile.level];
  const path = `${shown.base}/map/${layer.kind}/${encodeURIComponent(layer.robot || "-")}/${tile.level}/${tile.x}/${tile.y}.png`;
  return drawn("image", { x: tile.x * side, y: -(tile.y + 1) * side, width: side, height: side, href: `${path}?at=${time}` });
}

function draw() {
  const time = Number(slider.value);
  const size = shown.size;
  const nodes = [];
  for (const kind of ["cloud", "grid"]) {
    for (const layer of shown.map.layers.filter((each) => each.kind === kind)) {
      for (const tile of layer.tiles) if (tile.level === shown.level && tile.first <= time) nodes.push(imageOf(layer, tile, time));
    }
  }
  shown.tracks.forEach(({ robot, poses }, i) => {
    const until = poses.filter(([when]) => when <= time);
    if (!until.length) return;
    const stroke = COLOURS[i % COLOURS.length], [, x, y] = until.at(-1);
    nodes.push(drawn("polyline", { points: until.map(([, px, py]) => `${px},${-py}`).join(" "), fill: "none", stroke, "stroke-width": size / 300 }));
    nodes.push(drawn("circle", { cx: x, cy: -y, r: size / 120, fill: stroke }));
    const name = drawn("text", { x: x + size / 80, y: -y - size / 80, "font-size": size / 35, fill: "currentColor" });
    name.textContent = robot;
    nodes.push(name);
  });
  svg.replaceChildren(...nodes);
  const text = new Date(time * 1000).toLocaleTimeString("en-GB");
  slider.setAttribute("aria-valuetext", text);
  say(at, text);
}

/** Shows the run whose paths begin with `base`; an Error's message is the sentence to show. */
export async function lookAgain(base, title) {
  const [map, { tracks }] = await Promise.all([get(`${base}/map`), get(`${base}/tracks`)]);
  const { left, right, bottom, top } = boundsOf({ map, tracks });
  const size = Math.max(right - left, top - bottom, 1), margin = size / 25;
  shown = { base, map, tracks, size, level: levelOf(map) };
  svg.setAttribute("viewBox", [left - margin, -top - margin, right - left + 2 * margin, top - bottom + 2 * margin].join(" "));
  const times = [...map.layers.flatMap(({ first, last }) => [first, last]), ...tracks.flatMap(({ poses }) => [poses[0][0], poses.at(-1)[0]])];
  slider.min = Math.floor(times.reduce((a, b) => Math.min(a, b), Infinity)) || 0;
  slider.max = Math.ceil(times.reduce((a, b) => Math.max(a, b), 0)) || 0;
  slider.value = slider.max;
  say(section.querySelector("h2"), title);
  section.hidden = false;
  draw();
  section.querySelector("h2").focus();
}

export function leave() {
  section.hidden = true;
  svg.replaceChildren();
}

let due = 0;
slider.addEventListener("input", () => {
  cancelAnimationFrame(due);
  due = requestAnimationFrame(draw);
});
section.querySelector(".leave").addEventListener("click", () => {
  leave();
  document.getElementById("runs-title").scrollIntoView();
});
