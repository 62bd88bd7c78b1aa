// Which reports may be of one artifact, and which are the same: dispatch/report.hpp has the rules.

import { grouped } from "./grouped.js";

const sameType = (a, b) => a.type.toLowerCase() === b.type.toLowerCase();

export const distance = ({ position: a }, { position: b }) => Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z);

/** Whether it is of the present run, and was or may be sent. */
export const isCounted = (report, { run_number }) => report.position && report.run === run_number && report.state !== "withdrawn";
const counted = (view) => view.reports.filter((report) => isCounted(report, view));

/** The one at the same place and of the same type, or undefined. */
export const sameAs = (view, report) => counted(view)
  .find((other) => other.number !== report.number && sameType(other, report) && distance(other, report) === 0);

const ofType = (view, report) => counted(view)
  .filter((other) => other.number !== report.number && sameType(other, report))
  .map((other) => ({ other, metres: distance(other, report) }))
  .sort((a, b) => a.metres - b.metres);

/** [{other, metres}] of the same type and near to `report`, the nearest first. */
export const nearTo = (view, report) => ofType(view, report).filter(({ metres }) => metres <= view.near_metres);

/** {other, metres}: the nearest of the same type, however far; undefined: there is none. */
export const nearestOf = (view, report) => ofType(view, report)[0];

/** Every two that are near duplicates, once: [{one, other, metres}]. */
export function nearPairs(view) {
  const ofTypes = grouped(counted(view), ({ type }) => type.toLowerCase());
  return [...ofTypes.values()].flatMap((reports) => {
    const byX = reports.sort((a, b) => a.position.x - b.position.x); // so that only those close by are compared
    return byX.flatMap((report, i) => {
      const pairs = [];
      for (let j = i + 1; j < byX.length && byX[j].position.x - report.position.x <= view.near_metres; ++j) {
        const metres = distance(report, byX[j]), [other, one] = [report, byX[j]].sort((a, b) => a.number - b.number);
        if (metres <= view.near_metres) pairs.push({ one, other, metres });
      }
      return pairs;
    });
  });
}
