// The team's markers as the Command Post was last told of them, seen from above. Only what changed is fetched
// (README.md: GET /adit/markers).
import { clip } from "./words.js";

const LEAST = 3; // units from the middle: what is smaller could not be seen
const TEXT = 9; // of visualization_msgs/Marker
const LONGEST = 40; // letters

export class Markers {
  leftOut = 0;
  #all = new Map(); // "ns id" to marker
  #version = 0;
  #asked = false;
  #changed;

  /** `changed` is called when there is something new to draw. */
  constructor(changed) {
    this.#changed = changed;
  }

  /** Asks for what changed where the box says that something did. */
  async follow(version) {
    if (this.#asked || version === this.#version) return;
    this.#asked = true;
    try {
      const answer = await fetch(`/adit/markers?since=${this.#version}`);
      if (answer.ok) this.#take(await answer.json());
    } catch {
      // asked for again with the next event
    } finally {
      this.#asked = false;
    }
  }

  #take({ version, whole, left_out, markers, gone }) {
    if (whole) this.#all.clear();
    const key = ({ ns, id }) => `${id} ${ns}`;
    for (const marker of gone) this.#all.delete(key(marker));
    for (const marker of markers) {
      this.#all.delete(key(marker)); // the newest is drawn last, and so on top
      this.#all.set(key(marker), marker);
    }
    this.#version = version;
    this.leftOut = left_out;
    this.#changed();
  }

  get count() {
    return this.#all.size;
  }

  /** Those that stood then, as they are now: what they were before is not kept. */
  at(time) {
    return [...this.#all.values()].filter(({ at, lifetime }) => at <= time && (!lifetime || time < at + lifetime));
  }
}

const two = (value) => Math.round(255 * Math.min(1, Math.max(0, value)));
const css = ({ r, g, b, a }) => `rgb(${two(r)} ${two(g)} ${two(b)} / ${a})`;
/** The colour that sets a text off from what is around it. */
const rimOf = ({ r, g, b }) => (0.3 * r + 0.6 * g + 0.1 * b > 0.5 ? "#000" : "#fff");

function polygon(paint, points) {
  paint.beginPath();
  for (const [x, y] of points) paint.lineTo(x, y);
  paint.closePath();
}
function round(paint, x, y) {
  paint.beginPath();
  paint.ellipse(0, 0, x, y, 0, 0, 2 * Math.PI);
}

/** By type; x and y: half its size in units, along and across. */
const SHAPES = {
  0: (paint, x, y) => polygon(paint, [[0, -y / 3], [1.3 * x, -y / 3], [1.3 * x, -y], [2 * x, 0], [1.3 * x, y], [1.3 * x, y / 3], [0, y / 3]]),
  1: (paint, x, y) => polygon(paint, [[-x, -y], [x, -y], [x, y], [-x, y]]),
  2: round,
  // The ICD has no points for strips and lists: they are where their pose is.
  4: (paint) => polygon(paint, [[-8, -1], [8, -1], [8, 1], [-8, 1]]),
  8: (paint) => polygon(paint, [[0, -LEAST], [LEAST, 0], [0, LEAST], [-LEAST, 0]]),
  11: (paint, x, y) => polygon(paint, [[x, y], [-x, y], [0, -y]]),
};
const LIKE = { 3: 2, 5: 4, 6: 8, 7: 8, 10: 11 };

function drawMarker(paint, colours, view, { type, position, heading, scale, color }, unit) {
  const half = (size) => Math.max(LEAST, (Math.abs(size) * view.scale) / 2 / unit);
  paint.save();
  paint.translate(...view.toPixel(position));
  paint.rotate(-heading);
  paint.scale(unit, unit);
  (SHAPES[LIKE[type] ?? type] ?? SHAPES[8])(paint, half(scale.x), half(scale.y || scale.x));
  paint.fillStyle = css(color);
  paint.lineWidth = 1;
  paint.strokeStyle = color.a ? colours.ground : colours.soft; // one that cannot be seen shows as its outline
  paint.fill();
  paint.stroke();
  paint.restore();
}

/** `unit`: pixels, by the size of the page's letters. */
export function drawMarkers(paint, colours, view, markers, unit) {
  for (const marker of markers) {
    if (marker.type !== TEXT) drawMarker(paint, colours, view, marker, unit);
  }
}

/** Their texts, where reports and robots have left room for them. */
export function writeMarkers(labels, view, markers) {
  for (const { type, position, color, scale, text } of markers) {
    if (type !== TEXT) continue;
    const size = Math.min(48, Math.max(labels.size, scale.z * view.scale));
    const colours = color.a ? { colour: css({ ...color, a: 1 }), rim: rimOf(color) } : { colour: labels.colours.soft };
    labels.write(clip(text, LONGEST), ...view.toPixel(position), { ...colours, size });
  }
}
