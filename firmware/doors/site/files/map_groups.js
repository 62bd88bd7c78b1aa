// Reports that lie on each other at this zoom: one sign with their number stands for them.
import { life } from "./arriving.js";
import { grouped } from "./grouped.js";

const FEWEST = 3; // of a group: two can be seen apart, and may be duplicates
const WORST = ["bad", "wait", "good", "quiet"];

/** {singles: reports, groups: [{position, count, level}]}; a group is of one square with sides of `metres` and has its worst level. Reports
 *  for the operator, and those of which `isNamed(report)`, are single. */
export function groupReports(reports, metres, isNamed) {
  const isSingle = (report) => life(report).level === "ask" || isNamed(report);
  const squares = grouped(reports, (report) => (isSingle(report) ? report : ["x", "y"].map((axis) => Math.floor(report.position[axis] / metres)).join()));
  const singles = [], groups = [];
  for (const its of squares.values()) {
    if (its.length < FEWEST) {
      singles.push(...its);
      continue;
    }
    const mean = (axis) => its.reduce((sum, { position }) => sum + position[axis], 0) / its.length;
    const levels = its.map((report) => life(report).level);
    groups.push({ position: { x: mean("x"), y: mean("y") }, count: its.length, level: WORST.find((level) => levels.includes(level)) });
  }
  return { singles: singles.sort((a, b) => b.number - a.number), groups };
}
