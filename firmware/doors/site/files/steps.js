// Whether somebody set the box's clock, by the times that the box tells: what a page keeps under such times is then asked for again.

const MOST = 2; // seconds by which an answer may be late

export class Steps {
  #ahead = null; // of this page's own clock, which nobody sets
  #last = null;

  /** `now`: the box's time as it was told last. Gives whether that clock was set since the one before. */
  seen(now) {
    if (now === this.#last) return false;
    this.#last = now;
    const ahead = now - performance.now() / 1000, before = this.#ahead;
    this.#ahead = ahead;
    return before !== null && Math.abs(ahead - before) > MOST;
  }
}
