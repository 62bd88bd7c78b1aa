// The operator says that a new run begins, where the box did not notice it by itself.
import { barred } from "./deeds.js";
import { confirmed } from "./dialog.js";
import { say } from "./dom.js";
import { post } from "./session.js";

const button = document.querySelector("#run .newrun");
const outcome = document.querySelector("#run .outcome");
let view = null, busy = false;

const named = (reports) => {
  const names = reports.slice(0, 8).map(({ number }) => `#${number}`).join(", ");
  return reports.length > 8 ? `${names} and ${reports.length - 8} more` : names;
};

/** What will happen, in sentences. */
function consequences({ reports, run_number }) {
  const waiting = reports.filter(({ state }) => state === "waiting");
  const doubts = reports.filter(({ state }) => state === "in doubt" || state === "sending");
  return [
    `Run ${run_number} ends, and run ${run_number + 1} begins.`,
    waiting.length
      ? `What waits is held, and goes only when you send it: ${named(waiting)}. Only what was posted in the last 10 s goes on into the new run.`
      : "No report waits to be sent.",
    doubts.length ? `What is under way or in doubt stays for you to judge: ${named(doubts)}.` : "",
    "Map, tracks and markers begin blank. The box notices most new runs by itself: this is for those it cannot.",
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
button.addEventListener("click", begin);

export function showNewRun(next) {
  view = next;
  button.disabled = busy || Boolean(barred());
}
