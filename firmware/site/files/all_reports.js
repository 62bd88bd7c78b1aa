// Every report: an event has the newest 200, and those with which something is still to happen; the others are asked for.
import { get } from "./session.js";

const IN_EVENT = 200;
const EVERY = 60_000; // ms: what others do to an old one is known by then

const known = new Map(); // by number
let asked = -Infinity;

async function learn() {
  asked = performance.now();
  const rows = await get("/adit/reports").catch(() => ((asked = -Infinity), []));
  for (const row of rows) if (!known.has(row.number) || known.get(row.number).changed < row.changed) known.set(row.number, row);
}

/** The reports of an event and those that are older than its, newest first. */
export function allReports({ reports }) {
  for (const row of reports) known.set(row.number, row);
  if (reports.length < IN_EVENT) {
    if (known.size > reports.length) known.clear();
    return reports;
  }
  if (performance.now() - asked > EVERY) learn();
  const newest = new Set(reports.map(({ number }) => number));
  return known.size === reports.length ? reports : [...reports, ...[...known.values()].filter(({ number }) => !newest.has(number)).sort((a, b) => b.number - a.number)];
}
