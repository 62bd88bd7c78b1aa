// Is each robot's map arriving? Its panel, and the Command Post's answers.
import { badge, list, make, mark, say, set } from "./dom.js";
import { kindOf } from "./arriving.js";
import { area, coveredIn } from "./covered.js";
import { sampleAges } from "./robot_ages.js";
import { lookOf } from "./robot_colour.js";
import { RobotRows } from "./robot_rows.js";
import { figureWords, robotsOf } from "./robot_state.js";
import { showVerdict } from "./verdict.js";
import { clip } from "./words.js";

const panel = document.getElementById("maps");
const rows = new RobotRows(panel, document.getElementById("robots"));
const shared = document.getElementById("shared");

const SHARED = { grid: "Merged", cloud: "Merged cloud", markers: "Markers", covered: "Covered" };
const COVERED = "The area of the known cells of grids at the Command Post. What several robots cover counts once.";

/** What is all robots': how old it is, and a word where it is not as it should be. */
function showShared(all) {
  list(shared, all, ({ kind }) => kind, () => make("span", make("span.name"), " ", make("span.badge")), (node, state) => {
    mark(node, "level", state.level);
    say(node.firstChild, SHARED[state.kind] ?? state.kind);
    const isWell = state.level === "good" || state.level === "quiet";
    badge(node.lastChild, state.level, isWell ? state.text ?? figureWords(state) : state.word);
    set(node, { title: state.title });
  });
}

/** What the Command Post said to what was sent. */
function showSayings(activities) {
  const place = document.getElementById("sayings");
  if (!place) return; // the display has none
  const said = activities.filter((row) => row.last_sentence);
  list(place, said, (row) => `${row.kind} ${row.robot}`,
    () => make("li", make("strong"), " ", make("span")),
    (node, row) => {
      say(node.children[0], row.kind === "markers" ? "Markers:" : `${clip(row.robot || "Merged map", 40)} ${kindOf(row)}:`);
      say(node.children[1], clip(row.last_status ? `${row.last_status} ${row.last_sentence}` : row.last_sentence));
    });
}

/** Nothing of a grid that the box is drawing. */
function coveredWords({ name, kinds }, { of, whole }) {
  if (of.has(name)) return `covers ${area(of.get(name), whole)}`;
  return kinds.some(({ kind }) => kind === "grid") ? "" : "no grid";
}

/** Gives how the robots stand, as robotsOf(). */
export function showRobots(view, now, lost) {
  const isAway = view.endpoints.find(({ name }) => name === "mapping").level === "bad";
  const covered = lost ? null : coveredIn(view), state = robotsOf(view, now - view.now, lost);
  if (covered) for (const robot of state.robots) robot.covered = coveredWords(robot, covered);
  for (const { name } of [...view.robots, ...view.standings]) lookOf(name); // in the order of the view; rows are sorted later
  showVerdict(view, now, lost);
  if (!lost) sampleAges(state.robots, now);
  mark(panel, "away", String(lost || isAway));
  set(panel.querySelector(".empty"), { hidden: state.robots.length > 0 });
  rows.show(state.robots, now);
  showShared(covered?.robots.length ? [...state.shared, { kind: "covered", level: "quiet", text: area(covered.square_metres, covered.whole), title: COVERED }] : state.shared);
  showSayings(view.activities);
  return state;
}
