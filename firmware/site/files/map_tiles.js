// The picture of the maps, as the box has it: which layers and tiles there are, and their images, each fetched
// when it is looked at and its version changed (README.md: GET /adit/map).

const AT_ONCE = 4, MOST_IMAGES = 400;

/** Tells of a time and colours whether a tile's answer is what it was then, too: it says from when to when it was so. */
function spanOf({ headers }, name) {
  const from = Number(headers.get("Adit-Since") ?? Infinity), until = Number(headers.get("Adit-Until") ?? NaN);
  return (at, colours) => at >= from && at < until && name.endsWith(colours);
}

export class Tiles {
  layers = new Map(); // "grid r1" to {kind, robot, bounds, tiles: Map("level/x/y" to {version, first, stamp, blank})}
  metresPerPixel = [0.25, 1, 4];
  side = 256;
  colours = null; // {free, occupied, heights}: of the images
  heights = null; // {low, high}, in metres, over which the colours of all clouds are spread
  changes = 0; // counts what changes all of it
  #pieces = new Map(); // by their names, where an image came
  #looks = null; // map_theme.js
  #byRobot = false;
  #version = 0;
  #images = new Map(); // "grid/r1/0/1/2" to {name, image}: what was asked for, and what was last fetched
  #queue = [];
  #loading = 0;
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

