// Computations for the map, without a browser: names that do not collide, grid steps in metres, copied layers.
import assert from "node:assert/strict";
import { test } from "node:test";
import { groupReports } from "../../firmware/doors/site/files/map_groups.js";
import { drawLayers } from "../../firmware/doors/site/files/map_layers.js";
import { Labels } from "../../firmware/doors/site/files/map_labels.js";
import { drawGridLabels, drawScaleBar, stepOf, gridLabelBoxes } from "../../firmware/doors/site/files/map_metres.js";
import { writeMarkers } from "../../firmware/doors/site/files/map_markers.js";
import { lastSeen } from "../../firmware/doors/site/files/map_robots.js";
import { filled } from "../../firmware/doors/site/files/map_tracks.js";
import { MapView } from "../../firmware/doors/site/files/map_view.js";

const SIZE = 12;

/** A canvas that only records texts: [left, top, right, bottom, text]. */
const paper = () => ({
  written: [],
  leaders: 0,
  under: 0,
  beginPath() {
    ++this.leaders;
  },
  moveTo() {},
  lineTo() {},
  stroke() {
    this.under += Number(this.globalCompositeOperation === "destination-over");
  },
  measureText: (text) => ({ width: text.length * SIZE * 0.6 }),
  strokeText() {},
  fillText(text, left, middle) {
    this.written.push([left, middle - SIZE * 0.5, left + text.length * SIZE * 0.6, middle + SIZE * 0.5, text]);
  },
});

/** Pseudorandom numbers from 0 to 1, the same each time. */
function dice(seed) {
  return () => (seed = (seed * 1103515245 + 12345) % 2147483648) / 2147483648;
}

const overlap = (a, b) => a[0] < b[2] && a[2] > b[0] && a[1] < b[3] && a[3] > b[1];

test("fits an area so that the scale and a sign stay free below it", () => {
  const area = { left: 0, right: 30, bottom: -10, top: 50 };
  for (const [width, height, room] of [[390, 200, 48], [1920, 1080, 48], [390, 500, 0]]) {
    const view = Object.assign(new MapView(), { width, height });
    view.fit(area, room);
    const [left, lowest] = view.toPixel({ x: 0, y: -10 }), [right, highest] = view.toPixel({ x: 30, y: 50 });
    assert.ok(lowest <= height - Math.max(room, height * 0.05) + 1e-6 && highest >= height * 0.05 - 1e-6 && left >= 0 && right <= width, `${width} x ${height}`);
    assert.ok(lowest - highest >= height * 0.9 - room - 1e-6, "and as large as there is room");
    assert.ok(view.holds(area));
  }
});

test("draws the tiles of a place as one image, and again if one of them changed", (t) => {
  const drawn = [], made = [];
  t.after(() => delete globalThis.document);
  globalThis.document = /** @type {any} */ ({
    documentElement: { dataset: { theme: "dark" } },
    createElement: () => ({ getContext: () => ({ drawImage: (image) => made.push(image.name) }) }),
  });
  const images = { r1: { name: "r1" }, r2: { name: "r2" } }, layers = ["r1", "r2"].map((robot) =>
    ({ kind: "grid", robot, tiles: new Map([["0/0/0", { level: 0, x: 0, y: 0 }]]) }));
  const tiles = { side: 256, metresPerPixel: [0.25], metresOf: () => 64, image: ({ robot }) => images[robot] };
  const view = Object.assign(new MapView(), { width: 400, height: 300, scale: 4 });
  const draw = (those = layers) => drawLayers({ drawImage: (image) => drawn.push(image) }, view, tiles, those, null, 1);
  draw();
  draw();
  assert.deepEqual(made, ["r1", "r2"]);
  assert.equal(drawn.length, 2);
  images.r2 = { name: "r2 later" };
  draw();
  assert.deepEqual(made.slice(2), ["r1", "r2 later"]);
  draw(layers.slice(1));
  assert.equal(drawn.at(-1), images.r2, "a single layer is drawn from its own image");
});

