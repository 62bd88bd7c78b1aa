// Robots as rows, worst first. Nothing moves under a pointer or the focus: what changes in the order waits until it is left.
import { attribute, badge, list, make, mark, say, set } from "./dom.js";
import { BOX, pathOf, worstAge } from "./robot_ages.js";
import { tint } from "./robot_colour.js";
import { mapAge } from "./robot_state.js";
import { clip } from "./words.js";

const SVG = "http://www.w3.org/2000/svg";
const RANK = { bad: 0, wait: 1 };
const PATIENCE = 5; // s: ages alone change the order no more often

const rank = ({ level }) => RANK[level] ?? 2;
/** By which rows are sorted, and which they show: seconds. */
const ageOf = (robot) => (rank(robot) < 2 ? robot.age ?? Infinity : Math.max(robot.age ?? 0, worstAge(robot.name)));

function createRow({ name }) {
  const spark = document.createElementNS(SVG, "svg");
  for (const [key, value] of Object.entries({ viewBox: BOX, preserveAspectRatio: "none", "aria-hidden": "true" })) spark.setAttribute(key, value);
  spark.append(document.createElementNS(SVG, "path"));
  const row = make("li", make("span.bar"), make("strong.name", clip(name, 40)), " ", make("span.kinds"), " ", spark, make("span.badge.age"));
  tint(row, name);
  return row;
}

/** "grid 6 s", or what is wrong with it. */
const kindWords = ({ kind, level, word, age }) => `${kind} ${level === "good" || level === "quiet" ? mapAge(age) : word}`;

function words({ silent, kinds, covered }, isFull) {
  const shown = isFull ? kinds : kinds.filter(({ kind, level }) => kind !== "pose" || level === "bad" || level === "wait");
  const isAllOne = !isFull && !silent && shown.length > 1 && shown.every(({ level, word }) => level === "bad" && word === shown[0].word);
  if (isAllOne) return shown[0].word; // "not arriving", of grid and cloud: there may be room for no more
  const texts = shown.map((kind) => (isFull && kind.details ? `${kindWords(kind)}, ${kind.details}` : kindWords(kind)));
  return [...(silent ? ["silent"] : []), ...texts, ...(isFull && covered ? [covered] : [])].join(" · ");
}

/** Of its map, or if it is silent of its data; a silent robot that was not heard since a start of the box has none that is known. */
function ageWords(robot) {
  const { has_map, silent, kinds, age } = robot, isUnheard = kinds.length === 0;
  if (age === null && (silent || isUnheard)) return "unknown";
  return has_map || silent || isUnheard ? mapAge(age === null ? null : ageOf(robot)) : "no map";
}

function updateRow(row, robot, isFull) {
  const [, , kinds, spark, age] = row.children;
  mark(row, "level", robot.level);
  badge(age, robot.level, ageWords(robot));
  say(kinds, words(robot, isFull));
  set(row, { title: [`${robot.name}: ${robot.word}`, ...robot.kinds.map(({ title }) => title)].join("\n") });
  attribute(spark.firstChild, "d", pathOf(robot.name));
}

/** The rows within `panel`, a list `ul`. `isFull`: with all that is known of each kind. */
export class RobotRows {
  #panel;
  #rows;
  #isFull;
  #isOver = false;
  #order = [];
  #ranks = "";
  #ordered = -Infinity;

  constructor(panel, rows, isFull = false) {
    [this.#panel, this.#rows, this.#isFull] = [panel, rows, isFull];
    panel.addEventListener("pointerenter", () => (this.#isOver = true));
    panel.addEventListener("pointerleave", () => (this.#isOver = false)); // a finger leaves as it is lifted
  }

  #isHeld = () => this.#isOver || Boolean(this.#panel.querySelector(":focus-visible")) || this.#panel.matches(":focus-visible");

  #inOrder(robots, now) {
    const place = new Map(this.#order.map((name, i) => [name, i]));
    const asBefore = (a, b) => (place.get(a.name) ?? Infinity) - (place.get(b.name) ?? Infinity) || 0;
    const byName = (a, b) => a.name.localeCompare(b.name, "en", { numeric: true });
    const byWorst = (a, b) => rank(a) - rank(b) || Math.floor(ageOf(b)) - Math.floor(ageOf(a)) || byName(a, b);
    const ranks = robots.map((robot) => robot.name + rank(robot)).sort().join();
    const isDue = ranks !== this.#ranks || Math.abs(now - this.#ordered) >= PATIENCE;
    if (this.#isHeld() || !isDue) return [...robots].sort((a, b) => asBefore(a, b) || byName(a, b));
    [this.#ranks, this.#ordered] = [ranks, now];
    return [...robots].sort(byWorst);
  }

  show(robots, now) {
    const ordered = this.#inOrder(robots, now);
    this.#order = ordered.map(({ name }) => name);
    this.#rows.style.setProperty("--half", Math.max(1, Math.ceil(ordered.length / 2)));
    list(this.#rows, ordered, ({ name }) => name, createRow, (row, robot) => updateRow(row, robot, this.#isFull));
  }
}
