// Small plots of the last ten minutes, a value a second: kept by the page itself, and before it was opened by the box.
import { attribute } from "./dom.js";

const SPAN = 600, BUCKET = 4, HEIGHT = 32;

export class Plot {
  #values = [];
  #svg;
  #least;
  #due = 0; // values, until it is drawn again

  /** `svg` has paths .lost (where the box did not answer), .area and .line; a plot reaches up to `least` at least. */
  constructor(svg, least) {
    this.#svg = svg;
    this.#least = least;
  }

  /** null: there was none. undefined: the box did not answer. */
  push(value) {
    this.#values.push(value);
    if (this.#values.length > SPAN) this.#values.shift();
  }

  /** What was before all that was pushed: `valueAt(n)` is that of n seconds before now, null where it is not known. */
  fill(valueAt) {
    const earlier = Array.from({ length: SPAN - this.#values.length }, (_, i) => valueAt(SPAN - 1 - i));
    this.#values = [...earlier, ...this.#values];
    this.#due = 0;
  }

  most = () => this.#values.reduce((most, value) => Math.max(most, value ?? 0), 0);

  /** The highest of each four seconds, so that a short peak is seen, at its place from the right; and whether the box was
   *  lost in them. */
  #buckets() {
    const buckets = [];
    for (let end = this.#values.length; end > 0; end -= BUCKET) {
      const all = this.#values.slice(Math.max(0, end - BUCKET), end), known = all.filter((value) => value != null);
      buckets.unshift({ value: known.length ? Math.max(...known) : null, isLost: all.includes(undefined) });
    }
    return buckets;
  }

  /** Once for each bucket: until then it would not move. */
  draw() {
    if (this.#due-- > 0) return;
    this.#due = BUCKET - 1;
    const buckets = this.#buckets(), from = SPAN / BUCKET - buckets.length;
    const top = Math.max(this.#least, this.most());
    const y = (value) => (HEIGHT - 1 - (value / top) * (HEIGHT - 3)).toFixed(1);
    let line = "", area = "", begun = -1;
    const close = (end) => {
      if (begun >= 0) area += `L${end} ${HEIGHT}L${begun} ${HEIGHT}Z`;
      begun = -1;
    };
    buckets.forEach(({ value }, i) => {
      const x = from + i;
      if (value === null) return close(x - 1);
      line += `${begun < 0 ? "M" : "L"}${x} ${y(value)}`;
      area += `${begun < 0 ? "M" : "L"}${x} ${y(value)}`;
      if (begun < 0) begun = x;
    });
    close(from + buckets.length - 1);
    const gaps = buckets.map(({ isLost }, i) => (isLost ? `M${from + i - 1} 0h1v${HEIGHT}h-1Z` : ""));
    for (const [name, d] of Object.entries({ lost: gaps.join(""), line, area })) attribute(this.#svg.querySelector(`.${name}`), "d", d);
  }
}
