// Is my map arriving? One row a robot, one cell a kind of data: how long ago it
// was last forwarded, and what that means.
import { badge, list, make, mark, say } from "./dom.js";
import { arrival, kindOf, overall, robotOf } from "./arriving.js";
import { age, bytes, clip } from "./words.js";

const COLUMNS = ["grid", "cloud", "state"];

function byRobot(activities) {
  const robots = new Map();
  for (const row of activities) {
    const name = robotOf(row);
    if (!robots.has(name)) robots.set(name, { name, rows: {} });
    robots.get(name).rows[row.kind] = row;
  }
  // The map of all robots stands last.
  const merged = (robot) => Object.values(robot.rows).every((row) => row.robot === "");
  return [...robots.values()].sort((a, b) => merged(a) - merged(b) || a.name.localeCompare(b.name, "en", { numeric: true }));
}

function details(row) {
  if (row.waiting && row.kind !== "state") return `${row.waiting} waiting`;
  return row.bytes_sent ? bytes(row.bytes_sent) : "";
}

/** All that was counted, for who wants to know. */
function counts(row) {
  const parts = [`${row.accepted} accepted`, `${row.forwarded} forwarded`];
  for (const what of ["replaced", "merged", "throttled", "failed"]) if (row[what]) parts.push(`${row[what]} ${what}`);
  if (row.clouds) parts.push(`taken as ${row.clouds}`);
  if (row.precision && row.precision !== "exact") parts.push(`rounded to ${row.precision}`);
  if (row.points_left_out) parts.push(`${row.points_left_out} points left out`);
  if (row.no_room) parts.push(`${row.no_room} refused: too much waits`);
  if (row.refused_upstream) parts.push(`${row.refused_upstream} refused by the Command Post`);
  return parts.join(", ");
}

const createCell = (what) => make(what, make("span.badge.age"), make("span.word"), make("span.details"));

function updateCell(cell, row, now, lost) {
  const { level, word } = lost ? { level: "quiet", word: "unknown" } : arrival(row, now);
  mark(cell, "level", level);
  const [since, badged, more] = cell.children;
  badge(since, level, row.last_forwarded === null ? "never" : age(now - row.last_forwarded));
  say(badged, word);
  say(more, details(row));
  cell.title = counts(row);
}

function createRobot() {
  const name = make("th");
  name.scope = "row";
  return make("tr", name, ...COLUMNS.map(() => createCell("td")));
}

function updateRobot(node, robot, now, lost) {
  const [name, ...cells] = node.children;
  say(name, clip(robot.name, 40));
  COLUMNS.forEach((kind, i) => {
    const row = robot.rows[kind];
    mark(cells[i], "empty", String(!row));
    if (row) updateCell(cells[i], row, now, lost);
  });
}

function showMarkers(row, now, lost) {
  const line = document.getElementById("markers");
  line.hidden = !row;
  if (!row) return;
  if (line.children.length === 1) line.append(createCell("span"));
  updateCell(line.children[1], row, now, lost);
}

/** The answer in one sentence. */
export function showVerdict(activities, now, lost) {
  const { level, word } = lost ? { level: "bad", word: "Unknown: the box does not answer" } : overall(activities, now);
  badge(document.getElementById("arriving"), level, clip(word, 120));
}

export function showRobots(activities, now, lost) {
  showVerdict(activities, now, lost);
  const robots = byRobot(activities.filter((row) => COLUMNS.includes(row.kind)));
  const table = document.getElementById("robots");
  table.hidden = robots.length === 0;
  list(table.tBodies[0], robots, (robot) => robot.name, createRobot, (node, robot) => updateRobot(node, robot, now, lost));
  showMarkers(activities.find((row) => row.kind === "markers"), now, lost);

  const said = activities.filter((row) => row.last_sentence);
  list(document.getElementById("sayings"), said, (row) => `${row.kind} ${row.robot}`,
    () => make("li", make("strong"), " ", make("span")),
    (node, row) => {
      say(node.children[0], row.kind === "markers" ? "Markers:" : `${clip(robotOf(row), 40)} ${kindOf(row)}:`);
      say(node.children[1], clip(row.last_status ? `${row.last_status} ${row.last_sentence}` : row.last_sentence));
    });
}
