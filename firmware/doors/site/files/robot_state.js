// How each robot stands: the box's words on it and on each kind of its data, as old as they are now.
import { kindOf } from "./arriving.js";
import { age, bytes, clock } from "./words.js";

/** How old a map is: "now", "9 s", "1:34", "1:05 h". */
export const mapAge = (seconds) => (seconds >= 60 && seconds < 3600 ? clock(seconds) : age(seconds));

/** The one figure of a robot or a kind: its age; if all is delivered, for how long it has been quiet; if it is silent, for how long. null: unknown. */
export const figureOf = ({ level, word, silent, age, heard }) =>
  (silent || word === "silent" ? heard : age ?? (level === "quiet" ? heard : word === "waiting" ? null : 0));

/** That figure, or why there is none. */
export function figureWords(state) {
  const figure = figureOf(state);
  return figure === null ? (state.word === "waiting" ? "never" : "unknown") : mapAge(figure);
}

/** All that was counted, for who wants to know. */
function counts(row) {
  const parts = [`${row.accepted} accepted`, `${row.forwarded} forwarded`];
  if (row.queued && row.kind !== "state") parts.unshift(`${row.queued} queued`);
  for (const what of ["replaced", "merged", "throttled", "failed"]) if (row[what]) parts.push(`${row[what]} ${what}`);
  if (row.clouds) parts.push(`treated as ${row.clouds}`);
  if (row.precision && row.precision !== "exact") parts.push(`rounded to ${row.precision}`);
  if (row.no_valid_point) parts.push(`${row.no_valid_point} without a valid point`);
  if (row.invisible) parts.push(`${row.invisible} invisible (alpha 0)`);
  if (row.no_room) parts.push(`${row.no_room} rejected: queue full`);
  if (row.refused_upstream) parts.push(`${row.refused_upstream} rejected by the Command Post`);
  return parts.join(", ");
}

function details(row) {
  if (row.queued && row.kind !== "state") return `${row.queued} queued`;
  if (row.invisible) return `${row.invisible} invisible`;
  return row.bytes_sent ? bytes(row.bytes_sent) : "";
}


/** As it is `since` seconds after the box said so; `lost`: the box does not answer, so nothing is known. */
const shown = ({ level, word, age, heard }, since, lost) => ({
  ...(lost ? { level: "quiet", word: "unknown" } : { level, word }),
  age: age === null ? null : age + since, heard: heard === null ? null : heard + since,
});

/** {robots: the view's standings, each with the kinds of its data; shared: the merged map and the markers}. */
export function robotsOf({ standings, activities }, since, lost) {
  const kindsOf = (name) => activities.filter(({ robot }) => robot === name).map((row) =>
    ({ kind: kindOf(row), ...shown(row, since, lost), details: details(row), title: `${kindOf(row)}: ${counts(row)}` }));
  const robots = standings.map((robot) => ({ ...robot, ...shown(robot, since, lost), silent: robot.silent && !lost, kinds: kindsOf(robot.name) }));
  return { robots, shared: kindsOf("") };
}
