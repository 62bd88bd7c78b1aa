// Reports on the map: a picture of the artifact, in the colour of its state, with the state's shape beside it. A line joins near
// duplicates.
import { life } from "./arriving.js";
import { iconPath } from "./artifact_icons.js";
import { nearPairs } from "./near.js";
import { clip } from "./words.js";

const LABELS_FROM = 2; // pixels per metre
const PICTURES_FROM = 0.7; // pixels per metre: below it only shapes can be recognised
const NEWEST = 6; // are named before the others

function path(ctx, points, left, top, size) {
  ctx.beginPath();
  for (const [x, y] of points) ctx.lineTo(left + x * size, top + y * size);
  ctx.closePath();
}

const SHAPES = {
  wait: [[0, -1], [1, 0.8], [-1, 0.8]],
  bad: [[-0.6, -1], [0, -0.4], [0.6, -1], [1, -0.6], [0.4, 0], [1, 0.6], [0.6, 1], [0, 0.4], [-0.6, 1], [-1, 0.6], [-0.4, 0], [-1, -0.6]],
  ask: [[0, -1.1], [1.1, 0], [0, 1.1], [-1.1, 0]],
};

/** The shapes of page.css, with a rim in the ground's colour that sets them off from any map. */
function drawShape(ctx, colours, level, left, top, size) {
  if (SHAPES[level]) {
    path(ctx, SHAPES[level], left, top, size);
  } else {
    ctx.beginPath();
    ctx.arc(left, top, size * 0.9, 0, 2 * Math.PI);
  }
  ctx.lineJoin = "round";
  ctx.strokeStyle = colours.ground;
  ctx.lineWidth = size * 0.7;
  ctx.stroke();
  ctx.strokeStyle = ctx.fillStyle = colours[level];
  ctx.lineWidth = size * 0.35;
  if (level === "quiet") ctx.stroke();
  else ctx.fill();
}

/** A plate framed in the colour of a level, whose shape stands at its corner; `drawWithin(side)` draws what is on it. */
function drawPlate(ctx, colours, level, [left, top], size, drawWithin) {
  const side = size * 1.25;
  ctx.beginPath();
  ctx.roundRect(left - side, top - side, 2 * side, 2 * side, side * 0.45);
  Object.assign(ctx, { fillStyle: colours.panel, strokeStyle: colours.ground, lineWidth: size * 0.6 });
  ctx.stroke();
  ctx.fill();
  Object.assign(ctx, { strokeStyle: colours[level], lineWidth: Math.max(1.5, size * 0.2) });
  ctx.stroke();
  ctx.save();
  drawWithin(side);
  ctx.restore();
  drawShape(ctx, colours, level, left + side, top - side, size * 0.45);
}

/** With the picture of what was found. */
const drawPicture = (ctx, colours, report, [left, top], size) => drawPlate(ctx, colours, life(report).level, [left, top], size, (side) => {
  ctx.translate(left - side * 0.75, top - side * 0.75);
  ctx.scale((side * 1.5) / 24, (side * 1.5) / 24);
  Object.assign(ctx, { lineWidth: 2.2, lineCap: "round", lineJoin: "round" });
  ctx.stroke(iconPath(report.type));
});

/** With the number of reports that it stands for. */
const drawGroup = (ctx, colours, { count, level }, [left, top], size) => drawPlate(ctx, colours, level, [left, top], size, (side) => {
  Object.assign(ctx, { font: `650 ${size * 1.4}px system-ui, sans-serif`, textAlign: "center", textBaseline: "middle", fillStyle: colours.ink });
  ctx.fillText(String(count), left, top, 1.8 * side);
});

/** Two reports that may be of one artifact, joined by a line. */
function drawPair(ctx, colours, labels, view, { one, other, metres: apart }) {
  const [left, top] = view.toPixel(one.position), [right, bottom] = view.toPixel(other.position);
  for (const [width, colour] of [[6, colours.ground], [3, colours.wait]]) {
    ctx.lineWidth = width;
    ctx.strokeStyle = colour;
    ctx.beginPath();
    ctx.moveTo(left, top);
    ctx.lineTo(right, bottom);
    ctx.stroke();
  }
  if (Math.hypot(left - right, top - bottom) <= 8 * labels.size) return;
  labels.write(`${apart.toFixed(1)} m`, (left + right) / 2, (top + bottom) / 2);
}

const nameOf = (report) => `#${report.number} ${clip(report.type, 20)}`;

/** Side of the square in which reports are a group, in metres. */
export const groupMetres = (view, size) => (5 * size) / view.scale;

/** `groups`: what stands for further reports: map_groups.js. */
export function drawReports(ctx, colours, labels, view, run, reports, groups, size) {
  const isPicture = view.scale >= PICTURES_FROM;
  for (const { position } of groups) labels.keepOff(view.toPixel(position), size * 1.3);
  for (const report of reports) labels.keepOff(view.toPixel(report.position), isPicture ? size * 1.3 : size * 0.8);
  for (const pair of nearPairs({ ...run, reports })) drawPair(ctx, colours, labels, view, pair);
  for (const group of groups) drawGroup(ctx, colours, group, view.toPixel(group.position), size);
  for (const report of [...reports].reverse()) {
    const place = view.toPixel(report.position);
    if (isPicture) drawPicture(ctx, colours, report, place, size);
    else drawShape(ctx, colours, life(report).level, ...place, size * 0.9);
  }
}

/** Those that wait for a word and the newest first; `named`: those whose names stand there already. */
export function nameReports(labels, view, reports, size, named) {
  const numbers = named.map(({ number }) => number);
  const rank = (report, i) => {
    if (life(report).level === "ask") return 0;
    return i < NEWEST ? 1 : 2;
  };
  const ranked = reports.map((report, i) => ({ report, rank: rank(report, i) })).sort((a, b) => a.rank - b.rank);
  for (const { report, rank: its } of ranked) {
    if (numbers.includes(report.number) || (its > 0 && view.scale < LABELS_FROM)) continue;
    labels.write(nameOf(report), ...view.toPixel(report.position), { away: size * 1.7 });
  }
}

/** Sets two reports off from all others; their names come first. */
export function drawPairRings(ctx, colours, labels, view, pair, size) {
  for (const report of pair) {
    const [left, top] = view.toPixel(report.position);
    for (const [width, colour] of [[7, colours.ground], [3, colours.ask]]) {
      ctx.lineWidth = width;
      ctx.strokeStyle = colour;
      ctx.beginPath();
      ctx.arc(left, top, size * 1.3, 0, 2 * Math.PI);
      ctx.stroke();
    }
    labels.write(nameOf(report), left - size * 2, top - size * 2);
  }
}

/** Where a report is being composed, or would be. */
export function drawCross(ctx, colours, [left, top], size) {
  for (const [line, colour] of [[7, colours.ground], [3, colours.ask]]) {
    ctx.lineWidth = line;
    ctx.strokeStyle = colour;
    ctx.beginPath();
    for (const [x, y] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      ctx.moveTo(left + x * size * 0.5, top + y * size * 0.5);
      ctx.lineTo(left + x * size * 2, top + y * size * 2);
    }
    ctx.stroke();
  }
}
