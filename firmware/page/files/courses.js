// Courses: one press switches to another Command Post, once it was said what that changes.
import { applied, insist, reviewed } from "./apply.js";
import { badge, list, make, say } from "./dom.js";
import { differs, draft, ENDPOINTS, onDraft, refresh } from "./draft.js";
import { post } from "./session.js";

const section = document.getElementById("step-courses");
const outcome = section.querySelector(".outcome");

const nameOf = (course) => (course ? `Course ${course}` : "No course");
const at = ({ address, port }) => `${address.includes(":") ? `[${address}]` : address}:${port}`;
const postOf = (settings, name) => (name ? settings.courses.find((course) => course.name === name) : settings.command_post);
const tokenOf = (name, endpoint) => (draft.tokens[`course.${name}.${endpoint}`] ? "its own" : draft.tokens[endpoint] ? "the common one" : "missing");

async function switchTo(name) {
  const { base } = draft, now = base.command_post.course;
  const rows = (what, value) => ENDPOINTS.map((endpoint) => [`${endpoint} ${what}`, value(now, endpoint), value(name, endpoint)]);
  const changes = [["course", nameOf(now), nameOf(name)], ...rows("address", (course, endpoint) => at(postOf(base, course)[endpoint])), ...rows("token", tokenOf)];
  const text = "Reports that were not sent to the old Command Post are held until you say; maps that wait go to the new one.";
  if (!(await reviewed({ title: `Switch to ${nameOf(name).toLowerCase().replace(name.toLowerCase(), name)}?`, text, changes, word: "Switch" }))) return;
  say(outcome, "It is being applied.");
  outcome.dataset.bad = false;
  try {
    await insist(() => post("/adit/course", { name }));
    await applied();
    await insist(refresh);
    const isDone = draft.base.command_post.course === name;
    outcome.dataset.bad = !isDone;
    say(outcome, isDone ? `${nameOf(name)} is in use.` : "The box does not run with it: it may have been taken back.");
  } catch (error) {
    outcome.dataset.bad = true;
    say(outcome, error.message);
  }
}

function create() {
  const button = Object.assign(make("button", "Switch"), { type: "button" });
  return make("li", make("span.name"), make("span.badge"), make("span.note"), button);
}

function update(node, name) {
  const [title, state, note, button] = node.children;
  const inUse = draft.base.command_post.course === name, { scoring, mapping } = postOf(draft.base, name);
  node.dataset.level = inUse ? "good" : "quiet";
  say(title, nameOf(name));
  badge(state, inUse ? "good" : "quiet", inUse ? "in use" : "not in use");
  say(note, `${at(scoring)}, ${at(mapping)}`);
  button.setAttribute("aria-label", `Switch to ${nameOf(name)}`);
  button.hidden = inUse || document.body.dataset.role !== "operator";
  button.disabled = differs();
  button.onclick = () => switchTo(name);
}

export function showCourses() {
  const overruled = document.getElementById("overruled");
  const show = () => {
    const { courses, command_post: { course } } = draft.base;
    list(document.getElementById("switch"), ["", ...courses.map(({ name }) => name)], (name) => name, create, update);
    overruled.hidden = !course;
    overruled.dataset.level = "wait";
    badge(overruled.firstElementChild, "wait", `Course ${course} is in use: these count again without a course.`);
  };
  onDraft(show);
  show();
}
