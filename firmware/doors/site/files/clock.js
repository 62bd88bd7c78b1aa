// The box's time of day. If this browser's differs, asks the operator once whether the browser's is right.
import { tellCard } from "./card.js";
import { confirmed } from "./dialog.js";
import { say } from "./dom.js";
import { get, post, session } from "./session.js";
import { age } from "./words.js";

const MOST = 2; // seconds by which they may differ
const EVERY = 5000; // ms
const SAID_NO = "adit-clock-no";

const utc = (seconds) => new Date(seconds * 1000).toISOString().replace("T", " ").slice(0, 19);

/** Seconds by which the box's is ahead of this browser's, and what the box says of it. */
async function compare() {
  const asked = Date.now();
  const box = await get("/adit/clock");
  return { box, ahead: box.now - (asked + Date.now()) / 2000 };
}

const SOURCES = {
  none: "not set since the box started",
  last_known: "continued from the last known time",
  robots: "set by the robots’ time stamps",
  command_post: "set by the Command Post’s answers",
  chip: "set by the box’s own clock",
  operator: "set by an operator",
  ntp: "set by an NTP server",
  machine: "kept by the machine itself",
};

/** Asks, and sets the box's clock to this device's time on a yes; gives the answer. */
async function setClock({ box, ahead }) {
  const sure = await confirmed({
    title: "Set the box’s clock?",
    text: `The box’s time is ${utc(box.now)} UTC, ${difference(ahead)} this device. Reports, time stamps and logins do not change.`,
    word: "Set the clock",
  });
  if (sure) await post("/adit/clock", { time: Date.now() / 1000 });
  return sure;
}

const difference = (ahead) => (Math.abs(ahead) <= MOST ? "the same as on" : `${age(Math.abs(ahead))} ${ahead > 0 ? "ahead of" : "behind"}`);
const canSet = ({ managed, is_kept: isKept }) => managed && !isKept;

/** To be asked as a page begins. Gives whether the box was asked to set its clock. */
export async function offerClock() {
  const { role } = await session();
  if (role !== "operator" || sessionStorage.getItem(SAID_NO)) return false;
  const both = await compare();
  if (!canSet(both.box) || Math.abs(both.ahead) <= MOST) return false;
  const sure = await setClock(both);
  if (!sure) sessionStorage.setItem(SAID_NO, "1");
  return sure;
}

/** On the page of the box: who set its time, and a button that sets it. */
export function showClock(isOperator) {
  const section = document.getElementById("clock"), note = section.querySelector("p"), button = section.querySelector("button");
  let both = null;
  const show = async () => {
    both = await compare();
    const { source, is_set: isSet, ntp, refusal } = both.box;
    const words = [SOURCES[source ?? (isSet ? "machine" : "none")], ntp, refusal, `the time is ${difference(both.ahead)} this device`];
    say(note, words.filter(Boolean).map((each) => `${each[0].toUpperCase()}${each.slice(1)}.`).join(" "));
    const isOffered = isOperator && canSet(both.box), differs = Math.abs(both.ahead) > MOST;
    button.parentElement.hidden = !isOffered;
    const line = differs ? `${difference(both.ahead)} this device` : words[0];
    tellCard(section, `${line[0].toUpperCase()}${line.slice(1)}`, refusal ? "bad" : differs && isOffered ? "wait" : "quiet");
  };
  const follow = () => show().catch(({ message }) => say(note, message)).then(() => setTimeout(follow, EVERY));
  button.addEventListener("click", () => setClock(both).then(show).catch(({ message }) => say(note, message)));
  follow();
}
