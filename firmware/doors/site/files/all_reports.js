// Every report: an event has the newest 200, those with which something is still to happen first. The others are asked for once, and
// then each that changes.
import { isOpen } from "./arriving.js";
import { get } from "./session.js";

const IN_EVENT = 200;
const RETRY = 5000, EVERY = 60_000; // ms

const known = new Map(); // by number
let last = null, newest = new Set(); // of the last event: its reports, and their numbers
let all = null; // that the page shows; null: not listed yet
let isWhole = false; // all reports are up to date: each later change came in an event
let asked = -Infinity;

const sameClock = (one, other) => Math.abs(one.received - other.received) < 1;

/** What an event has is newer, and so may be what was heard meanwhile, unless the box's clock was set. */
function learn(row) {
  const was = known.get(row.number), isLater = was && was.changed > row.changed && sameClock(was, row);
  if (newest.has(row.number) || isLater) return;
  known.set(row.number, row);
  all = null;
}

async function learnAll() {
  asked = performance.now();
  isWhole = true; // events bring all later changes
  try {
    for (const row of await get("/adit/reports")) learn(row);
  } catch {
    isWhole = false;
  }
}

/** What became of one that events do not have any more. */
const learnOne = (number) => get(`/adit/reports/${number}`).then(learn, () => (isWhole = false));

/** Call it after a change of report `number`: events may not have it. */
export const learnChange = (number) => (newest.has(number) ? undefined : learnOne(number));

function hear(reports) {
  const before = newest;
  last = reports;
  all = null;
  newest = new Set(reports.map(({ number }) => number));
  for (const row of reports) {
    const was = known.get(row.number);
    if (was && !sameClock(was, row)) isWhole = false; // all times are others
    known.set(row.number, row);
  }
  if (reports.length >= IN_EVENT) for (const number of before) if (!newest.has(number) && isOpen(known.get(number))) learnOne(number);
  if (reports.length < IN_EVENT && known.size > reports.length) known.clear();
}

/** The reports of an event and those that are older than its, newest first; the same list if none changed. `lost`: the box does not
 *  answer, so that changes go by. */
export function allReports({ reports }, lost) {
  if (reports !== last) hear(reports);
  if (lost) isWhole = false;
  if (reports.length < IN_EVENT) return reports;
  const retry = isWhole ? Infinity : RETRY;
  const wait = reports.every(isOpen) ? EVERY : retry; // of more than 200 open ones events have not all
  if (!lost && performance.now() - asked > wait) learnAll();
  return (all ??= [...reports, ...[...known.values()].filter(({ number }) => !newest.has(number)).sort((a, b) => b.number - a.number)]);
}
