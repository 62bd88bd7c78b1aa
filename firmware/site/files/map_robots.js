// Robots on the map: each in its colour, and in the shape of its kind.
import { kindOf, robotColour } from "./robot_colour.js";
import { clip } from "./words.js";

const STALE = 10; // s without a newer pose
export const isStale = ({ age }) => age === null || age > STALE; // null: of before a start of the box
const REACH = 22; // pixels, at least: as a finger needs

const ARROW = [[1.5, 0], [-1, 0.95], [-0.5, 0], [-1, -0.95]];
const NOTCHED = [[1.5, 0], [0.1, 0.75], [0.1, 0.4], [-1, 0.95], [-0.45, 0], [-1, -0.95], [0.1, -0.4], [0.1, -0.75]];

function trace(paint, points, size) {
  paint.beginPath();
  for (const [x, y] of points) paint.lineTo(x * size, y * size);
  paint.closePath();
}

/** An arrow; notched: it walks; in a ring: it flies. Only an outline: nothing was heard of it for a while. */
function drawRobot(paint, colours, view, robot, size, isOld, colour) {
  const kind = kindOf(robot.name);
  paint.save();
  paint.translate(...view.toPixel(robot.position));
  paint.rotate(-robot.heading);
  paint.lineJoin = "round";
  if (kind === "flying") {
    paint.beginPath();
    paint.arc(0, 0, size * 1.5, 0, 2 * Math.PI);
    for (const [width, stroke] of [[0.5, colours.ground], [0.22, colour]]) {
      Object.assign(paint, { lineWidth: size * width, strokeStyle: stroke });
      paint.stroke();
    }
  }
  trace(paint, kind === "legged" ? NOTCHED : ARROW, kind === "flying" ? size * 0.8 : size);
  Object.assign(paint, { lineWidth: size * 0.7, strokeStyle: colours.ground, fillStyle: colour });
  paint.stroke();
  Object.assign(paint, { lineWidth: size * 0.25, strokeStyle: colour });
  if (isOld) paint.stroke();
  else paint.fill();
  paint.restore();
}

/** A ring around the one that is followed. */
function drawFollowed(paint, colours, view, robot, size) {
  paint.beginPath();
  paint.arc(...view.toPixel(robot.position), size * 2.1, 0, 2 * Math.PI);
  for (const [width, colour] of [[5, colours.ground], [2, colours.lamp]]) {
    Object.assign(paint, { lineWidth: width, strokeStyle: colour });
    paint.stroke();
  }
}

export function drawRobots(paint, colours, view, robots, size, followed) {
  for (const robot of robots) {
    const isOld = isStale(robot);
    if (robot.name === followed) drawFollowed(paint, colours, view, robot, size);
    drawRobot(paint, colours, view, robot, size, isOld, isOld ? colours.soft : robotColour(robot.name));
  }
}

/** Before any name is written: a robot is not written upon. */
export function keepOffRobots(labels, view, robots, size) {
  for (const robot of robots) labels.keepOff(view.toPixel(robot.position), size * 0.9);
}

/** `ill`: the names of those whose map does not come; theirs are written first. */
export function nameRobots(labels, view, robots, size, ill) {
  const first = (robot) => (ill.has(robot.name) ? 0 : 1);
  for (const robot of [...robots].sort((a, b) => first(a) - first(b))) {
    const colour = ill.has(robot.name) ? labels.colours.bad : isStale(robot) ? labels.colours.soft : labels.colours.ink;
    labels.write(clip(robot.name, 20), ...view.toPixel(robot.position), { colour, away: size * 1.9 });
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
