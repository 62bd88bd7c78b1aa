// How the map gets onto its canvas: cached layers one above the other, each drawn again only if its content changed. All but the
// uppermost, which changes with every step of a robot, are put together on one; a frame is a copy of these two, and what is
// written at the edges.
import { CachedLayer } from "./map_cached_layer.js";

const REST = 160; // ms without a move: then all is drawn exactly for what is seen
const FRAME_BUDGET = 10; // ms: the rest waits for the next frame
const PATCH_INTERVAL = 400; // ms: pieces of a cache are drawn again no more often

export class Picture {
  #canvas;
  #ctx;
  #view;
  #layers; // from the lowest: {cache, key(), draw(ctx, view)}
  #over;
  #ground;
  #below = new CachedLayer(true);
  #patched = -Infinity;
  #composed = 0;
  #waiting = false;
  #isHeld = false; // by a finger
  #moved = -Infinity;
  #rest = 0;
  fontSize = 14; // pixels, of what is written on the map
  hasNames = true; // or there is no room for any
  before = () => {};

  /** `layers`: from the lowest, {key(), draw(ctx, view)}; of a layer of which pieces change also `pieces()`, what changed since it was
   *  last asked, [{left, right, bottom, top}] in metres; then draw() has the piece as its third. `over(ctx, view)` is drawn each time;
   *  `ground()` is the colour below all. */
  constructor(canvas, view, { layers, over, ground }) {
    [this.#canvas, this.#view, this.#over, this.#ground] = [canvas, view, over, ground];
    this.#layers = layers.map((layer) => ({ ...layer, cache: new CachedLayer() }));
    this.#ctx = canvas.getContext("2d", { alpha: false });
    new ResizeObserver(() => this.resize()).observe(canvas);
  }

  resize() {
    const density = this.density();
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    if (!width || !height) return;
    const style = getComputedStyle(this.#canvas);
    this.fontSize = parseFloat(style.fontSize);
    this.hasNames = style.getPropertyValue("--names") !== "none";
    Object.assign(this.#view, { width, height });
    const size = { width: Math.round(width * density), height: Math.round(height * density) };
    if (this.#canvas.width !== size.width || this.#canvas.height !== size.height) Object.assign(this.#canvas, size);
    this.#draw(); // at once: a canvas of a new size is blank
  }
  density = () => devicePixelRatio || 1;

  /** It was moved by hand, or follows what moves: until that has come to rest it is copied. */
  moved() {
    this.#moved = performance.now();
    clearTimeout(this.#rest);
    this.#rest = setTimeout(() => this.redraw(), REST + 1);
    this.redraw();
  }

  /** While a finger is down no name gets another place. */
  hold(isHeld) {
    this.#isHeld = isHeld;
    if (!isHeld) this.redraw();
  }

  redraw() {
    if (this.#waiting) return;
    this.#waiting = true;
    requestAnimationFrame(() => {
      this.#waiting = false;
      this.#draw();
    });
  }

  /** Gives how many layers still wait. */
  #refresh(isMoving, density) {
    const began = performance.now(), top = this.#layers.at(-1);
    let waiting = 0;
    for (const layer of this.#layers) {
      const { cache, key, draw, pieces } = layer, now = key();
      if (!cache.needsRedraw(this.#view, now, density, isMoving)) {
        if (pieces && this.#patch(layer)) ++this.#composed;
        continue;
      }
      if (performance.now() - began > FRAME_BUDGET) {
        ++waiting;
        continue;
      }
      pieces?.();
      cache.draw(this.#view, now, density, draw);
      if (layer !== top) ++this.#composed;
    }
    return waiting;
  }

  /** Gives whether something was drawn again. */
  #patch({ cache, pieces, draw }) {
    const next = this.#patched + PATCH_INTERVAL - performance.now();
    if (next > 0) {
      clearTimeout(this.#later);
      this.#later = setTimeout(() => this.redraw(), next);
      return false;
    }
    const all = pieces();
    if (!all.length) return false;
    this.#patched = performance.now();
    for (const piece of all) cache.patch(piece, draw);
    return true;
  }
  #later = 0;

  #draw() {
    this.before();
    const ctx = this.#ctx, view = this.#view, density = this.density();
    const isMoving = this.#isHeld || performance.now() - this.#moved < REST;
    const waiting = this.#refresh(isMoving, density);
    const key = `${this.#composed} ${this.#ground()}`;
    if (this.#below.needsRedraw(view, key, density, isMoving)) this.#below.draw(view, key, density, this.#compose);
    ctx.resetTransform();
    ctx.fillStyle = this.#ground();
    ctx.fillRect(0, 0, this.#canvas.width, this.#canvas.height);
    this.#below.copyTo(ctx, view);
    this.#layers.at(-1).cache.copyTo(ctx, view);
    ctx.setTransform(density, 0, 0, density, 0, 0);
    this.#over(ctx, view);
    if (waiting) this.redraw();
  }

  #compose = (ctx, view) => {
    ctx.fillStyle = this.#ground();
    ctx.fillRect(0, 0, view.width, view.height);
    for (const { cache } of this.#layers.slice(0, -1)) cache.copyTo(ctx, view);
  };
}
