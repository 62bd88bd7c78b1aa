// Where the map's canvas looks: metres of the frame "darpa" (x to the right, y up) to pixels of the page.

const MAX_METRES = 8192, MIN_SCALE = 0.02, MAX_SCALE = 400;
const SAME = 1e-6; // pixels
const MARGIN = 0.05; // of a side, around the fitted area

const clamp = (value, least, most) => Math.min(most, Math.max(least, value));

export class MapView {
  width = 1;
  height = 1;
  centre = { x: 0, y: 0 };
  scale = 8; // pixels per metre

  toPixel = ({ x, y }) => [this.width / 2 + (x - this.centre.x) * this.scale, this.height / 2 - (y - this.centre.y) * this.scale];

  toMetres = (left, top) => ({
    x: this.centre.x + (left - this.width / 2) / this.scale,
    y: this.centre.y - (top - this.height / 2) / this.scale,
  });

  /** What is seen, in metres. */
  bounds() {
    const { x: left, y: top } = this.toMetres(0, 0), { x: right, y: bottom } = this.toMetres(this.width, this.height);
    return { left, top, right, bottom };
  }

  /** The same with so many pixels more on each side. */
  widened(along, down) {
    const size = { width: this.width + 2 * along, height: this.height + 2 * down };
    return Object.assign(new MapView(), { ...size, centre: this.centre, scale: this.scale });
  }

  /** The same, moved to whole pixels of the screen: a picture of one such view, moved, is that of another. */
  snapped(density) {
    const step = this.scale * density, snap = (metres) => Math.round(metres * step) / step;
    return Object.assign(this.widened(0, 0), { centre: { x: snap(this.centre.x), y: snap(this.centre.y) } });
  }

  /** Whether all that `view` shows is in it. */
  covers(view) {
    const own = this.bounds(), its = view.bounds(), slack = SAME / this.scale;
    return own.left <= its.left + slack && own.right >= its.right - slack && own.bottom <= its.bottom + slack && own.top >= its.top - slack;
  }

  /** Whether an area is seen whole, and not at the very edge. */
  holds({ left, right, bottom, top }) {
    const own = this.bounds(), margin = Math.min(this.width, this.height) * 0.02 / this.scale;
    return left - margin >= own.left && right + margin <= own.right && bottom - margin >= own.bottom && top + margin <= own.top;
  }

  /** Whether it has the same middle, and the room of a margin around `view`. */
  isAround({ centre: { x, y }, width, height }) {
    const isNear = (metres) => Math.abs(metres) * this.scale < SAME;
    return isNear(this.centre.x - x) && isNear(this.centre.y - y) && this.width > width && this.height > height;
  }

  pan(right, down) {
    this.lookAt(this.centre.x - right / this.scale, this.centre.y + down / this.scale);
  }

  lookAt(x, y) {
    this.centre = { x: clamp(x, -MAX_METRES, MAX_METRES), y: clamp(y, -MAX_METRES, MAX_METRES) };
  }

  /** What is under (left, top) stays there. */
  zoom(factor, left = this.width / 2, top = this.height / 2) {
    const before = this.toMetres(left, top);
    this.scale = clamp(this.scale * factor, MIN_SCALE, MAX_SCALE);
    const after = this.toMetres(left, top);
    this.lookAt(this.centre.x + before.x - after.x, this.centre.y + before.y - after.y);
  }

  /** Shows the whole of an area with a margin, of at least `below` pixels at the lower edge; a small one not larger than is useful. */
  fit({ left, right, bottom, top }, below = 0) {
    const margin = MARGIN * this.height, more = Math.max(0, below - margin);
    const scale = Math.min((1 - 2 * MARGIN) * this.width / Math.max(1, right - left), (this.height - 2 * margin - more) / Math.max(1, top - bottom));
    this.scale = clamp(scale, MIN_SCALE, 40);
    this.lookAt((left + right) / 2, (bottom + top) / 2 - more / 2 / this.scale);
  }
}
