// What the operator may do with the run and the box: say that a new run begins, make the lights flash.
import { barred } from "./actions.js";
import { confirmed } from "./dialog.js";
import { say } from "./dom.js";
import { post } from "./session.js";

const SECONDS = 10;
const newRun = document.querySelector("button.newrun"), outcome = document.querySelector("#more .outcome");
const identify = document.querySelector("button.identify"), identified = document.getElementById("identified");
let view = null, busy = false;

const named = (reports) => reports.map(({ number }) => `#${number}`).join(", ");

/** What will happen, in sentences. */
function consequences({ reports, run_number }) {
  const ofRun = reports.filter(({ run }) => run === run_number);
  const waiting = ofRun.filter(({ state }) => state === "queued");
  const doubts = ofRun.filter(({ state }) => state === "in_doubt" || state === "sending");
  return [
    `Run ${run_number} ends, and a new one begins.`,
    waiting.length
      ? `Queued reports are held until you send them: ${named(waiting)}. Reports posted in the last 10 s are sent in the new run.`
      : "No report is queued.",
    doubts.length ? `Reports in flight or in doubt stay for you to decide: ${named(doubts)}.` : "",
    "Map, tracks and markers begin blank. The box notices most new runs by itself. Use this if it did not.",
  ].filter(Boolean).join(" ");
}

async function begin() {
  if (busy || !view || barred()) return;
  const sure = await confirmed({ title: "Begin a new run?", text: consequences(view), word: "New run" });
  if (!sure) return;
  busy = true;
  say(outcome, "");
  try {
    const { run } = await post("/adit/runs");
    say(outcome, `Run ${run} began.`);
  } catch (error) {
    say(outcome, error.message);
  } finally {
    busy = false;
  }
}
newRun.addEventListener("click", begin);

identify.addEventListener("click", async () => {
  say(identified, "");
  await post("/adit/identify", { seconds: SECONDS }).catch((error) => say(identified, error.message));
});

export function showBoxActions(next, now) {
  view = next;
  const left = Math.ceil(view.identify_until - now); // null is long ago
  say(identify, left > 0 ? `Flashing, ${left} s` : "Identify");
  identify.disabled = Boolean(barred());
  newRun.disabled = busy || identify.disabled;
}
