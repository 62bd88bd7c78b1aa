// The sessions, and how to end them.
import { tellCard } from "./card.js";
import { confirmed } from "./dialog.js";
import { list, make, say } from "./dom.js";
import { get, isFault, post, toLogin } from "./session.js";
import { ago, clip } from "./words.js";

const EVERY = 5000; // ms

const section = document.getElementById("sessions");
const rows = section.querySelector(".who"), trouble = section.querySelector(".trouble");

// The first word of a User-Agent counts: Android says Linux, and most browsers say Chrome and Safari.
const BROWSERS = ["Edg", "OPR", "SamsungBrowser", "Firefox", "FxiOS", "CriOS", "Chrome", "Safari"];
const SYSTEMS = ["Android", "iPhone", "iPad", "Windows", "Mac OS X", "CrOS", "Linux"];
const NAMES = { Edg: "Edge", OPR: "Opera", SamsungBrowser: "Samsung Internet", FxiOS: "Firefox", CriOS: "Chrome", CrOS: "ChromeOS" };

function named(agent, words) {
  const found = words.find((word) => agent.includes(word));
  return NAMES[found] ?? found;
}

/** "Chrome on Windows" of a User-Agent, or its beginning. */
function browserOf(agent) {
  const browser = named(agent, BROWSERS), system = named(agent, SYSTEMS);
  return browser && system ? `${browser} on ${system}` : clip(agent || "a program", 40);
}

function create() {
  return make("li", make("span.role"), make("span.from"), make("span.note"), make("button"));
}

function update(node, each, now) {
  const [role, from, times, button] = node.children;
  say(role, each.own ? `${each.role} (you)` : each.role);
  say(from, `${each.address}, ${browserOf(each.agent)}`);
  say(times, `logged in ${ago(now - each.made)}, seen ${ago(now - each.seen)}`);
  say(button, each.own ? "Log out" : "End");
  button.setAttribute("aria-label", `${each.own ? "Log out" : "End"}: ${each.role} at ${each.address}, session ${each.number}`);
  button.onclick = () => end(each);
}

async function show() {
  const sessions = await get("/adit/sessions");
  const now = Math.max(...sessions.map(({ seen }) => seen), 0); // the box's clock: the session that asks has just been seen
  list(rows, sessions, ({ number }) => number, create, (node, each) => update(node, each, now));
  const others = sessions.filter(({ own }) => !own).length;
  tellCard(section, others === 0 ? "No one else is logged in" : others === 1 ? "1 other is logged in" : `${others} others are logged in`);
}

async function end(each) {
  const text = each.own ? "You must log in again." : "That user must log in again.";
  if (!(await confirmed({ title: `End session ${each.number}, ${each.role}?`, text, word: "End" }))) return;
  trouble.textContent = "";
  try {
    await post(each.own ? "/adit/logout" : `/adit/sessions/${each.number}/end`);
    if (each.own) return toLogin();
    await show();
  } catch (error) {
    trouble.textContent = error.message;
  }
}

export function watchSessions() {
  const follow = async () => {
    if (!document.hidden) await show().catch(isFault); // the log says that the box is lost
    setTimeout(follow, EVERY);
  };
  follow();
}
