// The height of a place that was tapped on the map, from the robots' tracks. A report with a wrong height is used up for nothing.
import { ago, clip, metres } from "./words.js";

/** Metres, horizontally: tracks farther away do not tell the height of a place. */
export const REACH = 5;
const SURE = 2; // m, horizontally: a height from farther away is to be checked
const LEVEL = 2; // m: heights that differ by more are of two levels

/** A height at a place: {z, robot, apart, at}; `apart`: horizontal metres to the pose of `robot` at the time `at`.
 *  Gives one for each level near `place` ({x, y}), the nearest first; an empty list if no pose is within REACH.
 *  `tracks`: [{name, poses: [[at, x, y, z, heading]]}], in metres and in seconds since 1970. */
export function heightsAt(place, tracks) {
  const near = tracks.flatMap(({ name, poses }) => poses
    .map(([at, x, y, z]) => ({ z, robot: name, apart: Math.hypot(x - place.x, y - place.y), at }))
    .filter(({ apart }) => apart <= REACH));
  near.sort((a, b) => a.apart - b.apart || b.at - a.at);
  const levels = [];
  for (const height of near) {
    if (levels.every(({ z }) => Math.abs(z - height.z) > LEVEL)) levels.push(height);
  }
  return levels;
}

/** "z 1.2 m from r6’s track, 3.0 m away, 40 s ago". `now`: the box's time. */
export const heightWords = ({ z, robot, apart, at }, now) =>
  `z ${metres(z)} m from ${clip(robot, 40)}’s track, ${apart.toFixed(1)} m away, ${ago(now - at)}`;

/** How the height of a report was found: {key, level, text}. `height`: as of heightsAt(); null: the operator typed it. */
export function heightNote(height, now) {
  if (!height) return { key: "height", level: "quiet", text: "z typed." };
  const isSure = height.apart <= SURE;
  return { key: "height", level: isSure ? "good" : "wait", text: `${heightWords(height, now)}${isSure ? "." : ": check it."}` };
}
