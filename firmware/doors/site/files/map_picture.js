// How the map gets onto its canvas: cached layers one above the other, each drawn again only if its content changed. A frame is a copy
// of these layers, with the text at the edges.
import { CachedLayer } from "./map_cached_layer.js";

const REST = 160; // ms without a move: then the view is drawn exactly
const FRAME_BUDGET = 10; // ms: the rest waits for the next frame
const MIN_INTERVAL = 1500, MAX_INTERVAL = 2500; // ms: between two pictures of what the box sends
const ATTENDED = 3000, ATTENDED_INTERVAL = 400; // ms: so long after a hand's action it is drawn so often, for it may be waited for

export class Picture {
  #canvas;
  #ctx;
  #view;
  #layers; // from the lowest: {cache, key(), draw(ctx, view), pieces()}
  #over;
  #ground;
  #waiting = false;
  #isHeld = false; // by a finger
  #isStale = true; // the next picture is of what changed
  #isChanged = false; // by the box
  #looked = -Infinity; // when it was last drawn
  #later = 0; // a timer
  #moved = -Infinity;
  #handled = performance.now();
  #rest = 0;
  fontSize = 14; // pixels, of text on the map
  hasNames = true; // or there is no room for any
  before = () => {};

  /** `layers`: from the lowest, {key(), draw(ctx, view)}; a layer whose pieces change has pieces(), too: the areas that changed since the
   *  last call, [{left, right, bottom, top}] in metres; draw() gets each area as its third argument. `isOfView`: the view decides its content.
   *  `over(ctx, view)` is drawn each time; `ground()` is the colour below all. */
  constructor(canvas, view, { layers, over, ground }) {
    [this.#canvas, this.#view, this.#over, this.#ground] = [canvas, view, over, ground];
    this.#layers = layers.map((layer) => ({ ...layer, cache: new CachedLayer(layer) }));
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
    this.#isStale = true;
    this.#draw(); // at once: a canvas of a new size is blank
  }
  density = () => devicePixelRatio || 1;

  /** It was moved by hand: until it has come to rest it is copied. */
  moved() {
    this.#moved = performance.now();
    clearTimeout(this.#rest);
    this.#rest = setTimeout(() => this.redraw(), REST + 1);
    this.#drawSoon();
  }
  #isMoving = () => this.#isHeld || performance.now() - this.#moved < REST;

  /** While a finger is down no name gets another place. */
  hold(isHeld) {
    this.#isHeld = isHeld;
    if (!isHeld) this.redraw();
  }

  /** Draws what a hand changed, with the next frame. */
  redraw() {
    this.#handled = performance.now();
    this.#drawChanged();
  }

  /** The box sent something: it is drawn with the page's next update, or soon if somebody waits for it. */
  changed() {
    this.#isChanged = true;
    const now = performance.now(), isAttended = !this.#isMoving() && now - this.#handled < ATTENDED;
    this.#later ||= setTimeout(() => this.#drawChanged(), this.#looked + (isAttended ? ATTENDED_INTERVAL : MAX_INTERVAL) - now);
  }

  /** The page draws itself: so does the map every other time, with the same frame. */
  update(isUrgent) {
    if (this.#isChanged && (isUrgent || performance.now() - this.#looked >= MIN_INTERVAL)) this.#drawChanged();
  }

  #drawChanged() {
    this.#isStale = true;
    this.#drawSoon();
  }

  #drawSoon() {
    if (this.#waiting) return;
    this.#waiting = true;
    requestAnimationFrame(() => {
      this.#waiting = false;
      this.#draw();
    });
  }

  /** Draws the layers again that do not cover `view`, and if it is stale those that changed. Gives how many still wait. */
  #refresh(view, isMoving, density) {
    const began = performance.now();
    let waiting = 0;
    for (const { cache, key, draw, pieces } of this.#layers) {
      const now = this.#isStale ? key() : cache.key;
      if (!cache.needsRedraw(view, now, density, isMoving)) {
        if (this.#isStale && pieces) for (const piece of pieces()) cache.patch(piece, draw);
        continue;
      }
      if (performance.now() - began > FRAME_BUDGET) {
        ++waiting;
        continue;
      }
      pieces?.();
      cache.draw(view, now, density, draw);
    }
    return waiting;
  }

  #draw() {
    if (this.#isStale) {
      clearTimeout(this.#later);
      this.#later = 0;
      this.#isChanged = false;
      this.#looked = performance.now();
      this.before();
    }
    const ctx = this.#ctx, density = this.density(), view = this.#view.snapped(density), isMoving = this.#isMoving();
    const waiting = this.#refresh(view, isMoving, density);
    this.#isStale &&= waiting > 0;
    ctx.resetTransform();
    ctx.fillStyle = this.#ground();
    ctx.fillRect(0, 0, this.#canvas.width, this.#canvas.height);
    for (const { cache } of this.#layers) cache.copyTo(ctx, view);
    ctx.setTransform(density, 0, 0, density, 0, 0);
    this.#over(ctx, view);
    if (waiting) this.#drawSoon();
  }
}
