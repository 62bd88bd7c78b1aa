// The picture of the maps on a canvas: of which level a layer is drawn, which of its tiles are seen, and each in its place.
import { grouped } from "./grouped.js";
import { themeNow } from "./theme_now.js";

const MAX_PIXEL = 4; // pixels: where the base's are larger, a finer level is drawn, if there is one
const MAX_FINER_TILES = 200; // tiles at a time, the uppermost layers first: a layer that finds no room is as coarse as the base
const MAX_JOINED = 200; // images of several layers

const pixelsOf = (tiles, view, density, level) => (tiles.metresOf(level) / tiles.side) * view.scale * density;

/** The level of the mosaic whose pixels are about as large as those of the page. */
function levelOf(tiles, view, density) {
  const isSmall = (_, level) => pixelsOf(tiles, view, density, level) <= 2;
  return Math.max(0, tiles.metresPerPixel.findLastIndex(isSmall));
}

function finerLevelOf(tiles, view, density, { finer }) {
  let level = 0;
  while (finer && level > finer.level && pixelsOf(tiles, view, density, level) > MAX_PIXEL) --level;
  return level;
}

/** Those tiles of a layer that are seen, of which it has one: [{name, level, x, y}]. */
function tilesIn(layer, level, seen, metres) {
  const places = [];
  for (const [name, { level: of, x, y, blank }] of layer.tiles) {
    const isSeen = x * metres < seen.right && (x + 1) * metres > seen.left && y * metres < seen.top && (y + 1) * metres > seen.bottom;
    if (of === level && isSeen) places.push({ name, level, x, y, blank });
  }
  return places;
}

/** Those of a finer level in their place that lie in `seen`. */
function finerTilesIn(tiles, layer, level, seen) {
  const base = tiles.metresOf(0), metres = tiles.metresOf(level);
  const along = Math.round(base / metres);
  const places = [];
  for (const { x, y, blank } of tilesIn(layer, 0, seen, base)) {
    if (blank) continue;
    const first = (at, from) => Math.max(at * along, Math.floor(from / metres));
    const last = (at, to) => Math.min((at + 1) * along, Math.ceil(to / metres));
    for (let row = first(y, seen.bottom); row < last(y, seen.top); ++row) {
      for (let column = first(x, seen.left); column < last(x, seen.right); ++column) {
        places.push({ name: `${level}/${column}/${row}`, level, x: column, y: row });
      }
    }
  }
  return places;
}

/** Of each of `layers`, the lowest first, the tiles that are seen: [{layer, places}]. `at`: null is now; of earlier times there is
 *  nothing finer. */
function visibleTiles(tiles, layers, view, density, at, seen) {
  const level = levelOf(tiles, view, density);
  let room = MAX_FINER_TILES;
  return [...layers].reverse().map((layer) => {
    const finer = level === 0 && at === null ? finerLevelOf(tiles, view, density, layer) : 0;
    const count = finer < 0 ? finerTilesIn(tiles, layer, finer, view.bounds()).length : 0;
    if (!count || count > room) return { layer, places: tilesIn(layer, level, seen, tiles.metresOf(level)) };
    room -= count;
    return { layer, places: finerTilesIn(tiles, layer, finer, seen) };
  }).reverse();
}

const coarser = (tiles, { level, x, y }) => {
  const step = Math.round(tiles.metresOf(level + 1) / tiles.metresOf(level));
  const [column, row] = [x, y].map((at) => Math.floor(at / step));
  return { name: `${level + 1}/${column}/${row}`, level: level + 1, x: column, y: row };
};

/** The image of a place, or of the coarser one that it lies in while it is being fetched or is not there: {image, of: its place}. */
function imageOf(tiles, layer, place, at) {
  if (place.level >= 0) return { image: tiles.image(layer, place.name, at), of: place };
  let of = place, image = tiles.finerImage(layer, place.name, true);
  while (!image && of.level < 0) {
    of = coarser(tiles, of);
    image = of.level < 0 ? tiles.finerImage(layer, of.name, false) : tiles.image(layer, of.name, at);
  }
  return { image, of };
}

