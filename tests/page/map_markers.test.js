// Every kind of marker on the map: drawn at its place, and only there.
import assert from "node:assert/strict";
import { test } from "node:test";
import { until } from "./box.js";
import { box, canvas } from "./pictures.js";
import { hears, settled, watch } from "./watch.js";

const INK = { r: 1, g: 0.2, b: 1, a: 1 }, PINK = [255, 51, 255], DIM_PINK = [102, 20, 102], BLUE = [0, 102, 255], BLUE_HEX = "#0066ffff";
const SIDE = [[0, 0], [20, 0]], ANGLE = [[0, 0], [20, 0], [20, 20]], PAIRS = [[0, 0], [20, 0], [0, 20], [20, 20]];

/** By name: the members of a marker at (0, 0), the places around it that are `inked` (BLUE if `blue`, at 40 % of the
 *  lightness if `dim`: lines), and those that are `blank`. */
const KINDS = {
  "an arrow by its pose": { type: 0, heading: Math.PI / 2, scale: [20, 4], inked: [[0, 5], [0, 15]], blank: [[10, 0], [0, -5]] },
  "an arrow by two points": { type: 0, points: [[0, 0], [0, 20]], scale: [1, 4], inked: [[0, 5], [0, 17]], blank: [[10, 10], [0, -5]] },
  "a cube": { type: 1, scale: [16, 8], inked: [[0, 0], [7, 3]], blank: [[0, 8], [11, 0]] },
  "a sphere": { type: 2, scale: [16, 8], inked: [[0, 0], [7, 0]], blank: [[7, 4], [11, 0]] },
  "a cylinder": { type: 3, heading: Math.PI / 2, scale: [16, 8], inked: [[0, 0], [0, 7]], blank: [[7, 0], [0, 11]] },
  "a strip of lines": { type: 4, points: ANGLE, scale: [1, 0], inked: [], dim: [[10, 0], [20, 10]], blank: [[10, 10], [10, 20]] },
  "a strip of one point": { type: 4, points: [[10, 10]], scale: [1, 0], inked: [[10, 10]], blank: [[0, 0], [20, 10]] },
  "a strip of one point of its own colour": { type: 4, points: [[10, 10]], scale: [1, 0], colors: [BLUE_HEX], inked: [], blue: [[10, 10]], blank: [[0, 0]] },
  "a list of lines": { type: 5, points: PAIRS, scale: [1, 0], inked: [], dim: [[10, 0], [10, 20]], blank: [[10, 10], [20, 10]] },
  "a list of cubes": { type: 6, points: SIDE, scale: [6, 6], inked: [[2, 2], [22, 2]], blank: [[10, 0]] },
  "a list of spheres": { type: 7, points: SIDE, scale: [6, 6], inked: [[0, 0], [20, 0]], blank: [[10, 0]] },
  "points of colours of their own": { type: 8, points: SIDE, scale: [6, 6], colors: [BLUE_HEX, "#ff33ffff"], inked: [[20, 0]], blue: [[0, 0]], blank: [[10, 0]] },
  "a mesh": { type: 10, mesh: "drill", scale: [1, 1], inked: [[0, 0]], blank: [[10, 10]] },
  "a list of triangles": { type: 11, points: ANGLE, scale: [1, 1], inked: [], dim: [[10, 0], [20, 10], [10, 10]], blank: [[15, 5]] },
};
const COLUMNS = 4, STEP = 34, LEFT = 0, TOP = 120;  // metres
const placeOf = (i) => ({ x: LEFT + (i % COLUMNS) * STEP, y: TOP - Math.floor(i / COLUMNS) * STEP });

function marker(id, { x, y }, { type, points = [], scale, heading = 0, colors = [], mesh = "", color = INK }) {
  return {
    ns: "kinds", id, type, position: { x, y, z: 0 }, heading, scale: { x: scale[0], y: scale[1], z: 0 }, color, colors, mesh,
    points: points.flatMap(([a, b]) => [x + a, y + b]), point_count: points.length, text: "", lifetime: 0, at: 0,
  };
}

