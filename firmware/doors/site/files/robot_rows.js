// Robots as rows, worst first. Nothing moves under a pointer or the focus: what changes in the order waits until it is left.
import { attribute, badge, draw, list, make, mark, say, set } from "./dom.js";
import { BOX, pathOf } from "./robot_ages.js";
import { tint } from "./robot_colour.js";
import { figureOf, figureWords } from "./robot_state.js";
import { ago, byName, clip } from "./words.js";

const RANK = { bad: 0, wait: 1 };
const PATIENCE = 5; // s: ages alone change the order no more often

const rank = ({ level }) => RANK[level] ?? 2;
/** By which rows are sorted, and which they show: seconds. */
const sortedBy = (robot) => figureOf(robot) ?? Infinity;

function createRow({ name }) {
  const spark = draw(BOX, { preserveAspectRatio: "none" }, {});
  const row = make("li", make("span.bar"), make("strong.name", clip(name, 40)), " ", make("span.kinds"), " ", spark, make("span.badge.age"));
  tint(row, name);
  return row;
}

/** "grid 6 s", or what is wrong with it. */
const kindWords = (kind) => `${kind.kind} ${kind.level === "good" ? figureWords(kind) : kind.word}`;

function words({ silent, kinds, covered, heard }, isFull) {
  const told = kinds.filter(({ word }) => !silent || word !== "silent");
  const shown = isFull ? told : told.filter(({ kind, level }) => kind !== "pose" || level === "bad" || level === "wait");
  const isAllOne = !silent && shown.length > 1 && shown.every(({ level, word }) => level !== "good" && word === shown[0].word);
  const kindText = (kind) => [isAllOne ? kind.kind : kindWords(kind), isFull && kind.details].filter(Boolean).join(isAllOne ? " " : ", ");
  const texts = isAllOne // "not arriving" once, for grid and cloud
    ? [shown[0].word, ...shown.filter(({ details }) => isFull && details).map(kindText)]
    : shown.map(kindText);
  const last = isFull && !silent && heard !== null ? [`heard ${ago(heard)}`] : [];
  return [...(silent ? ["silent"] : []), ...texts, ...last, ...(isFull && covered ? [covered] : [])].join(" · ");
}

/** Of its map, or if it is silent since its last message. */
const ageWords = (robot) => (robot.has_map || robot.silent ? figureWords(robot) : "no map");

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
    const byWorst = (a, b) => rank(a) - rank(b) || Math.floor(sortedBy(b)) - Math.floor(sortedBy(a)) || byName(a.name, b.name);
    const ranks = robots.map((robot) => robot.name + rank(robot)).sort().join();
    const isDue = ranks !== this.#ranks || Math.abs(now - this.#ordered) >= PATIENCE;
    if (this.#isHeld() || !isDue) return [...robots].sort((a, b) => asBefore(a, b) || byName(a.name, b.name));
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
