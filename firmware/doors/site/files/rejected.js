// What the Command Post would not take: rejected until the operator sends it again or discards it. Several of one sender and for one
// reason are one row, with the single ones behind it.
import { barred } from "./actions.js";
import { confirmed } from "./dialog.js";
import { attribute, giveFocus, list, make, mark, say, set } from "./dom.js";
import { grouped } from "./grouped.js";
import { post } from "./session.js";
import { ago, bytes, clip } from "./words.js";

const block = document.getElementById("rejected");
const said = block.querySelector(".said");
const READ = 10_000; // ms: a last word without a row below it is read by then
const underWay = new Set(), opened = new Set(); // numbers; keys of groups
let isDiscarding = false, saidAt = -Infinity;

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

/** Asks once, and discards those that were there when it was asked: what comes meanwhile stays. */
async function discardAll(rows) {
  if (isDiscarding || barred()) return;
  const count = rows.length, numbers = rows.map(({ number }) => number);
  const title = `Discard ${count} messages of ${senderOf(rows[0])}?`;
  const text = `The box deletes these ${count} messages. Messages that are rejected from now on stay.`;
  if (!(await confirmed({ title, text, word: `Discard ${count}` }))) return;
  isDiscarding = true;
  let done = 0;
  try {
    for (const number of numbers) {
      tell(`Discarding ${done + 1} of ${count}.`);
      const isGone = await post(`/adit/rejected/${number}/discard`).then(() => false, (error) => error.status === 404 || Promise.reject(error));
      if (!isGone) ++done;
    }
    tell(`${done} of ${count} are discarded${done < count ? "; the others were gone" : ""}.`);
  } catch (error) {
    tell(`${done} of ${count} are discarded. ${clip(error.message)}`);
  } finally {
    isDiscarding = false;
  }
}

function create({ number }) {
  const send = make("button.send", "Send again"), discard = make("button.discard", "Discard");
  for (const button of [send, discard]) button.setAttribute("aria-label", `${button.textContent}: ${number}`);
  return make("li", make("span.what"), make("span.since"), make("span.why"), send, discard);
}

const senderOf = ({ robot }) => (robot ? clip(robot, 40) : "all");
const reasonOf = ({ replaced, status, why }) => (replaced ? "A newer message that contains it was sent." : `${status ? `${status}: ` : ""}${clip(why)}`);

function update(node, row, now) {
  const [what, since, why, send, discard] = node.children;
  say(what, `${row.number}: ${row.kind} of ${senderOf(row)}, ${bytes(Math.max(1000, row.bytes))}`);
  say(since, ago(now - row.at));
  say(why, reasonOf(row));
  if (row.replaced && send === document.activeElement) giveFocus(discard);
  // Not during the request, because a disabled control loses the focus.
  discard.disabled = Boolean(barred());
  send.disabled = discard.disabled || row.replaced;
  send.onclick = () => judge(row, "send");
  discard.onclick = () => judge(row, "discard");
}

const keyOf = (row) => JSON.stringify([row.robot, reasonOf(row)]);

/** Groups, the one with the newest message first; each has its rows, the newest first. */
function groupsOf(rows) {
  const groups = grouped([...rows].sort((a, b) => b.number - a.number), keyOf);
  return [...groups].map(([key, its]) => ({ key: its.length > 1 ? key : its[0].number, rows: its }));
}

function createGroup({ key }) {
  const [open, discard] = [make("button.opens"), make("button.discard", "Discard all")];
  open.addEventListener("click", () => {
    if (!opened.delete(key)) opened.add(key);
    showSingles(open.parentNode, key);
  });
  return make("li.group", make("span.what"), make("span.since"), make("span.why"), open, discard, make("ol.singles"));
}

function showSingles(node, key) {
  const open = node.querySelector(".opens"), isOpen = opened.has(key), word = isOpen ? "Hide" : "Show";
  attribute(open, "aria-expanded", String(isOpen));
  say(open, word);
  attribute(open, "aria-label", `${word} ${open.dataset.of}`);
  set(node.querySelector(".singles"), { hidden: !isOpen });
}

function updateGroup(node, { key, rows }, now) {
  const [what, since, why, open, discard, singles] = node.children, [newest] = rows;
  const kinds = [...new Set(rows.map(({ kind }) => kind))].sort().join(", "), sender = senderOf(newest);
  say(what, `${sender}: ${rows.length} messages (${kinds}), ${bytes(rows.reduce((sum, row) => sum + row.bytes, 0))}`);
  say(since, `newest ${ago(now - newest.at)}`);
  say(why, reasonOf(newest));
  mark(open, "of", `the ${rows.length} messages of ${sender}: ${reasonOf(newest)}`);
  attribute(discard, "aria-label", `Discard all ${rows.length} messages of ${sender}: ${reasonOf(newest)}`);
  discard.disabled = Boolean(barred());
  discard.onclick = () => discardAll(rows);
  list(singles, rows, (row) => row.number, create, (item, row) => update(item, row, now));
  showSingles(node, key);
}

export function showRejected(rows, now) {
  const waiting = rows.filter(({ replaced }) => !replaced).length; // adit_rejected_messages counts the same
  if (!rows.length && performance.now() - saidAt > READ) say(said, "");
  set(block, { hidden: !rows.length && !said.textContent });
  set(block.querySelector("h4"), { hidden: !rows.length });
  say(block.querySelector(".count"), waiting ? String(waiting) : "");
  const isSingle = (group) => group.rows.length === 1;
  list(block.querySelector(".rows"), groupsOf(rows), ({ key }) => key,
    (group) => (isSingle(group) ? create(group.rows[0]) : createGroup(group)),
    (node, group) => (isSingle(group) ? update(node, group.rows[0], now) : updateGroup(node, group, now)));
}
