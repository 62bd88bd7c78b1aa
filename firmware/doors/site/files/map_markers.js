// The team's markers as the Command Post was last told of them, seen from above. Only what changed is fetched
// (README.md: GET /adit/markers).
import { css } from "./map_shapes.js";
import { fetchSoon } from "./session.js";
import { themeNow } from "./theme_now.js";
import { clip } from "./words.js";

const INTERVAL = 5000; // ms: markers are asked for no more often
const FEW = 1000; // twice as many markers are asked for half as often
const TEXT = 9, MESH = 10; // of visualization_msgs/Marker
const MADE_OF_POINTS = [4, 5, 6, 7, 8, 11];
const LONGEST = 40; // letters
const WRITTEN_FROM = 1 / 2; // of the page's letters: where a text is smaller from here, it is not written
const NAMED_FROM = 20; // pixels per metre: from there on meshes are named

/** What of the map a marker may cover, in metres. */
function boundsOf({ position, points, scale }) {
  const places = points.length ? points : [position.x, position.y];
  let left = Infinity, right = -Infinity, bottom = Infinity, top = -Infinity;
  for (let i = 0; i < places.length; i += 2) {
    left = Math.min(left, places[i]);
    right = Math.max(right, places[i]);
    bottom = Math.min(bottom, places[i + 1]);
    top = Math.max(top, places[i + 1]);
  }
  const rim = Math.max(Math.abs(scale.x), Math.abs(scale.y));
  return { left: left - rim, right: right + rim, bottom: bottom - rim, top: top + rim };
}

export class Markers {
  leftOut = 0;
  #all = new Map(); // "ns id" to marker
  #version = 0;
  #asked = false;
  #due = -Infinity;
  #serial = 0;
  #changed;

  /** `changed` is called when there is something new to draw. */
  constructor(changed) {
    this.#changed = changed;
  }

  /** Asks for what changed if the box says that something did. */
  async follow(version) {
    if (this.#asked || version === this.#version || performance.now() < this.#due) return;
    this.#asked = true;
    this.#due = performance.now() + INTERVAL * Math.max(1, this.#all.size / FEW);
    try {
      const answer = await fetchSoon(`/adit/markers?since=${this.#version}`);
      if (answer.ok) this.#store(await answer.json());
    } catch {
      // asked for again with the next event
    } finally {
      this.#asked = false;
    }
  }

  /** All are asked for again. */
  forget() {
    this.#version = 0;
  }

  #store({ version, whole, left_out, markers, gone }) {
    if (whole) this.#all.clear();
    const key = ({ ns, id }) => `${id} ${ns}`;
    for (const marker of gone) this.#all.delete(key(marker));
    for (const marker of markers) {
      this.#all.delete(key(marker)); // the newest is drawn last, and so on top
      const needsPoints = !marker.points.length && MADE_OF_POINTS.includes(marker.type);
      this.#all.set(key(marker), { ...marker, needsPoints, bounds: boundsOf(marker), mark: ++this.#serial });
    }
    this.#version = version;
    this.leftOut = left_out;
    this.#changed();
  }

  get count() {
    return this.#all.size;
  }

  /** How many have more points than are drawn. */
  get thinned() {
    return [...this.#all.values()].filter(({ points, point_count }) => points.length < 2 * point_count).length;
  }

  /** Those that stood then, as they are now: what they were before is not kept. */
  at(time) {
    return [...this.#all.values()].filter(({ at, lifetime }) => at <= time && (!lifetime || time < at + lifetime));
  }
}

/** The colour that sets a text off from what is around it; at night nothing is white. */
const rimOf = ({ r, g, b }) => (0.3 * r + 0.6 * g + 0.1 * b > 0.5 || themeNow() === "red" ? "#000" : "#fff");

/** Their texts, and what meshes are, from a zoom on, where reports and robots have left room for them. */
export function writeMarkers(labels, view, markers) {
  for (const { type, position, color, scale, text, mesh } of markers) {
    if (type === MESH && view.scale >= NAMED_FROM) labels.write(clip(mesh, LONGEST), ...view.toPixel(position), { colour: labels.colours.soft });
    const height = scale.z * view.scale;
    if (type !== TEXT || height < WRITTEN_FROM * labels.size) continue;
    const size = Math.min(48, Math.max(labels.size, height));
    const colours = color.a ? { colour: css({ ...color, a: 1 }), rim: rimOf(color) } : { colour: labels.colours.soft };
    labels.write(clip(text, LONGEST), ...view.toPixel(position), { ...colours, size });
  }
}
