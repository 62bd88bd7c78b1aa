// Measuring on the map: from one point to another.
import { drawCross } from "./map_reports.js";
import { metres } from "./words.js";

export class Ruler {
  #points = [];
  isOn = false;

  set(isOn) {
    this.isOn = isOn;
    this.#points = [];
  }

  /** The first point, or the second; after that the first of another way. */
  put(place) {
    if (this.#points.length === 2) this.#points = [];
    this.#points.push(place);
  }

  /** What is to be done, or how far it is. */
  get words() {
    if (!this.isOn) return "";
    const [from, to] = this.#points;
    if (!from) return "Tap the first point.";
    if (!to) return `From ${metres(from.x)}, ${metres(from.y)} m. Tap the second point.`;
    const along = to.x - from.x, up = to.y - from.y;
    return `${Math.hypot(along, up).toFixed(2)} m (x ${metres(along)}, y ${metres(up)})`;
  }

  draw(ctx, colours, view, size) {
    if (!this.isOn) return;
    const places = this.#points.map(view.toPixel), look = { ...colours, ask: colours.lamp };
    if (places.length === 2) {
      for (const [width, colour] of [[6, colours.ground], [2.5, colours.lamp]]) {
        Object.assign(ctx, { lineWidth: width, strokeStyle: colour });
        ctx.beginPath();
        ctx.moveTo(...places[0]);
        ctx.lineTo(...places[1]);
        ctx.stroke();
      }
    }
    for (const place of places) drawCross(ctx, look, place, size * 0.6);
  }
}
