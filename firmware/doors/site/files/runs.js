// The runs that are kept: listed by course, looked at again, printed, deleted.
import "./presses.js";
import { confirmed } from "./dialog.js";
import { badge, list, make, say } from "./dom.js";
import { grouped } from "./grouped.js";
import { lookAgain, leave } from "./run_map.js";
import { followNetwork } from "./pending.js";
import { get, isFault, post, session, showWho, toLogin } from "./session.js";
import { byName, bytes, clip, clock } from "./words.js";

const EVERY = 5000; // ms

const section = document.getElementById("runs");
const courses = section.querySelector(".courses"), trouble = section.querySelector(".trouble");
const link = document.getElementById("link");
let operator = false;

/** The day and the time of seconds since 1970, as this device has them. */
const when = (seconds) => new Date(seconds * 1000).toLocaleString("en-GB", { dateStyle: "medium", timeStyle: "short" });

const pathOf = (run) => `/adit/runs/${encodeURIComponent(run.key)}`;
const nameOf = (run) => `Run ${run.key}`;

function createRun() {
  const look = make("button.look", "View"), remove = make("button.delete", "Delete");
  const report = make("a.report", "Report");
  report.target = "_blank";
  report.rel = "noopener";
  return make("li", make("strong"), make("span.score"), make("span.when"), make("span.what"), make("span.does", look, report, remove));
}

function updateRun(node, run) {
  const [name, score, times, what, does] = node.children;
  const [look, report, remove] = does.children;
  say(name, run.is_present ? `${nameOf(run)} (now)` : nameOf(run));
  say(score, run.score === null ? "no score" : `score ${run.score}, ${run.remaining_reports} reports left`);
  say(times, run.is_present && !run.began ? "" : run.began > 0 ? `${when(run.began)}, ${clock(run.last - run.began)}` : `until ${when(run.last)}`);
  say(what, clip([run.team, [...run.robots].sort(byName).join(", "), bytes(run.bytes)].filter(Boolean).join(" · "), 200));
  report.href = `${pathOf(run)}/report.html`;
  remove.hidden = !operator || run.is_present;
  for (const each of [look, report, remove]) each.setAttribute("aria-label", `${each.textContent}: ${nameOf(run)}`);
  look.onclick = () => lookAt(run);
  remove.onclick = () => forget(run);
}

function createCourse() {
  return make("section.course", make("h3"), make("ul.rows"));
}

function updateCourse(node, { name, runs }) {
  const [title, rows] = node.children;
  say(title, name ? `Course ${name}` : "No course");
  list(rows, runs, ({ key }) => key, createRun, updateRun);
}

async function show() {
  const all = await get("/adit/runs");
  const byCourse = grouped(all.runs, ({ course }) => course);
  const items = [...byCourse].map(([name, runs]) => ({ name, runs }));
  list(courses, items, ({ name }) => name, createCourse, updateCourse);
  section.querySelector(".empty").hidden = items.length > 0;
  const missing = all.unreadable && ` A run may be missing: ${clip(all.unreadable)}`;
  say(section.querySelector(".kept"), (all.trouble ? `Runs are not kept now: ${clip(all.trouble)}` : `All runs take ${bytes(all.bytes)}.`) + missing);
  badge(link, "good", "Live");
}

async function lookAt(run) {
  say(trouble, "");
  try {
    await lookAgain(pathOf(run), run.course ? `${nameOf(run)}, course ${run.course}` : nameOf(run), run.run);
  } catch (error) {
    leave();
    say(trouble, error.message);
  }
}

async function forget(run) {
  const text = "This deletes its map, tracks and plots for good. Its reports stay.";
  if (!(await confirmed({ title: `Delete ${nameOf(run).toLowerCase()}?`, text, word: "Delete" }))) return;
  say(trouble, "");
  try {
    await post(`${pathOf(run)}/delete`);
    leave();
    await show();
  } catch (error) {
    say(trouble, error.message);
  }
}

async function begin() {
  const { role } = await session();
  if (!role) return toLogin();
  operator = role === "operator";
  showWho(document.getElementById("who"));
  followNetwork();
  const follow = async () => {
    if (!document.hidden) await show().catch((error) => isFault(error) || badge(link, "bad", "Box lost"));
    setTimeout(follow, EVERY);
  };
  follow();
}

begin().catch((error) => {
  if (isFault(error)) return;
  badge(link, "bad", "Box lost");
  setTimeout(() => location.reload(), 2000);
});
