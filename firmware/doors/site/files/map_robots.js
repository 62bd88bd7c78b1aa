// Robots on the map: each in its colour, and in the shape of its kind.
import { kindOf, robotColour } from "./robot_colour.js";
import { age as ageWords, clip } from "./words.js";

const STALE = 10; // s without a newer pose
export const isStale = ({ age }) => age === null || age > STALE; // null: of before a start of the box
const REACH = 22; // pixels, at least: as a finger needs
const ROWS = 6; // so many lines farther than others may the name of a robot stand

const ARROW = [[1.5, 0], [-1, 0.95], [-0.5, 0], [-1, -0.95]];
const NOTCHED = [[1.5, 0], [0.1, 0.75], [0.1, 0.4], [-1, 0.95], [-0.45, 0], [-1, -0.95], [0.1, -0.4], [0.1, -0.75]];

function trace(ctx, points, size) {
  ctx.beginPath();
  for (const [x, y] of points) ctx.lineTo(x * size, y * size);
  ctx.closePath();
}

/** An arrow; notched: it walks; in a ring: it flies. Only an outline: nothing was heard of it for a while. */
function drawRobot(ctx, colours, view, robot, size, isOld, colour) {
  const kind = kindOf(robot.name);
  ctx.save();
  ctx.translate(...view.toPixel(robot.position));
  ctx.rotate(-robot.heading);
  ctx.lineJoin = "round";
  if (kind === "flying") {
    ctx.beginPath();
    ctx.arc(0, 0, size * 1.5, 0, 2 * Math.PI);
    for (const [width, stroke] of [[0.5, colours.ground], [0.22, colour]]) {
      Object.assign(ctx, { lineWidth: size * width, strokeStyle: stroke });
      ctx.stroke();
    }
  }
  trace(ctx, kind === "legged" ? NOTCHED : ARROW, kind === "flying" ? size * 0.8 : size);
  Object.assign(ctx, { lineWidth: size * 0.7, strokeStyle: colours.ground, fillStyle: colour });
  ctx.stroke();
  Object.assign(ctx, { lineWidth: size * 0.25, strokeStyle: colour });
  if (isOld) ctx.stroke();
  else ctx.fill();
  ctx.restore();
}

/** A ring around the one that is followed. */
function drawFollowed(ctx, colours, view, robot, size) {
  ctx.beginPath();
  ctx.arc(...view.toPixel(robot.position), size * 2.1, 0, 2 * Math.PI);
  for (const [width, colour] of [[5, colours.ground], [2, colours.lamp]]) {
    Object.assign(ctx, { lineWidth: width, strokeStyle: colour });
    ctx.stroke();
  }
}

export function drawRobots(ctx, colours, view, robots, size, followed) {
  for (const robot of robots) {
    const isOld = isStale(robot);
    if (robot.name === followed) drawFollowed(ctx, colours, view, robot, size);
    drawRobot(ctx, colours, view, robot, size, isOld, isOld ? colours.soft : robotColour(robot.name));
  }
}

/** Before any name is written: a robot is not written upon. */
export function keepOffRobots(labels, view, robots, size) {
  for (const robot of robots) labels.keepOff(view.toPixel(robot.position), size * 0.9);
}

/** A robot's name; of one in `silent` also how long ago its last pose came. */
export function lastSeen({ name, age }, silent) {
  if (!silent.has(name)) return clip(name, 20);
  return `${clip(name, 20)} · ${age === null ? "silent" : ageWords(age)}`;
}

/** `late`: the names of those whose map does not come; theirs are written first. */
export function nameRobots(labels, view, robots, size, late, silent) {
  const { bad, soft, ink } = labels.colours;
  const colourOf = (robot) => {
    if (late.has(robot.name)) return bad;
    return isStale(robot) ? soft : ink;
  };
  const isLate = (robot) => Number(late.has(robot.name));
  for (const robot of [...robots].sort((a, b) => isLate(b) - isLate(a))) {
    labels.write(lastSeen(robot, silent), ...view.toPixel(robot.position), { colour: colourOf(robot), away: size * 1.9, rows: ROWS });
  }
}

/** The robot under a finger, or undefined. */
export function robotAt(view, robots, place) {
  const [left, top] = view.toPixel(place);
  const near = robots.map((robot) => {
    const [x, y] = view.toPixel(robot.position);
    return { robot, apart: Math.hypot(x - left, y - top) };
  });
  const nearest = near.sort((a, b) => a.apart - b.apart)[0];
  return nearest?.apart <= REACH ? nearest.robot : undefined;
}
