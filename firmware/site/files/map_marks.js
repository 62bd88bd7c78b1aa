// What is drawn over the map: robots, reports with their state by shape and colour, near duplicates, a scale.
import { nearPairs } from "./near.js";
import { life } from "./arriving.js";
import { clip, metres } from "./words.js";

const STALE = 10; // s without a newer pose
export const isStale = (robot, now) => now - robot.at > STALE;
const LABELS_FROM = 2; // pixels per metre

/** The page's colours, which differ by day. */
export function coloursOf(node) {
  const style = getComputedStyle(node);
  const names = ["ground", "ink", "soft", "good", "wait", "bad", "quiet", "ask", "lamp"];
  return Object.fromEntries(names.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
}

function path(paint, points, left, top, size) {
  paint.beginPath();
  for (const [x, y] of points) paint.lineTo(left + x * size, top + y * size);
  paint.closePath();
}

const SHAPES = {
  wait: [[0, -1], [1, 0.8], [-1, 0.8]],
  bad: [[-0.6, -1], [0, -0.4], [0.6, -1], [1, -0.6], [0.4, 0], [1, 0.6], [0.6, 1], [0, 0.4], [-0.6, 1], [-1, 0.6], [-0.4, 0], [-1, -0.6]],
  ask: [[0, -1.1], [1.1, 0], [0, 1.1], [-1.1, 0]],
};

/** The shapes of page.css, with a rim in the ground's colour that sets them off from any map. */
function drawShape(paint, colours, level, left, top, size) {
  if (SHAPES[level]) {
    path(paint, SHAPES[level], left, top, size);
  } else {
    paint.beginPath();
    paint.arc(left, top, size * 0.9, 0, 2 * Math.PI);
  }
  paint.lineJoin = "round";
  paint.strokeStyle = colours.ground;
  paint.lineWidth = size * 0.7;
  paint.stroke();
  paint.strokeStyle = paint.fillStyle = colours[level];
  paint.lineWidth = size * 0.35;
  if (level === "quiet") paint.stroke();
  else paint.fill();
}

/** Writes where nothing was written or drawn yet; those who come first win. */
class Labels {
  #taken = [];
  constructor(paint, colours, size, width) {
    Object.assign(this, { paint, colours, size, width });
  }
  /** Something is drawn at this place. */
  keepOff([left, top], size) {
    this.#taken.push([left - size, top - size, left + size, top + size]);
  }
  write(text, left, top, { colour = this.colours.ink, rim = this.colours.ground, size = this.size } = {}) {
    const { paint } = this;
    paint.font = `600 ${size}px system-ui, sans-serif`;
    const wide = paint.measureText(text).width;
    const from = left + size + wide > this.width ? left - size - wide : left + size;
    const box = [from, top - size * 0.6, from + wide, top + size * 0.6];
    if (this.#taken.some(([a, b, c, d]) => box[0] < c && box[2] > a && box[1] < d && box[3] > b)) return;
    this.#taken.push(box);
    paint.textBaseline = "middle";
    paint.lineJoin = "round";
    paint.lineWidth = size / 3;
    paint.strokeStyle = rim;
    paint.strokeText(text, box[0], top);
    paint.fillStyle = colour;
    paint.fillText(text, box[0], top);
  }
}

function drawRobot(paint, colours, labels, view, robot, size, now) {
  const [left, top] = view.toPixel(robot.position);
  const old = isStale(robot, now);
  paint.save();
  paint.translate(left, top);
  paint.rotate(-robot.heading);
  path(paint, [[1.5, 0], [-1, 0.95], [-0.5, 0], [-1, -0.95]], 0, 0, size);
  paint.lineJoin = "round";
  paint.lineWidth = size * 0.7;
  paint.strokeStyle = colours.ground;
  paint.stroke();
  paint.lineWidth = size * 0.25;
  paint.strokeStyle = paint.fillStyle = old ? colours.soft : colours.lamp;
  if (old) paint.stroke();
  else paint.fill();
  paint.restore();
  labels.write(clip(robot.name, 20), left, top, { colour: old ? colours.soft : colours.ink });
}

/** Two reports that may be of one artifact, joined by a line. */
function drawPair(paint, colours, labels, view, { one, other, metres: apart }) {
  const [left, top] = view.toPixel(one.position), [right, bottom] = view.toPixel(other.position);
  for (const [width, colour] of [[6, colours.ground], [3, colours.wait]]) {
    paint.lineWidth = width;
    paint.strokeStyle = colour;
    paint.beginPath();
    paint.moveTo(left, top);
    paint.lineTo(right, bottom);
    paint.stroke();
  }
  if (Math.hypot(left - right, top - bottom) > 8 * labels.size) labels.write(`${apart.toFixed(1)} m`, (left + right) / 2, (top + bottom) / 2);
}

const nameOf = (report) => `#${report.number} ${clip(report.type, 20)}`;

/** `named`: those whose names stand there already. */
export function drawReports(paint, colours, labels, view, run, reports, size, named) {
  for (const pair of nearPairs({ ...run, reports })) drawPair(paint, colours, labels, view, pair);
  for (const report of [...reports].reverse()) {
    const [left, top] = view.toPixel(report.position);
    drawShape(paint, colours, life(report).level, left, top, size);
    labels.keepOff([left, top], size * 0.8);
  }
  const numbers = named.map(({ number }) => number);
  for (const report of reports.filter(({ number }) => !numbers.includes(number))) {
    const isAsking = life(report).level === "ask";
    if (view.scale >= LABELS_FROM || isAsking) labels.write(nameOf(report), ...view.toPixel(report.position));
  }
}

/** Before any name is written: robots are drawn above them. */
export function keepOffRobots(labels, view, robots, size) {
  for (const robot of robots) labels.keepOff(view.toPixel(robot.position), size * 0.8);
}

export function drawRobots(paint, colours, labels, view, robots, size, now) {
  for (const robot of robots) drawRobot(paint, colours, labels, view, robot, size, now);
}

/** Sets two reports off from all others; their names come first. */
export function drawPairRings(paint, colours, labels, view, pair, size) {
  for (const report of pair) {
    const [left, top] = view.toPixel(report.position);
    for (const [width, colour] of [[7, colours.ground], [3, colours.ask]]) {
      paint.lineWidth = width;
      paint.strokeStyle = colour;
      paint.beginPath();
      paint.arc(left, top, size * 1.1, 0, 2 * Math.PI);
      paint.stroke();
    }
    labels.write(nameOf(report), left - size * 2, top - size * 2);
  }
}

export const labelsOn = (paint, colours, size, width) => new Labels(paint, colours, size, width);

/** A line of a round length in the corner. */
export function drawScale(paint, colours, labels, view, size) {
  const most = (view.width * 0.3) / view.scale;
  const power = 10 ** Math.floor(Math.log10(most));
  const length = power * ([5, 2].find((n) => n * power <= most) ?? 1);
  const left = size, top = view.height - size, width = length * view.scale;
  for (const [line, colour] of [[6, colours.ground], [2.5, colours.ink]]) {
    paint.lineWidth = line;
    paint.strokeStyle = colour;
    paint.beginPath();
    paint.moveTo(left, top);
    paint.lineTo(left + width, top);
    paint.stroke();
  }
  labels.write(`${length < 1 ? metres(length) : length} m`, left + width - size * 0.4, top);
}

/** Where a report is being composed, or would be. */
export function drawCross(paint, colours, [left, top], size) {
  for (const [line, colour] of [[7, colours.ground], [3, colours.ask]]) {
    paint.lineWidth = line;
    paint.strokeStyle = colour;
    paint.beginPath();
    for (const [x, y] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      paint.moveTo(left + x * size * 0.5, top + y * size * 0.5);
      paint.lineTo(left + x * size * 2, top + y * size * 2);
    }
    paint.stroke();
  }
}
