// The picture of the maps, as the box has it: which layers and tiles there are, and their images, each fetched
// when it is looked at and its version changed (README.md: GET /adit/map).
import { fetchSoon } from "./session.js";

const AT_ONCE = 4, FINER_AT_ONCE = 2, MAX_IMAGES = 1000; // a finer tile may have to be drawn first
const MAX_TOGETHER = 64; // tiles of one layer in a request
const NONE = [204, 404]; // 204: no data there; 404: no such tile

const overlap = (a, b) => a.left < b.right && b.left < a.right && a.bottom < b.top && b.bottom < a.top;

/** Tells of a time and colours whether a tile is what it was then, too: `since` and `until` say from when to when it was so. */
const spanOf = ({ since, until }, name) => (at, colours) => since !== null && until !== null && at >= since && at < until && name.endsWith(colours);

/** The tiles in an answer, each with its head and its image: a line of JSON, then the images one after the other. */
function* tilesOf(bytes) {
  const end = bytes.indexOf(10);
  let from = end + 1;
  for (const head of JSON.parse(new TextDecoder().decode(bytes.subarray(0, end))).tiles) {
    yield { head, image: head.bytes ? new Blob([bytes.subarray(from, from + head.bytes)], { type: "image/png" }) : null };
    from += head.bytes;
  }
}

export class Tiles {
  layers = new Map(); // "grid r1" to {kind, robot, bounds, tiles: Map("level/x/y" to {version, first, stamp, blank})}
  metresPerPixel = [0.25, 1, 4];
  finerMetresPerPixel = []; // of levels -1, -2
  side = 256;
  colours = null; // {free, occupied, heights}: of the images
  heights = null; // {low, high}, in metres, over which the colours of all clouds are spread
  changes = 0; // counts what changes all of it
  #pieces = new Map(); // by their names, if an image came
  #looks = null; // map_theme.js
  #byRobot = false;
  #version = 0;
  #images = new Map(); // "grid/r1/0/1/2" to {name, image}: the requested name, and the image fetched last
  #queue = [];
  #wave = { began: 0, done: 0 }; // since the queue was last empty
  #loading = 0; // requests
  #awaited = 0; // tiles of these
  #loadingFiner = 0;
  #changed;
  #base;

  /** `changed` is called when there is something new to draw. `base`: what the box's paths begin with. */
  constructor(changed, base = "/adit") {
    this.#changed = changed;
    this.#base = base;
  }

  /** Where images came since it was last asked: [{left, right, bottom, top}], in metres. */
  pieces() {
    const all = [...this.#pieces.values()];
    this.#pieces.clear();
    return all;
  }

  /** How they are coloured: looksOf() of map_theme.js, and clouds by robot or by height. */
  setLooks(looks, byRobot) {
    this.#looks = looks;
    this.#byRobot = byRobot;
    ++this.changes;
  }

  #rampOf({ kind, robot }) {
    if (kind === "grid") return this.#looks.grid;
    return this.#byRobot ? this.#looks.robot(robot) : this.#looks.cloud ?? [];
  }