/** The number and the centre of the pixels with one colour. */
const find = (page, colour, near) =>
  page.$eval(canvas, (node, [colour, near]) => {
    const [left, top, size] = near ? [near[0] - 2, near[1] - 2, 5] : [0, 0, 0];
    const width = size || node.width, { data } = node.getContext("2d").getImageData(left, top, width, size || node.height);
    let count = 0, x = 0, y = 0;
    for (let i = 0; i < data.length; i += 4) {
      if (data[i + 3] < 150 || colour.some((part, at) => Math.abs(part - data[i + at]) > 40)) continue;
      ++count;
      x += (i / 4) % width;
      y += Math.floor(i / 4 / width);
    }
    return { count, x: x / count, y: y / count };
  }, [colour, near]);

test("draws every kind of marker at its place, in its size and its colours", async (t) => {
  const kinds = Object.entries(KINDS);
  const signs = [[{ x: -10, y: 40 }, { r: 1, g: 0, b: 0, a: 1 }], [{ x: 130, y: 60 }, { r: 0, g: 1, b: 0, a: 1 }]];  // to find the map's scale
  const markers = kinds.map(([, kind], i) => marker(i, placeOf(i), kind))
    .concat(signs.map(([place, color], i) => marker(100 + i, place, { type: 1, scale: [5, 5], color })));
  const prepare = (page) => page.route("**/adit/markers*", (route) => route.fulfill({ json: { version: 1, whole: true, left_out: 0, markers, gone: [] } }));
  const { page } = await watch(t, "calm", { colorScheme: "dark", viewport: { width: 1920, height: 1080 }, prepare });
  await settled(page);
  for (const key of "-+") await page.locator(canvas).press(key);  // stops automatic fitting
  for (const name of ["Grids", "Clouds", "Robots", "Tracks", "Reports"]) await box(page, name).uncheck();
  await until(async () => (await find(page, [0, 255, 0])).count, "the markers");
  await settled(page);
  const [one, other] = [await find(page, [255, 0, 0]), await find(page, [0, 255, 0])];
  const scale = (other.x - one.x) / 140;
  const pixel = ([x, y]) => [Math.round(one.x + (x + 10) * scale), Math.round(one.y - (y - 40) * scale)];
  const wrong = [];
  for (const [i, [name, { inked, blue = [], dim = [], blank }]] of kinds.entries()) {
    const at = ([x, y]) => pixel([placeOf(i).x + x, placeOf(i).y + y]);
    for (const [places, colour, is] of [[inked, PINK, true], [blue, BLUE, true], [dim, DIM_PINK, true], ...[PINK, BLUE, DIM_PINK].map((each) => [blank, each, false])]) {
      for (const place of places) if (Boolean((await find(page, colour, at(place))).count) !== is) wrong.push(`${name} at ${place}: ${is ? "blank" : "inked"}`);
    }
  }
  assert.deepEqual(wrong, []);
});

test("draws the markers once per view, however often a robot moves", async (t) => {
  const prepare = (page) => page.addInitScript(() => {
    globalThis.drawn = { maps: 0, lines: 0 };
    const { clearRect, stroke } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.clearRect = function (...words) {
      ++globalThis.drawn.maps;
      return clearRect.apply(this, words);
    };
    CanvasRenderingContext2D.prototype.stroke = function (...words) {
      if (this.strokeStyle === "#661466") ++globalThis.drawn.lines;  // the markers' colour
      return stroke.apply(this, words);
    };
  });
  const { page } = await watch(t, "calm", { prepare });
  const drawn = () => page.evaluate(() => ({ ...globalThis.drawn }));
  await until(async () => (await drawn()).lines, "the markers");
  await page.locator(canvas).press("+");  // from here on a moving robot does not change the view
  await settled(page);
  const before = await until(async () => {  // at rest the layer is drawn at its final size
    const { lines } = await drawn();
    await hears(page, 2);
    const now = await drawn();
    return now.lines === lines && now;
  }, "the map to be at rest");
  await until(async () => (await drawn()).maps > before.maps + 2, "the robots to move");
  assert.equal((await drawn()).lines, before.lines);
  await page.locator(canvas).press("+");
  await until(async () => (await drawn()).lines > before.lines, "the markers, nearer");
});
