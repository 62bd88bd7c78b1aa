// Is my map arriving? One row a robot, one cell a kind of data: its verdict, how old the last forwarded is.
import { badge, list, make, mark, say } from "./dom.js";
import { arrival, kindOf, overall, robotOf } from "./verdict.js";
import { age, bytes } from "./words.js";

const COLUMNS = ["grid", "cloud", "state", "markers"];

function byRobot(activities) {
  const robots = new Map();
  for (const row of activities) {
    const name = robotOf(row);
    if (!robots.has(name)) robots.set(name, { name, rows: {} });
    robots.get(name).rows[row.kind] = row;
  }
  // What is not one robot's own stands last.
  const common = (robot) => Object.values(robot.rows).every((row) => row.robot === "");
  return [...robots.values()].sort((a, b) => common(a) - common(b) || a.name.localeCompare(b.name, "en", { numeric: true }));
}

function details(row) {
  const parts = [`${row.forwarded} of ${row.accepted}`];
  if (row.replaced) parts.push(`${row.replaced} replaced`);
  if (row.merged) parts.push(`${row.merged} merged`);
  if (row.waiting && row.kind !== "state") parts.push(`${row.waiting} waiting`);
  if (row.bytes_sent) parts.push(bytes(row.bytes_sent));
  return parts.join(" · ");
}

function createRobot() {
  const name = make("th");
  name.scope = "row";
  return make("tr", name, ...COLUMNS.map(() => make("td", make("span.badge"), make("span.age"), make("span.details"))));
}

function updateRobot(node, robot, now, lost) {
  const [name, ...cells] = node.children;
  say(name, robot.name);
  COLUMNS.forEach((kind, i) => {
    const row = robot.rows[kind];
    mark(cells[i], "empty", String(!row));
    if (!row) return;
    const { level, word } = lost ? { level: "quiet", word: "unknown" } : arrival(row, now);
    mark(cells[i], "level", level);
    const [verdict, since, more] = cells[i].children;
    badge(verdict, level, word);
    say(since, row.last_forwarded === null ? "never" : age(now - row.last_forwarded));
    say(more, details(row));
  });
}

export function showRobots(activities, now, lost) {
  const { level, word } = lost ? { level: "bad", word: "Unknown: the box does not answer" } : overall(activities, now);
  badge(document.getElementById("verdict"), level, word);

  const table = document.getElementById("robots");
  table.hidden = activities.length === 0;
  list(table.tBodies[0], byRobot(activities), (robot) => robot.name, createRobot, (node, robot) =>
    updateRobot(node, robot, now, lost));

  const said = activities.filter((row) => row.last_sentence);
  list(document.getElementById("sayings"), said, (row) => `${row.kind} ${row.robot}`,
    () => make("li", make("strong"), " ", make("span")),
    (node, row) => {
      say(node.children[0], `${robotOf(row)} ${kindOf(row)}:`);
      say(node.children[1], row.last_status ? `${row.last_status} ${row.last_sentence}` : row.last_sentence);
    });
}