/** Asks for the images of what is seen that changed. */
export function fetchLayers(view, tiles, layers, at, density) {
  for (const { layer, places } of visibleTiles(tiles, layers, view, density, at, view.bounds())) {
    for (const place of places) imageOf(tiles, layer, place, at);
  }
}

const intersection = (a, b) => ({
  left: Math.max(a.left, b.left),
  right: Math.min(a.right, b.right),
  bottom: Math.max(a.bottom, b.bottom),
  top: Math.min(a.top, b.top),
});

const joined = new Map(); // images of several layers by kind and place, the last used last: {images, blend, canvas}

/** One image of all `images` of a place, the lowest first, at their own resolution. It is drawn again if one of them changed: twenty robots
 *  that map the same place cost no more than one while the map is moved. */
function join(key, images, blend) {
  if (images.length === 1) return images[0];
  const last = joined.get(key);
  const isSame = last?.blend === blend && last.images.length === images.length && images.every((image, i) => image === last.images[i]);
  const canvas = last?.canvas ?? document.createElement("canvas");
  joined.delete(key);
  joined.set(key, { images, blend, canvas });
  if (joined.size > MAX_JOINED) joined.delete(joined.keys().next().value);
  if (isSame) return canvas;
  [canvas.width, canvas.height] = [images[0].width, images[0].height]; // and blank
  const ctx = canvas.getContext("2d");
  ctx.globalCompositeOperation = blend;
  for (const image of images) ctx.drawImage(image, 0, 0);
  return canvas;
}

/** Draws the visible tiles in `piece` (metres): the clouds, and blends the grids into them. At each pixel the colour that differs more
 *  from the ground's stays, so that walls show through clouds and free cells do not. Without clouds the uppermost grid stays. */
export function drawLayers(ctx, view, tiles, layers, at, density, piece = view.bounds()) {
  const seen = intersection(piece, view.bounds()); // a coarse tile is larger than that, and what lies in it is not to be asked for
  const visible = visibleTiles(tiles, layers, view, density, at, seen);
  const isCloud = ({ layer }) => layer.kind === "cloud", clouds = visible.filter(isCloud), grids = visible.filter((each) => !isCloud(each));
  const draw = (those, blend) => {
    const all = those.flatMap(({ layer, places }) => places.map((place) => ({ layer, place, ...imageOf(tiles, layer, place, at) }))).filter(({ image }) => image);
    ctx.globalCompositeOperation = blend;
    for (const its of grouped(all, ({ place, of }) => (of === place ? place.name : place)).values()) {
      const [{ layer, place, of }] = its;
      drawTile(ctx, view, tiles, place, { image: join(`${layer.kind} ${place.name}`, its.map(({ image }) => image), blend), of }, density);
    }
  };
  draw(clouds, "source-over");
  draw(grids, clouds.length ? (themeNow() === "light" ? "darken" : "lighten") : "source-over");
  ctx.globalCompositeOperation = "source-over";
}

function drawTile(ctx, view, tiles, { level, x, y }, { image, of }, density) {
  const metres = tiles.metresOf(level), whole = tiles.metresOf(of.level);
  ctx.imageSmoothingEnabled = pixelsOf(tiles, view, density, of.level) < 1;
  // Whole pixels, so that no line shows between two tiles.
  const [left, top] = view.toPixel({ x: x * metres, y: (y + 1) * metres }).map(Math.round);
  const [right, bottom] = view.toPixel({ x: (x + 1) * metres, y: y * metres }).map(Math.round);
  const side = (metres / whole) * tiles.side; // of the part of the image that this tile is
  const from = [(x * metres) / whole - of.x, of.y + 1 - ((y + 1) * metres) / whole].map((part) => part * tiles.side);
  ctx.drawImage(image, ...from, side, side, left, top, right - left, bottom - top);
}
