// The box's time of day: where this browser's is another, the operator is asked once whether it counts.
import { confirmed } from "./dialog.js";
import { get, post, session } from "./session.js";
import { age } from "./words.js";

const MOST = 2; // seconds by which they may differ
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

/** What the box says of its time, in words; "" where it does not. */
export async function clockSaid() {
  const { source, is_set: isSet, ntp } = await get("/adit/clock");
  return [SOURCES[source ?? (isSet ? "machine" : "none")], ntp].filter(Boolean).join("; ");
}

/** To be asked as a page begins. Gives whether the box was asked to set its clock. */
export async function offerClock() {
  const { role } = await session();
  if (role !== "operator" || sessionStorage.getItem(SAID_NO)) return false;
  const { box, ahead } = await compare();
  if (!box.managed || box.is_kept || Math.abs(ahead) <= MOST) return false;
  const sure = await confirmed({
    title: "Set the box’s clock?",
    text: `The box’s time is ${utc(box.now)} UTC, ${age(Math.abs(ahead))} ${ahead > 0 ? "ahead of" : "behind"} this device. Reports, time stamps and logins do not change.`,
    word: "Set the clock",
  });
  if (!sure) {
    sessionStorage.setItem(SAID_NO, "1");
    return false;
  }
  await post("/adit/clock", { time: Date.now() / 1000 });
  return true;
}