  #coloursOf({ kind, robot }) {
    const [from, to] = kind === "grid" ? this.#looks.grid : this.#byRobot ? this.#looks.robot(robot) : this.#looks.cloud ?? [];
    const spread = kind === "cloud" && this.heights ? `&low=${this.heights.low}&high=${this.heights.high}` : "";
    return from ? `${spread}&from=${from}&to=${to}` : spread;
  }

  /** Asks what changed since the last time. */
  async refresh() {
    let map = await this.#ask();
    if (map.version < this.#version) {
      this.#forget(); // the box restarted, and its picture with it
      map = await this.#ask();
    }
    this.#take(map);
  }

  async #ask() {
    const answer = await fetch(`${this.#base}/map?since=${this.#version}`);
    if (!answer.ok) throw new Error(`the box answered ${answer.status}`);
    return answer.json();
  }

  #take(map) {
    if (map.version === this.#version) return;
    this.#version = map.version;
    this.metresPerPixel = map.metres_per_pixel;
    this.side = map.tile_side;
    this.colours = map.colours;
    for (const { tiles, ...layer } of map.layers) {
      const key = `${layer.kind} ${layer.robot}`;
      const known = this.layers.get(key) ?? { tiles: new Map() };
      this.layers.set(key, Object.assign(known, layer));
      for (const tile of tiles) {
        const place = `${tile.level}/${tile.x}/${tile.y}`;
        known.tiles.set(place, tile);
        if (tile.blank) this.#pieces.set(place, this.#areaOf(place)); // no image will come
      }
    }
    this.#spreadColours();
    this.#changed();
  }

  /** In steps, so that not every map gives every cloud new colours. */
  #spreadColours() {
    const all = [...this.layers.values()].map((layer) => layer.heights).filter(Boolean);
    if (!all.length) return;
    const low = Math.floor(Math.min(...all.map((heights) => heights.low)) / 2) * 2;
    const high = Math.ceil(Math.max(...all.map((heights) => heights.high)) / 2) * 2;
    this.heights = { low, high: Math.max(high, low + 4) };
  }

  #forget() {
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
      all = all
        ? { left: Math.min(all.left, b.left), bottom: Math.min(all.bottom, b.bottom), right: Math.max(all.right, b.right), top: Math.max(all.top, b.top) }
        : b;
    }
    return all;
  }

  /** The tile's image as it was `at` that time (null: now), or the last one there is while it is being fetched. */
  image(layer, place, at) {
    const tile = layer.tiles.get(place);
    if (!tile || (at === null ? tile.blank : at < tile.first)) return null;
    const isNewest = at === null || (at >= tile.stamp && !tile.blank);
    const path = `${this.#base}/map/${layer.kind}/${layer.robot || "-"}/${place}.png`;
    const name = `${path}?${isNewest ? `v=${tile.version}` : `at=${at}`}${this.#coloursOf(layer)}`;
    let known = this.#images.get(path);
    if (!known) this.#images.set(path, (known = { name: "", image: null, place }));
    known.used = performance.now();
    if (known.name !== name && !(at !== null && known.isAsOf?.(at, this.#coloursOf(layer)))) {
      known.name = name;
      this.#queue = this.#queue.filter((other) => other.known !== known);
      this.#queue.push({ known, name });
      this.#load();
    }
    return known.image;
  }

  async #load() {
    if (this.#loading >= AT_ONCE || !this.#queue.length) return;
    const { known, name } = this.#queue.shift();
    ++this.#loading;
    try {
      const answer = await fetch(name);
      const image = answer.ok ? await createImageBitmap(await answer.blob()) : null;
      if (known.name !== name || !(image || answer.status === 404)) return;
      known.image = image;
      known.isAsOf = spanOf(answer, name);
      this.#pieces.set(known.place, this.#areaOf(known.place));
      this.#changed();
    } catch {
      if (known.name === name) known.name = ""; // asked for again when it is next drawn
    } finally {
      --this.#loading;
      this.#drop();
      this.#load();
    }
  }

  #areaOf(place) {
    const [level, x, y] = place.split("/").map(Number), metres = this.metresPerPixel[level] * this.side;
    return { left: x * metres, right: (x + 1) * metres, bottom: y * metres, top: (y + 1) * metres };
  }

  #drop() {
    if (this.#images.size <= MOST_IMAGES) return;
    const oldest = [...this.#images].sort(([, a], [, b]) => a.used - b.used).slice(0, MOST_IMAGES / 4);
    for (const [path] of oldest) this.#images.delete(path);
  }
}

/** The level whose pixels are about as large as those of the page. */
function levelOf(tiles, view, density) {
  const sizes = tiles.metresPerPixel.map((metres) => metres * view.scale * density);
  return { level: Math.max(0, sizes.findLastIndex((size) => size <= 2)), sizes };
}

/** Those tiles of a layer that are seen, of which it has one: [{name, x, y}]. */
function placesIn(layer, level, seen, metres) {
  const places = [];
  for (const [name, { level: of, x, y }] of layer.tiles) {
    const isSeen = x * metres < seen.right && (x + 1) * metres > seen.left && y * metres < seen.top && (y + 1) * metres > seen.bottom;
    if (of === level && isSeen) places.push({ name, x, y });
  }
  return places;
}

/** Asks for the images of what is seen that changed. */
export function fetchLayer(view, tiles, layer, at, density) {
  const { level } = levelOf(tiles, view, density);
  for (const { name } of placesIn(layer, level, view.bounds(), tiles.metresPerPixel[level] * tiles.side)) tiles.image(layer, name, at);
}

/** Draws those of a layer's tiles that lie in `seen`, metres. */
export function drawLayer(paint, view, tiles, layer, at, density, seen = view.bounds()) {
  const { level, sizes } = levelOf(tiles, view, density), metres = tiles.metresPerPixel[level] * tiles.side;
  paint.imageSmoothingEnabled = sizes[level] < 1;
  for (const place of placesIn(layer, level, seen, metres)) {
    const image = tiles.image(layer, place.name, at);
    if (!image) continue;
    // Whole pixels, so that no line shows between two tiles.
    const [left, top] = view.toPixel({ x: place.x * metres, y: (place.y + 1) * metres }).map(Math.round);
    const [right, bottom] = view.toPixel({ x: (place.x + 1) * metres, y: place.y * metres }).map(Math.round);
    paint.drawImage(image, left, top, right - left, bottom - top);
  }
}
