// What the Command Post would not take: rejected until the operator sends it again or discards it.
import { barred } from "./actions.js";
import { giveFocus, list, make, say, set } from "./dom.js";
import { post } from "./session.js";
import { ago, clip } from "./words.js";

const block = document.getElementById("rejected");
const said = block.querySelector(".said");
const READ = 10_000; // ms: a last word without a row below it is read by then
const underWay = new Set();
let saidAt = -Infinity;

function tell(words) {
  saidAt = performance.now();
  say(said, words);
}

async function judge(row, word) {
  if (underWay.has(row.number) || barred()) return;
  underWay.add(row.number);
  try {
    await post(`/adit/rejected/${row.number}/${word}`);
    tell(word === "send" ? `${row.number} is queued again.` : `${row.number} is discarded.`);
  } catch (error) {
    tell(clip(error.message));
  } finally {
    underWay.delete(row.number);
  }
}

function create({ number }) {
  const send = make("button.send"), discard = make("button.discard");
  say(send, "Send again");
  say(discard, "Discard");
  for (const button of [send, discard]) button.setAttribute("aria-label", `${button.textContent}: ${number}`);
  for (const button of [send, discard]) button.type = "button";
  return make("li", make("span.what"), make("span.since"), make("span.why"), send, discard);
}

function update(node, row, now) {
  const [what, since, why, send, discard] = node.children;
  const kilobytes = Math.max(1, Math.round(row.bytes / 1000));
  say(what, `${row.number}: ${row.kind} of ${row.robot ? clip(row.robot, 40) : "all"}, ${kilobytes} kB`);
  say(since, ago(now - row.at));
  say(why, row.replaced ? "A newer message that contains it was sent." : `${row.status ? `${row.status}: ` : ""}${clip(row.why)}`);
  if (row.replaced && send === document.activeElement) giveFocus(discard);
  // Not while it is under way: what is disabled loses the focus.
  discard.disabled = Boolean(barred());
  send.disabled = discard.disabled || row.replaced;
  send.onclick = () => judge(row, "send");
  discard.onclick = () => judge(row, "discard");
}

export function showRejected(rows, now) {
  const waiting = rows.filter(({ replaced }) => !replaced).length; // adit_rejected_messages counts the same
  if (!rows.length && performance.now() - saidAt > READ) say(said, "");
  set(block, { hidden: !rows.length && !said.textContent });
  set(block.querySelector("h4"), { hidden: !rows.length });
  say(block.querySelector(".count"), waiting ? String(waiting) : "");
  list(block.querySelector(".rows"), rows, (row) => row.number, create, (node, row) => update(node, row, now));
}
