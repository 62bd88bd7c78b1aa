// Zoomed in, the map shows the cells that were forwarded, with the real programs.
import assert from "node:assert/strict";
import { test } from "node:test";
import { drawLayers } from "../../firmware/doors/site/files/map_layers.js";
import { box as boxAtWork, TOKENS, until } from "./box.js";
import { box, canvas } from "./pictures.js";
import { countAwaited } from "./stage.js";
import { settled, visitor } from "./watch.js";

const SIDE = 400, CELL = 0.05;  // cells, metres
const BY_TOKEN = { colorScheme: "dark", extraHTTPHeaders: { Authorization: `Bearer ${TOKENS.team}` } };

/** A square of 20 m around the origin, free except for a wall one cell thick along its middle, `up` cells above it. */
function grid(up) {
  const cells = Buffer.alloc(SIDE * SIDE);
  cells.fill(100, (SIDE / 2 + up) * SIDE, (SIDE / 2 + up + 1) * SIDE);
  const origin = { position: { x: -10, y: -10, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
  const info = { resolution: CELL, width: SIDE, height: SIDE, origin };
  return { type: "OccupancyGrid", name: "ugv1", msg: { header: { stamp: Date.now() / 1000, frame_id: "darpa" }, info, data: cells.toString("base64") } };
}

/** The distance of the wall above the map's middle and its thickness, in pixels: {up, thick}; null without a wall. */
const wall = (page) =>
  page.$eval(canvas, (node) => {
    const column = Math.round(node.width / 3), { data } = node.getContext("2d").getImageData(column, 0, 1, node.height);
    const isWall = (y) => Math.abs(data[y * 4] - 0x6b) + Math.abs(data[y * 4 + 1] - 0x78) + Math.abs(data[y * 4 + 2] - 0x80) < 40;
    const rows = Array.from({ length: node.height }, (_, y) => y).filter(isWall);
    return rows.length ? { up: node.height / 2 - rows.at(-1) - 1, thick: rows.at(-1) - rows[0] + 1 } : null;
  });

async function post(at, up) {
  const before = (await (await at.ask("GET", "/adit/map")).json()).version;
  const answer = await at.ask("POST", "/map/update", { body: grid(up) });
  assert.ok(answer.ok, await answer.text());
  await until(async () => (await (await at.ask("GET", "/adit/map")).json()).version > before, "the map to be drawn");
}

test("zoomed in, shows the cells that were forwarded, and follows changes", async (t) => {
  const at = await boxAtWork(t);
  await post(at, 1);
  const page = await visitor(t, `${at.url}/`, BY_TOKEN, (page) => page.addInitScript(countAwaited));
  await page.waitForSelector("body[data-link=live]");
  await settled(page);
  for (const name of ["Robots", "Tracks", "Reports"]) await box(page, name).uncheck();
  const finer = () => page.requests.filter((url) => url.includes("/grid/ugv1/-1/")).length;
  const near = async () => {
    const { x, y, width, height } = await page.locator(canvas).boundingBox();
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.wheel(0, -240);
  };
  await until(async () => (await wall(page)) !== null, "the wall");
  const coarse = await wall(page);
  if (finer() === 0) assert.ok(coarse.thick <= 6, `a base pixel: ${coarse.thick}`);
  // One wheel step at a time. The scale follows from the wall's height above the middle; its lower edge is 5 cm above y = 0.
  await until(async () => {
    await near();
    await settled(page);
    const { thick, up } = (await wall(page)) ?? {};
    return finer() > 0 && up >= 8 && Math.abs(thick - up) <= 2;
  }, "a wall as thick as a cell, a cell above the middle");
  const { up } = await wall(page);

  await post(at, 2);  // within the same pixel of the base map; only finer tiles show it
  await until(async () => Math.abs(((await wall(page))?.up ?? 0) - 2 * up) <= 3, "the wall where it is now");
  assert.ok(Math.abs((await wall(page)).thick - up) <= 2, "the wall's thickness changed");

  const slider = page.getByRole("slider");
  await until(async () => {
    await slider.press("Shift+ArrowLeft");  // one second
    await settled(page);
    return ((await wall(page))?.thick ?? 0) >= 4 * up;
  }, "earlier it is as coarse as it is kept");
  assert.deepEqual(page.complaints.filter((text) => !text.includes("getImageData")), []);
});

test("loads no finer tile that would look the same, and reloads a tile only if it changed", async (t) => {
  const at = await boxAtWork(t);
  await post(at, 1);
  const page = await visitor(t, `${at.url}/`, BY_TOKEN, (page) => page.addInitScript(countAwaited));
  const finer = () => page.requests.filter((url) => /\/grid\/ugv1\/-\d/.test(url));
  await page.waitForSelector("body[data-link=live]");
  const zoomOut = page.getByRole("button", { name: "Zoom out" });
  for (let i = 0; i < 6; ++i) await zoomOut.click();
  await settled(page);
  page.requests.length = 0;
  await post(at, 2);
  await until(() => page.requests.some((url) => url.includes("/adit/map?since=")), "what changed");
  await settled(page);
  assert.deepEqual(finer(), []);
  for (let i = 0; i < 12; ++i) await page.getByRole("button", { name: "Zoom in" }).click();
  await until(() => finer().length > 0, "finer tiles");
  await settled(page);
  const count = finer().length;
  assert.equal(new Set(finer()).size, count, "each once");
  const answer = await at.ask("POST", "/map/update", { body: grid(2) });
  assert.ok(answer.ok);
  await until(async () => (await (await at.ask("GET", "/adit/run")).json()).activities.some(({ kind, forwarded }) => kind === "grid" && forwarded >= 3), "it to be forwarded");
  await settled(page);
  assert.equal(finer().length, count, "an unchanged grid causes no request");
});

test("loads no finer tile outside the view, even if a larger coarse tile is there", () => {
  const asked = [], metres = { "-1": 12.8, 0: 64, 1: 256 };
  const tiles = { side: 256, metresPerPixel: [0.25, 1], metresOf: (level) => metres[level], image: () => null, finerImage: (layer, place) => void asked.push(place) };
  const layer = { kind: "grid", robot: "ugv1", finer: { level: -1 }, tiles: new Map([["0/0/0", { level: 0, x: 0, y: 0 }]]) };
  const view = { scale: 40, bounds: () => ({ left: 2, bottom: 2, right: 22, top: 12 }) };
  drawLayers({}, view, tiles, [layer], null, 1, { left: 0, bottom: 0, right: 64, top: 64 });
  assert.deepEqual(asked, ["-1/0/0", "-1/1/0"]);
});

test("serves the cells of a 5 cm grid unchanged", async (t) => {
  const at = await boxAtWork(t);
  await post(at, 1);
  const map = await (await at.ask("GET", "/adit/map")).json();
  assert.deepEqual(map.finer_metres_per_pixel, [0.05, 0.01]);
  assert.equal(map.layers[0].finer.level, -1);
  assert.deepEqual(map.layers[0].finer.area, { left: -10, bottom: -10, right: 10, top: 10 });
  const tile = await at.ask("GET", "/adit/map/grid/ugv1/-1/0/0.png?from=000000&to=ffffff");
  assert.equal(tile.status, 200);
  const page = await visitor(t, `${at.url}/login`, BY_TOKEN);
  const column = await page.evaluate(async (path) => {
    const image = await createImageBitmap(await (await fetch(path)).blob()), paint = new OffscreenCanvas(256, 256).getContext("2d");
    paint.drawImage(image, 0, 0);
    return Array.from({ length: 256 }, (_, y) => paint.getImageData(10, 255 - y, 1, 1).data).map(([red, , , alpha]) => (alpha ? red : -1));
  }, "/adit/map/grid/ugv1/-1/0/0.png?from=000000&to=ffffff");
  assert.deepEqual(column, Array.from({ length: 256 }, (_, y) => (y >= SIDE / 2 ? -1 : y === 1 ? 255 : 0)));
  assert.equal((await at.ask("GET", "/adit/map/grid/ugv1/-1/0/0.png?from=000000&to=ffffff", { headers: { "If-None-Match": tile.headers.get("ETag") } })).status, 304);
  assert.equal((await at.ask("GET", "/adit/map/grid/ugv1/-1/0/0.png?at=1")).status, 400);
  for (const [place, status] of [["-1/1/0", 204], ["-2/0/0", 204], ["-3/0/0", 404], ["-1/99999999/0", 404]]) {
    assert.equal((await at.ask("GET", `/adit/map/grid/ugv1/${place}.png`)).status, status, place);
  }
});
