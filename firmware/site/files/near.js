// Which reports may be of one artifact, and which are the same: dispatch/same_report.hpp has the rules.

const sameType = (a, b) => a.type.toLowerCase() === b.type.toLowerCase();

export const distance = ({ position: a }, { position: b }) => Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z);

/** Those of the present run that were or may be sent. */
const counted = ({ reports, run_number }) => reports.filter((report) => report.position && report.run === run_number && report.state !== "withdrawn");

/** The one at the same place and of the same type, or undefined. */
export const sameAs = (view, report) => counted(view).find((other) => sameType(other, report) && distance(other, report) === 0);

/** [{other, metres}] of the same type and near to `report`, the nearest first. */
export function nearTo(view, report) {
  return counted(view)
    .filter((other) => other.number !== report.number && sameType(other, report))
    .map((other) => ({ other, metres: distance(other, report) }))
    .filter(({ metres }) => metres <= view.near_metres)
    .sort((a, b) => a.metres - b.metres);
}

/** Every two that are near duplicates, once: [{one, other, metres}]. */
export function nearPairs(view) {
  return counted(view).flatMap((one) =>
    nearTo(view, one).filter(({ other }) => other.number < one.number).map(({ other, metres }) => ({ one, other, metres })));
}
