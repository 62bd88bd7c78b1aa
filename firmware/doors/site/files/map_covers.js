// What of the page stands over the map: its tools, its legend. Names keep off it.

const OVER = ".zoom, .follow, .layers summary, .layers fieldset, .measured, .leftout, .legend, .pair";

export class Covers {
  #boxes = [];

  /** `changed` is called where another part of the map is covered. */
  constructor(canvas, changed) {
    const parts = [...(canvas.closest("#map")?.querySelectorAll(OVER) ?? [])];
    const observer = new ResizeObserver(() => {
      const { left, top } = canvas.getBoundingClientRect();
      const boxes = parts.map((part) => part.getBoundingClientRect()).filter(({ width }) => width)
        .map((box) => [box.left - left, box.top - top, box.right - left, box.bottom - top].map(Math.round));
      if (String(boxes) === String(this.#boxes)) return;
      this.#boxes = boxes;
      changed();
    });
    for (const part of [canvas, ...parts]) observer.observe(part);
  }

  /** [left, top, right, bottom], pixels of the canvas. */
  boxes = () => this.#boxes;
}
