// A list in which nothing moves while a hand is on it: a mouse over it, a finger a moment ago, or the keyboard's focus. New
// rows appear when the hand leaves it.

const TOUCHED = 4000; // ms: so long after a finger it may come back

export class Still {
  #list;
  #left;
  #keys = null; // of its items, as they were when the hand came; null: none is on it
  #over = false;
  #touched = -Infinity;
  #timer = 0;
  waiting = 0; // how many are new since

  /** `left()` is called once the hand has gone. */
  constructor(list, left) {
    this.#list = list;
    this.#left = left;
    const look = () => this.#look();
    list.addEventListener("pointerenter", ({ pointerType }) => pointerType === "mouse" && ((this.#over = true), look()));
    list.addEventListener("pointerleave", () => ((this.#over = false), look()));
    for (const name of ["pointerdown", "pointerup", "touchmove", "scroll"]) list.addEventListener(name, ({ pointerType }) => {
      if (pointerType !== "mouse" && (name !== "scroll" || this.isHeld)) this.#touched = performance.now();
      look();
    }, { passive: true });
    list.addEventListener("focusin", look);
    list.addEventListener("focusout", () => setTimeout(look));
  }

  get isHeld() {
    return this.#keys !== null;
  }

  #isTouched = () => performance.now() - this.#touched < TOUCHED;

  #look() {
    clearTimeout(this.#timer);
    if (this.#isTouched()) this.#timer = setTimeout(() => this.#look(), TOUCHED / 4);
    const isOn = this.#over || this.#isTouched() || this.#list.querySelector(":focus-visible") !== null;
    if (isOn && !this.isHeld) this.#hold();
    else if (!isOn && this.isHeld) this.release();
  }

  /** Each row keeps its height, too, whatever becomes of what is in it. */
  #hold() {
    this.#keys = [...this.#list.children].map(({ dataset }) => dataset.key);
    for (const row of this.#list.children) row.style.minBlockSize = `${row.offsetHeight}px`;
  }

  /** As they are now: somebody asked for it, or the hand has gone. */
  release() {
    this.#keys = null;
    this.waiting = 0;
    for (const row of this.#list.children) row.style.minBlockSize = "";
    this.#left();
    if (this.#over || this.#isTouched()) this.#hold();
  }

  /** A row that was opened or closed by hand has the height that it needs. */
  resize = (row) => row && (row.style.minBlockSize = "");

  /** The order in which `items` are shown: theirs, or the one that is held. */
  order(items, key) {
    if (!this.isHeld || this.#keys.length === 0) return items;
    const known = new Map(items.map((item) => [String(key(item)), item]));
    const shown = this.#keys.filter((name) => known.has(name)).map((name) => known.get(name));
    const last = Math.max(...shown.map((item) => items.indexOf(item)));
    const below = items.slice(last + 1); // older ones, which move nothing
    this.waiting = items.length - shown.length - below.length;
    return [...shown, ...below];
  }
}
