// How each robot stands: from what the box tells of each kind of data that it sends.
import { arrival, kindOf, robotOf } from "./arriving.js";
import { grouped } from "./grouped.js";
import { age, bytes, clock } from "./words.js";

const KINDS = ["grid", "cloud", "state"];
const WORST = ["bad", "wait", "good", "quiet"];

/** How old a map is: "9 s", "1:34", "1:05 h". */
export const mapAge = (seconds) => (seconds === null ? "never" : seconds >= 60 && seconds < 3600 ? clock(seconds) : age(seconds));

/** All that was counted, for who wants to know. */
function counts(row) {
  const parts = [`${row.accepted} accepted`, `${row.forwarded} forwarded`];
  if (row.queued && row.kind !== "state") parts.unshift(`${row.queued} queued`);
  for (const what of ["replaced", "merged", "throttled", "failed"]) if (row[what]) parts.push(`${row[what]} ${what}`);
  if (row.clouds) parts.push(`treated as ${row.clouds}`);
  if (row.precision && row.precision !== "exact") parts.push(`rounded to ${row.precision}`);
  if (row.points_left_out) parts.push(`${row.points_left_out} points left out`);
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

/** One kind of data: {kind, level, word, age (seconds; null: never), details, title}. `since`: seconds since the box said so;
 *  `lost`: it does not answer, so nothing is known. */
export function stateOf(row, since, lost) {
  const known = lost ? { level: "quiet", word: "unknown" } : arrival(row);
  return { kind: kindOf(row), ...known, age: row.age === null ? null : row.age + since, details: details(row), title: `${kindOf(row)}: ${counts(row)}` };
}

/** A robot's map at the Command Post: as old as the older of its kinds; one that it stopped to send does not count beside another. null: none arrived. */
function oldest(kinds) {
  const maps = kinds.filter(({ kind }) => kind !== "pose"), live = maps.filter(({ level }) => level !== "quiet");
  const ages = (live.length ? live : maps).map(({ age }) => age);
  if (ages.length === 0 || ages.includes(null)) return null;
  return live.length ? Math.max(...ages) : Math.min(...ages);
}

function robotState(name, rows, since, lost) {
  const kinds = KINDS.flatMap((kind) => rows.filter((row) => row.kind === kind)).map((row) => stateOf(row, since, lost));
  const worst = WORST.map((level) => kinds.find((kind) => kind.level === level)).find(Boolean);
  const isSilent = !lost && rows.some((row) => row.arrival === "silent");
  const hasMap = kinds.some(({ kind }) => kind !== "pose");
  return { name, level: worst.level, word: worst.word, isSilent, age: hasMap ? oldest(kinds) : kinds[0].age, hasMap, kinds };
}

/** {robots: each with {name, level, word, isSilent, age, hasMap, kinds}, shared: the merged map and the markers, as stateOf(), with a name}. */
export function robotsOf(activities, since, lost) {
  const rows = activities.filter(({ kind }) => KINDS.includes(kind));
  const byName = grouped(rows.filter(({ robot }) => robot), robotOf);
  const shared = rows.filter(({ robot }) => !robot).map((row) => ({ name: row.kind === "grid" ? "Merged" : `Merged ${kindOf(row)}`, ...stateOf(row, since, lost) }));
  for (const row of activities) if (row.kind === "markers") shared.push({ name: "Markers", ...stateOf(row, since, lost) });
  return { robots: [...byName].map(([name, its]) => robotState(name, its, since, lost)), shared };
}