test("writes no name over another, over the edge or over signs", () => {
  const paint = paper(), roll = dice(7), drawn = [];
  const labels = new Labels(paint, {}, SIZE, { width: 800, height: 500, margin: [100, 100] });
  for (let i = 0; i < 12; ++i) {
    const place = [100 + roll() * 600, 100 + roll() * 300];
    labels.keepOff(place, 8);
    drawn.push([place[0] - 8, place[1] - 8, place[0] + 8, place[1] + 8]);
  }
  for (let i = 0; i < 300; ++i) labels.write(`name ${i}`, 100 + roll() * 600, 100 + roll() * 300);
  const { written } = paint;
  assert.ok(written.length > 30, `${written.length} of 300 found room`);
  written.forEach((one, i) => {
    for (const other of [...written.slice(i + 1), ...drawn]) assert.ok(!overlap(one, other), `${one} upon ${other}`);
    const isSeen = one[2] >= 100 && one[0] <= 700 && one[3] >= 100 && one[1] <= 400;
    assert.ok(!isSeen || (one[0] >= 100 && one[2] <= 700 && one[1] >= 99 && one[3] <= 401), `${one} is cut`);
  });
});

test("leaves a gap between two names in a row", () => {
  const paint = paper(), labels = new Labels(paint, {}, SIZE, { width: 4000, height: 500 });
  labels.write("r8", 400, 250);
  const [begin, , end] = paint.written[0];
  for (let left = end + 60; left > end; --left) {
    const one = new Labels(paper(), {}, SIZE, { width: 4000, height: 500 });
    one.write("r8", 400, 250);
    one.write("r10", left - SIZE, 250);
    const [, next] = one.ctx.written;
    assert.ok(next[1] !== 250 - SIZE / 2 || Math.max(next[0] - end, begin - next[2]) >= SIZE / 2, `${next} beside ${begin} to ${end}`);
  }
});

test("places the first name at the right, the next ones elsewhere, and the fifth not at all", () => {
  const paint = paper(), labels = new Labels(paint, {}, SIZE, { width: 800, height: 500 });
  const found = [..."abcde"].map((letter) => labels.write(letter.repeat(6), 400, 250));
  assert.deepEqual(found, [true, true, true, true, false]);
  assert.ok(paint.written[0][0] > 400 && paint.written[1][2] < 400);
});

test("writes the names of twenty silent robots in one place below and above each other, with lines to it", () => {
  const paint = paper(), labels = new Labels(paint, {}, SIZE, { width: 800, height: 500 });
  const found = Array.from({ length: 20 }, (_, i) => labels.write(`robot${i} · 2 min`, 400 + i / 4, 250, { rows: 6 }));
  assert.equal(found.filter(Boolean).length, 20);
  paint.written.forEach((one, i) => paint.written.slice(i + 1).forEach((other) => assert.ok(!overlap(one, other), `${one} upon ${other}`)));
  assert.ok(paint.leaders >= 10, `${paint.leaders} lines`);
  assert.equal(paint.under, 2 * paint.leaders, "line and rim lie under all names");
  assert.equal(paint.globalCompositeOperation, "source-over");
});

/** A view of so many pixels per metre. */
const viewOf = (scale) => Object.assign(new MapView(), { width: 800, height: 500, scale });
const textsAt = (scale, markers) => {
  const paint = paper();
  writeMarkers(new Labels(paint, {}, SIZE, { width: 800, height: 500 }), viewOf(scale), markers);
  return paint.written.map(([, , , , text]) => text);
};

test("writes a marker's text from where it is half as high as the page's letters, and a mesh's name near by", (t) => {
  t.after(() => delete globalThis.document);
  globalThis.document = /** @type {any} */ ({ documentElement: { dataset: { theme: "dark" } } });
  const at = (x, more) => ({ position: { x, y: 0, z: 0 }, color: { r: 1, g: 1, b: 1, a: 1 }, scale: { x: 1, y: 1, z: 1 }, text: "", mesh: "", ...more });
  const markers = [at(0, { type: 9, text: "small", scale: { x: 0, y: 0, z: 0.4 } }), at(5, { type: 9, text: "large", scale: { x: 0, y: 0, z: 4 } }),
    at(-5, { type: 10, mesh: "robot" })];
  assert.deepEqual(textsAt(1, markers), []);
  assert.deepEqual(textsAt(2, markers), ["large"]);
  assert.deepEqual(textsAt(16, markers), ["small", "large"]);
  assert.deepEqual(textsAt(20, markers), ["small", "large", "robot"]);
});

test("draws a line each 1, 2 or 5 metres, times a power of ten, far enough apart to be read", () => {
  for (let scale = 0.02; scale < 400; scale *= 1.3) {
    const step = stepOf(scale), apart = step * scale;
    assert.ok(apart >= 84 && apart <= 84 * 2.5 + 1e-9, `${step} m at ${scale}`);
    assert.match(step.toExponential(3), /^[125]\.000e/);
  }
});

