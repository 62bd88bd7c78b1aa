// A part of the map's picture on a canvas of its own, larger than what is seen: while the map is moved it is copied, not drawn again.

const RIM = 0.2, MOST_RIM = 200; // of the view's sides; pixels
const NEAREST = 1.6, FARTHEST = 0.7; // while somebody zooms, a plate is shown so much larger or smaller than it was drawn

export class Plate {
  #canvas = document.createElement("canvas");
  #paint;
  #view = null; // that it was drawn for, with the rim
  #key = null;
  #density = 1;

  /** `isOpaque`: it will be filled. */
  constructor(isOpaque = false) {
    this.#paint = this.#canvas.getContext("2d", { alpha: !isOpaque });
  }

  /** Whether it has to be drawn again: for what is on it (`key`), or for where one looks; while that moves, only where too little of it is left. */
  isDue(view, key, density, isMoving) {
    const own = this.#view;
    if (!own || key !== this.#key || density !== this.#density) return true;
    const ratio = view.scale / own.scale;
    if (isMoving && ratio !== 1) return ratio > NEAREST || ratio < FARTHEST;
    return isMoving ? !own.covers(view) : ratio !== 1 || !own.isAround(view);
  }

  /** `draw(paint, view)`: `view` is larger than what is seen by a rim. */
  draw(view, key, density, draw) {
    const rim = (side) => Math.ceil(Math.min(MOST_RIM, side * RIM));
    this.#view = view.widened(rim(view.width), rim(view.height));
    this.#key = key;
    this.#density = density;
    const size = { width: Math.round(this.#view.width * density), height: Math.round(this.#view.height * density) };
    const paint = this.#paint;
    paint.resetTransform();
    if (this.#canvas.width !== size.width || this.#canvas.height !== size.height) Object.assign(this.#canvas, size); // and blank
    else paint.clearRect(0, 0, size.width, size.height);
    paint.setTransform(density, 0, 0, density, 0, 0);
    draw(paint, this.#view);
  }

  /** Draws again what lies in an area (metres) alone: `draw(paint, view, area)`, that with the pixels that it but touches. */
  patch({ left, right, bottom, top }, draw) {
    const paint = this.#paint, density = this.#density;
    const [from, upper] = this.#view.toPixel({ x: left, y: top }).map((at) => Math.floor(at * density) - 1);
    const [to, lower] = this.#view.toPixel({ x: right, y: bottom }).map((at) => Math.ceil(at * density) + 1);
    paint.save();
    paint.resetTransform();
    paint.beginPath();
    paint.rect(from, upper, to - from, lower - upper);
    paint.clip();
    paint.clearRect(from, upper, to - from, lower - upper);
    paint.setTransform(density, 0, 0, density, 0, 0);
    const rim = 4 / (this.#view.scale * density);
    draw(paint, this.#view, { left: left - rim, right: right + rim, bottom: bottom - rim, top: top + rim });
    paint.restore();
  }

  /** Onto a canvas that shows `view`, at its place: to whole pixels, where it need not be scaled. */
  copyTo(paint, view) {
    const own = this.#view, density = this.#density;
    if (!own) return;
    const ratio = view.scale / own.scale;
    const [left, top] = view.toPixel(own.toMetres(0, 0)).map((at) => Math.round(at * density));
    paint.save();
    paint.resetTransform();
    paint.imageSmoothingEnabled = false;
    if (ratio === 1) paint.drawImage(this.#canvas, left, top);
    else paint.drawImage(this.#canvas, left, top, this.#canvas.width * ratio, this.#canvas.height * ratio);
    paint.restore();
  }
}
