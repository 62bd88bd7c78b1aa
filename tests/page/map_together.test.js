// The tiles of twenty robots: how many requests they need, in which order, and how far it is.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Tiles } from "../../firmware/doors/site/files/map_tiles.js";

const LAYER = { bounds: null, heights: null, finer: null, first: 100, last: 200 };
const tilesOf = (count) => Array.from({ length: count }, (_, x) => ({ level: 0, x, y: 0, first: 100, stamp: 200, version: 7, blank: false }));
const ROBOTS = Array.from({ length: 20 }, (_, i) => `r${i + 1}`);
const MAP = {
  version: 7, metres_per_pixel: [0.25, 1, 4], finer_metres_per_pixel: [], tile_side: 256, colours: null,
  layers: ["", ...ROBOTS].flatMap((robot) => ["grid", "cloud"].map((kind) => ({ ...LAYER, kind, robot, tiles: tilesOf(robot ? 8 : 26) }))),
};
const LOOKS = { grid: [], cloud: [], robot: () => [] };

/** A box that answers once answer() is called: {requests, answer}. Its images are the bytes of their places. */
function box(t) {
  const requests = [], waiting = [];
  t.mock.method(globalThis, "fetch", async (url) => {
    if (url.startsWith("/adit/map?")) return { ok: true, json: async () => MAP };
    requests.push(new URL(url, "http://box"));
    return new Promise((resolve, reject) => waiting.push({ url: requests.at(-1), resolve, reject }));
  });
  globalThis.createImageBitmap = async (image) => ({ text: await image.text() });
  t.after(() => delete globalThis.createImageBitmap);
  const bodyFor = ({ pathname, searchParams }) => {
    const places = searchParams.get("tiles").split(","), images = places.map((place) => `${pathname} ${place}`);
    const heads = places.map((place, i) => ({ place, bytes: images[i].length, since: 200, until: null }));
    return new TextEncoder().encode(`${JSON.stringify({ tiles: heads })}\n${images.join("")}`);
  };
  const answer = () => { for (const { url, resolve } of waiting.splice(0)) resolve({ ok: true, arrayBuffer: async () => bodyFor(url).buffer }); };
  const fail = () => { for (const { reject } of waiting.splice(0)) reject(new Error("no answer")); };
  return { requests, answer, fail, turn: () => new Promise((resolve) => setTimeout(resolve, 1)) };
}

async function asked(t) {
  const at = box(t), drawn = { times: 0 }, tiles = new Tiles(() => ++drawn.times);
  tiles.setLooks(LOOKS, false);
  await tiles.refresh();
  const see = () => [...tiles.layers.values()].flatMap((layer) => [...layer.tiles.keys()].map((place) => tiles.image(layer, place, null)));
  see();
  await at.turn();
  return { ...at, drawn, tiles, see };
}

test("asks once for all tiles of a layer, the merged map first", async (t) => {
  const { requests, answer, turn, tiles, see } = await asked(t);
  assert.deepEqual(requests.slice(0, 2).map(({ pathname }) => pathname), ["/adit/map/grid/-/tiles", "/adit/map/cloud/-/tiles"]);
  assert.equal(requests[0].searchParams.get("tiles").split(",").length, 26);
  assert.equal(requests.length, 4, "at once");
  assert.equal(tiles.progress().all, 2 * (26 + 20 * 8));
  while (tiles.progress()) {
    answer();
    await turn();
  }
  assert.equal(requests.length, 42);
  const images = see();
  assert.ok(images.every(Boolean));
  assert.equal(tiles.image(tiles.layers.get("grid r3"), "0/5/0", null).text, "/adit/map/grid/r3/tiles 0/5/0");
  await turn();
  assert.equal(requests.length, 42, "nothing changed");
});

test("tells how many tiles have come", async (t) => {
  const { answer, turn, tiles } = await asked(t);
  assert.equal(tiles.progress().done, 0);
  answer();
  await turn();
  assert.equal(tiles.progress().done, 2 * (26 + 8));
});

test("asks again for what did not come, when it is next drawn", async (t) => {
  const { requests, fail, turn, tiles, see, drawn } = await asked(t), before = drawn.times;
  while (tiles.progress()) {
    fail();
    await turn();
  }
  assert.equal(drawn.times, before, "a failure gives nothing to draw, and so no request at once");
  see();
  await turn();
  assert.ok(requests.length > 42);
  assert.equal(requests.at(-1).searchParams.get("tiles").split(",").length > 0, true);
});

test("asks for at most 64 tiles at a time", async (t) => {
  const { requests, tiles, turn } = await asked(t);
  const layer = { kind: "grid", robot: "wide", tiles: new Map(tilesOf(100).map((tile) => [`0/${tile.x}/0`, tile])) };
  for (const place of layer.tiles.keys()) tiles.image(layer, place, null);
  await turn();
  for (const url of requests) assert.ok(url.searchParams.get("tiles").split(",").length <= 64);
});
