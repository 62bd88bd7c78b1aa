// A part of the map's picture on a canvas of its own, larger than the view: while the map is moved it is copied, not drawn again.

const MARGIN = 0.2, MAX_MARGIN = 200; // of the view's sides; pixels
const MAX_RATIO = 1.6, MIN_RATIO = 0.7; // while somebody zooms, a layer is shown so much larger or smaller than it was drawn

export class CachedLayer {
  key = null; // identifies the drawn content
  #canvas = document.createElement("canvas");
  #ctx = this.#canvas.getContext("2d");
  #view = null; // that it was drawn for, with the margin
  #density = 1;
  #isOfView;

  /** `isOfView`: what is on it depends on where one looks. */
  constructor({ isOfView = false }) {
    this.#isOfView = isOfView;
  }

  /** Whether it has to be drawn again: for what is on it (`key`), for the scale, or because too little of it is left. While the view
   *  moves, it is scaled. */
  needsRedraw(view, key, density, isMoving) {
    const cached = this.#view;
    if (!cached || key !== this.key || density !== this.#density) return true;
    const ratio = view.scale / cached.scale;
    if (isMoving && ratio !== 1) return ratio > MAX_RATIO || ratio < MIN_RATIO;
    return ratio !== 1 || !cached.covers(view) || (this.#isOfView && !isMoving && !cached.isAround(view));
  }

  /** `draw(ctx, view)`: `view` is larger than what is seen by a margin. */
  draw(view, key, density, draw) {
    const margin = (side) => Math.ceil(Math.min(MAX_MARGIN, side * MARGIN));
    this.#view = view.widened(margin(view.width), margin(view.height));
    this.key = key;
    this.#density = density;
    const size = { width: Math.round(this.#view.width * density), height: Math.round(this.#view.height * density) };
    const ctx = this.#ctx;
    ctx.resetTransform();
    if (this.#canvas.width !== size.width || this.#canvas.height !== size.height) Object.assign(this.#canvas, size); // and blank
    else ctx.clearRect(0, 0, size.width, size.height);
    ctx.setTransform(density, 0, 0, density, 0, 0);
    draw(ctx, this.#view);
  }

  /** Draws again what lies in an area (metres) alone: `draw(ctx, view, area)`, that with the pixels that it but touches. */
  patch({ left, right, bottom, top }, draw) {
    const ctx = this.#ctx, density = this.#density;
    const [from, upper] = this.#view.toPixel({ x: left, y: top }).map((at) => Math.floor(at * density) - 1);
    const [to, lower] = this.#view.toPixel({ x: right, y: bottom }).map((at) => Math.ceil(at * density) + 1);
    ctx.save();
    ctx.resetTransform();
    ctx.beginPath();
    ctx.rect(from, upper, to - from, lower - upper);
    ctx.clip();
    ctx.clearRect(from, upper, to - from, lower - upper);
    ctx.setTransform(density, 0, 0, density, 0, 0);
    const margin = 4 / (this.#view.scale * density);
    draw(ctx, this.#view, { left: left - margin, right: right + margin, bottom: bottom - margin, top: top + margin });
    ctx.restore();
  }

  /** Onto a canvas that shows `view`, at its place. */
  copyTo(ctx, view) {
    const cached = this.#view, density = this.#density;
    if (!cached) return;
    const ratio = view.scale / cached.scale;
    const [left, top] = view.toPixel(cached.toMetres(0, 0)).map((at) => Math.round(at * density));
    ctx.save();
    ctx.resetTransform();
    ctx.imageSmoothingEnabled = false;
    if (ratio === 1) ctx.drawImage(this.#canvas, left, top);
    else ctx.drawImage(this.#canvas, left, top, this.#canvas.width * ratio, this.#canvas.height * ratio);
    ctx.restore();
  }
}
