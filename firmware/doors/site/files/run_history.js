// The box's history of this run (README.md: GET /adit/history): plots, ages and alarms from before this page was opened. Requested
// at once, and later only the newer part.
import { fillAges } from "./robot_ages.js";
import { fillLink } from "./link.js";
import { fetchSoon } from "./session.js";
import { Steps } from "./steps.js";

const EVERY = 20; // s
const AGAIN = 5; // s: where the box did not answer

let run = null, due = 0, asked = false, last = 0;
let alarms = [];
const steps = new Steps();

/** [{at, level}]: when something came that needed the operator. */
export const alarmTicks = () => alarms;

function take(history, time, isFirst) {
  const { at, attention } = history;
  alarms = [...alarms, ...attention.filter(({ came }) => came).map(({ at }) => ({ at, level: "bad" }))];
  last = Math.max(last, at.at(-1) ?? 0, attention.at(-1)?.at ?? 0);
  if (!isFirst) return;
  fillLink(history, time);
  fillAges(history, time);
}

/** With each view of the run. */
export async function followHistory({ run_number, now }, time) {
  if (steps.seen(now) || run_number !== run) [run, due, last, alarms] = [run_number, 0, 0, []];
  if (asked || time < due) return;
  asked = true;
  try {
    const answer = await fetchSoon(`/adit/history?since=${last}`);
    if (!answer.ok) throw new Error();
    const history = await answer.json();
    if (run_number === run) take(history, time, last === 0);
    due = time + EVERY;
  } catch {
    due = time + AGAIN;
  } finally {
    asked = false;
  }
}