  #coloursOf(layer) {
    const { kind } = layer, [from, to] = this.#rampOf(layer);
    const spread = kind === "cloud" && this.heights ? `&low=${this.heights.low}&high=${this.heights.high}` : "";
    return from ? `${spread}&from=${from}&to=${to}` : spread;
  }

  /** Asks what changed since the last time. */
  async refresh() {
    let map = await this.#ask();
    if (map.version < this.#version) {
      this.forget(); // the box restarted, and its picture with it
      map = await this.#ask();
    }
    this.#store(map);
  }

  async #ask() {
    const answer = await fetchSoon(`${this.#base}/map?since=${this.#version}`);
    if (!answer.ok) throw new Error(`the box answered ${answer.status}`);
    return answer.json();
  }

  #store(map) {
    if (map.version === this.#version) return;
    this.#version = map.version;
    this.metresPerPixel = map.metres_per_pixel;
    this.finerMetresPerPixel = map.finer_metres_per_pixel;
    this.side = map.tile_side;
    this.colours = map.colours;
    for (const { tiles, ...layer } of map.layers) {
      const key = `${layer.kind} ${layer.robot}`;
      const entry = this.layers.get(key) ?? { tiles: new Map() };
      this.layers.set(key, Object.assign(entry, layer));
      if (layer.finer?.area) this.#ageFiner(layer);
      for (const tile of tiles) {
        const place = `${tile.level}/${tile.x}/${tile.y}`;
        entry.tiles.set(place, tile);
        if (tile.blank) this.#pieces.set(place, this.#areaOf(place)); // no image will come
      }
    }
    this.#spreadColours();
    this.#changed();
  }

  #ageFiner({ kind, robot, finer: { area } }) {
    for (const [path, entry] of this.#images) {
      if (entry.isFiner && path.startsWith(this.#pathOf(kind, robot, "")) && overlap(this.#areaOf(entry.place), area)) entry.isOld = true;
    }
  }

  /** In steps, so that not every map gives every cloud new colours. */
  #spreadColours() {
    const all = [...this.layers.values()].map((layer) => layer.heights).filter(Boolean);
    if (!all.length) return;
    const low = Math.floor(Math.min(...all.map((heights) => heights.low)) / 2) * 2;
    const high = Math.ceil(Math.max(...all.map((heights) => heights.high)) / 2) * 2;
    this.heights = { low, high: Math.max(high, low + 4) };
  }

  /** All is asked for again. */
  forget() {
    this.layers.clear();
    this.#images.clear();
    this.#version = 0;
    ++this.changes;
  }

  /** When the first map came, or null. */
  first() {
    const all = [...this.layers.values()].map((layer) => layer.first);
    return all.length ? Math.min(...all) : null;
  }

  /** Of all layers that `shows(layer)`; null where nothing was drawn. */
  bounds(shows) {
    let all = null;
    for (const layer of this.layers.values()) {
      const b = layer.bounds;
      if (!b || !shows(layer)) continue;
      all ??= { ...b };
      all.left = Math.min(all.left, b.left);
      all.right = Math.max(all.right, b.right);
      all.bottom = Math.min(all.bottom, b.bottom);
      all.top = Math.max(all.top, b.top);
    }
    return all;
  }

  /** How far it is with the images that were asked for together: {done, all, seconds}; null if none is missing. */
  progress() {
    const missing = this.#queue.length + this.#awaited, { began, done } = this.#wave;
    return missing ? { done, all: done + missing, seconds: (performance.now() - began) / 1000 } : null;
  }

  /** The tile's image as it was `at` that time (null: now), or the last one there is while it is being fetched. */
  image(layer, place, at) {
    const tile = layer.tiles.get(place);
    if (!tile || (at === null ? tile.blank : at < tile.first)) return null;
    const isNewest = at === null || (at >= tile.stamp && !tile.blank), colours = this.#coloursOf(layer);
    const of = `${this.#pathOf(layer.kind, layer.robot, "tiles")}?${isNewest ? "" : `at=${at}`}${colours}`;
    const name = `${place} ${isNewest ? tile.version : ""} ${of}`;
    const entry = this.#entryOf(this.#pathOf(layer.kind, layer.robot, place), place);
    if (entry.name !== name && !(at !== null && entry.isAsOf?.(at, colours))) this.#request(entry, name, of, !layer.robot);
    return entry.image;
  }

  /** The same of a finer level; `asks`: it is fetched where it is not there. */
  finerImage(layer, place, asks) {
    const path = `${this.#pathOf(layer.kind, layer.robot, place)}.png`, colours = this.#coloursOf(layer);
    if (!asks) return this.#images.get(path)?.image ?? null;
    const entry = this.#entryOf(path, place);
    entry.isFiner = true;
    if (entry.isOld || entry.version === undefined) Object.assign(entry, { version: layer.finer.version, isOld: false });
    if (entry.colours !== colours) Object.assign(entry, { colours, etag: "" });
    const name = `${path}?v=${entry.version}${colours}`;
    if (entry.name !== name) this.#request(entry, name, "", false);
    return entry.image;
  }

  /** In metres. */
  metresOf = (level) => (level < 0 ? this.finerMetresPerPixel[-1 - level] : this.metresPerPixel[level]) * this.side;

  #pathOf = (kind, robot, place) => `${this.#base}/map/${kind}/${robot || "-"}/${place}`;

  #entryOf(path, place) {
    let entry = this.#images.get(path);
    if (!entry) this.#images.set(path, (entry = { name: "", image: null, place }));
    entry.used = performance.now();
    return entry;
  }

  /** `of`: what tiles of one request have in common; "": it needs one of its own. `isFirst`: before those that are not. */
  #request(entry, name, of, isFirst) {
    entry.name = name;
    if (!this.progress()) this.#wave = { began: performance.now(), done: 0 };
    this.#queue = this.#queue.filter((other) => other.entry !== entry);
    this.#queue.push({ entry, name, of, isFirst });
    queueMicrotask(() => this.#load()); // when all that is seen has been asked for
  }

  /** The requests that are next: one for a finer tile, or those for tiles of one layer. */
  #nextRequests() {
    if (this.#loading >= AT_ONCE) return [];
    const mayFiner = this.#loadingFiner < FINER_AT_ONCE && this.#loading < AT_ONCE - 1;
    const may = ({ entry }) => !entry.isFiner || mayFiner;
    const next = this.#queue.find((each) => each.isFirst && may(each)) ?? this.#queue.find(may);
    const together = next?.of ? this.#queue.filter(({ of }) => of === next.of).slice(0, MAX_TOGETHER) : [next].filter(Boolean);
    this.#queue = this.#queue.filter((each) => !together.includes(each));
    return together;
  }

  #load() {
    for (let next = this.#nextRequests(); next.length; next = this.#nextRequests()) this.#fetch(next);
  }

  async #fetch(requests) {
    const { isFiner } = requests[0].entry;
    ++this.#loading;
    this.#awaited += requests.length;
    if (isFiner) ++this.#loadingFiner;
    try {
      await (isFiner ? this.#fetchFiner(requests[0]) : this.#fetchTogether(requests));
    } catch {
      for (const { entry, name } of requests) if (entry.name === name) entry.name = ""; // asked for again when it is next drawn
    } finally {
      --this.#loading;
      this.#awaited -= requests.length;
      this.#wave.done += requests.length;
      if (isFiner) --this.#loadingFiner;
      this.#evict();
      this.#load();
    }
  }

  async #fetchTogether(requests) {
    const places = requests.map(({ entry }) => entry.place);
    const answer = await fetchSoon(`${requests[0].of}&tiles=${places.join()}`);
    if (!answer.ok) throw new Error(`the box answered ${answer.status}`);
    const byPlace = new Map(requests.map((request) => [request.entry.place, request]));
    const bytes = new Uint8Array(await answer.arrayBuffer());
    await Promise.all([...tilesOf(bytes)].map(async ({ head, image }) => {
      const { entry, name } = byPlace.get(head.place), drawn = image && (await createImageBitmap(image));
      if (entry.name !== name) return;
      entry.isAsOf = spanOf(head, name);
      this.#show(entry, drawn);
    }));
  }

  async #fetchFiner({ entry, name }) {
    const answer = await fetchSoon(name, entry.etag ? { headers: { "If-None-Match": entry.etag } } : {});
    const image = answer.status === 200 ? await createImageBitmap(await answer.blob()) : null;
    if (answer.status === 503) entry.name = ""; // asked for again when it is next drawn
    if (entry.name !== name || !(image || NONE.includes(answer.status))) return;
    entry.etag = answer.headers.get("ETag") ?? "";
    this.#show(entry, image);
  }

  #show(entry, image) {
    entry.image = image;
    this.#pieces.set(entry.place, this.#areaOf(entry.place));
    this.#changed();
  }

  #areaOf(place) {
    const [level, x, y] = place.split("/").map(Number), metres = this.metresOf(level);
    return { left: x * metres, right: (x + 1) * metres, bottom: y * metres, top: (y + 1) * metres };
  }

  #evict() {
    if (this.#images.size <= MAX_IMAGES) return;
    const oldest = [...this.#images].sort(([, a], [, b]) => a.used - b.used).slice(0, MAX_IMAGES / 4);
    for (const [path] of oldest) this.#images.delete(path);
  }
}