test("writes no name over the scale and the figures at the edges", () => {
  for (const [width, height, scale] of [[374, 230, 3.3], [374, 184, 2.7], [1260, 720, 8], [2900, 1800, 31]]) {
    const view = Object.assign(new MapView(), { width, height, scale, centre: { x: 40, y: -3 } });
    const edges = paper();
    drawGridLabels(edges, {}, view, SIZE);
    drawScaleBar(edges, {}, view, SIZE);
    const boxes = [...gridLabelBoxes(view, SIZE)];
    assert.equal(boxes.length, edges.written.length);
    for (const [i, [left, top, right, bottom]] of boxes.entries()) assert.ok(overlap(boxes[i], edges.written[i]) && right - left < 400 && bottom - top < 2 * SIZE);
    const paint = paper(), labels = new Labels(paint, {}, SIZE, view), roll = dice(3);
    for (const box of boxes) labels.keepOffBox(box);
    for (let i = 0; i < 400; ++i) labels.write("#23 Fire Extinguisher", roll() * width, height - roll() * 80);
    assert.ok(paint.written.length);
    for (const one of paint.written) assert.ok(!boxes.some((box) => overlap(one, box)), `${one} upon an edge`);
  }
});

test("knows the area that an offscreen layer covers", () => {
  const view = Object.assign(new MapView(), { width: 800, height: 500, scale: 4 }), plate = view.widened(200, 125);
  assert.ok(plate.covers(view) && plate.isAround(view));
  view.pan(199, -124);
  assert.ok(plate.covers(view) && !plate.isAround(view));
  view.pan(10, 0);
  assert.ok(!plate.covers(view));
  const [left, top] = plate.toPixel(view.toMetres(0, 0));
  assert.ok(Math.abs(left - (200 - 209)) < 1e-6 && Math.abs(top - (125 + 124)) < 1e-6);
});

test("interpolates one pose per second on straight segments, and none while a robot stood or was silent", () => {
  const turned = 2 * Math.PI - 6;
  assert.deepEqual(filled([[100, 0, 0, 1, 3], [102, 2, 4, 1, -3]]), [[100, 0, 0, 1, 3], [101, 1, 2, 1, 3 + turned / 2], [102, 2, 4, 1, -3]]);
  for (const poses of [[[100, 0, 0, 0, 0]], [[100, 0, 0, 0, 0], [110, 0.05, 0, 0, 0]], [[100, 0, 0, 0, 0], [112, 9, 0, 0, 0]], [[100, 0, 0, 0, 0], [101, 1, 0, 0, 0]]]) {
    assert.deepEqual(filled(poses), poses);
  }
});

test("stands for three reports or more of one place with one sign, of their worst level, and for none that asks", () => {
  const report = (number, x, y, more = {}) => ({ number, position: { x, y, z: 0 }, state: "answered", score_change: 1, ...more });
  const crowd = [...Array(12).keys()].map((i) => report(i, 1 + i / 10, 1)).concat(report(12, 2, 2, { state: "rejected" }));
  const asking = report(13, 1, 1, { state: "held" }), named = report(14, 1, 1), two = [report(15, 11, 1), report(16, 11, 1)];
  const { singles, groups } = groupReports([...crowd, asking, named, ...two], 10, ({ number }) => number === 14);
  assert.deepEqual(singles.map(({ number }) => number), [16, 15, 14, 13]);
  assert.deepEqual(groups.map(({ count, level }) => [count, level]), [[13, "bad"]]);
  const many = Array.from({ length: 1000 }, (_, i) => report(i, (i * 7) % 100, (i * 13) % 60));
  const shown = (metres) => groupReports(many, metres, () => false), signs = (all) => all.singles.length + all.groups.length;
  assert.ok(signs(shown(10)) <= 60 && signs(shown(1)) > 60);
  assert.equal(shown(10).groups.reduce((sum, { count }) => sum + count, shown(10).singles.length), 1000);
});

test("says when a silent robot was last heard", () => {
  const silent = new Set(["ugv1"]);
  assert.equal(lastSeen({ name: "ugv1", age: 94 }, silent), "ugv1 · 1 min");
  assert.equal(lastSeen({ name: "ugv1", age: null }, silent), "ugv1 · silent", "the last pose is from before a start of the box");
  assert.equal(lastSeen({ name: "ugv2", age: 94 }, silent), "ugv2");
});
