// How the map gets onto its canvas: plates one above the other, each drawn again only when what is on it changed. All but the
// uppermost, which changes with every step of a robot, are put together on one; a frame is a copy of these two, and what is
// written at the edges.
import { Plate } from "./map_plate.js";

const REST = 160; // ms without a move: then all is drawn exactly for what is seen
const WHILE = 10; // ms: what is not drawn within so long waits for the next frame
const SPACING = 400; // ms: pieces of a plate are drawn again no more often

export class Picture {
  #canvas;
  #paint;
  #view;
  #layers; // from the lowest: {plate, key(), draw(paint, view)}
  #over;
  #ground;
  #below = new Plate(true);
  #patched = -Infinity;
  #composed = 0;
  #waiting = false;
  #isHeld = false; // by a finger
  #moved = -Infinity;
  #rest = 0;
  fontSize = 14; // pixels, of what is written on the map
  hasNames = true; // or there is no room for any
  before = () => {};

  /** `layers`: from the lowest, {key(), draw(paint, view)}; of a layer of which pieces change also `pieces()`, what changed since it was
   *  last asked, [{left, right, bottom, top}] in metres; then draw() has the piece as its third. `over(paint, view)` is drawn each time;
   *  `ground()` is the colour below all. */
  constructor(canvas, view, { layers, over, ground }) {
    [this.#canvas, this.#view, this.#over, this.#ground] = [canvas, view, over, ground];
    this.#layers = layers.map((layer) => ({ ...layer, plate: new Plate() }));
    this.#paint = canvas.getContext("2d", { alpha: false });
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

  /** Gives how many plates still wait. */
  #refresh(isMoving, density) {
    const began = performance.now(), top = this.#layers.at(-1);
    let waiting = 0;
    for (const layer of this.#layers) {
      const { plate, key, draw, pieces } = layer, now = key();
      if (!plate.isDue(this.#view, now, density, isMoving)) {
        if (pieces && this.#patch(layer)) ++this.#composed;
        continue;
      }
      if (performance.now() - began > WHILE) {
        ++waiting;
        continue;
      }
      pieces?.();
      plate.draw(this.#view, now, density, draw);
      if (layer !== top) ++this.#composed;
    }
    return waiting;
  }

  /** Gives whether something was drawn again. */
  #patch({ plate, pieces, draw }) {
    const next = this.#patched + SPACING - performance.now();
    if (next > 0) {
      clearTimeout(this.#later);
      this.#later = setTimeout(() => this.redraw(), next);
      return false;
    }
    const all = pieces();
    if (!all.length) return false;
    this.#patched = performance.now();
    for (const piece of all) plate.patch(piece, draw);
    return true;
  }
  #later = 0;

  #draw() {
    this.before();
    const paint = this.#paint, view = this.#view, density = this.density();
    const isMoving = this.#isHeld || performance.now() - this.#moved < REST;
    const waiting = this.#refresh(isMoving, density);
    const key = `${this.#composed} ${this.#ground()}`;
    if (this.#below.isDue(view, key, density, isMoving)) this.#below.draw(view, key, density, this.#compose);
    paint.resetTransform();
    paint.fillStyle = this.#ground();
    paint.fillRect(0, 0, this.#canvas.width, this.#canvas.height);
    this.#below.copyTo(paint, view);
    this.#layers.at(-1).plate.copyTo(paint, view);
    paint.setTransform(density, 0, 0, density, 0, 0);
    this.#over(paint, view);
    if (waiting) this.redraw();
  }

  #compose = (paint, view) => {
    paint.fillStyle = this.#ground();
    paint.fillRect(0, 0, view.width, view.height);
    for (const { plate } of this.#layers.slice(0, -1)) plate.copyTo(paint, view);
  };
}
