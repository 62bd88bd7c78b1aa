// What lets the box in at a Command Post: tokens, which are set and never shown again; and the switch between courses.
import { applied, insist, reviewed, save } from "./apply.js";
import { badge, giveFocus, list, make, say } from "./dom.js";
import { differs, draft, ENDPOINTS, missingTokens, onDraft, refresh, same } from "./draft.js";
import { blame, labelled, reveal, uncover } from "./field.js";
import { post } from "./session.js";
import { addCard, followCard, tellCards } from "./setup_cards.js";
import { tryCourse } from "./trial.js";

const COMMON = { scoring: "Scoring endpoint’s token", mapping: "Mapping endpoint’s token", team: "Team’s token" };
const HINTS = {
  scoring: "From the organiser, for reports and the run’s status.",
  mapping: "From the organiser, for maps, states and markers.",
  team: "For the team’s scripts and stations, if they use their own token.",
};
const WRONG = "expected 1 to 256 visible ASCII characters";
const ofCourse = (name) => name.startsWith("course.");
const labelOf = (name) => COMMON[name] ?? name.replace(/^course\.(.+)\.(\w+)$/, "Own $2 token");
const titleOf = (name) => (ofCourse(name) ? name.replace(/^course\.(.+)\.(\w+)$/, "Course $1: own $2 token") : labelOf(name));

let readOnly = false;

async function send(node, name, token) {
  const { field, outcome } = node;
  say(outcome, "");
  blame(field, "");
  try {
    await insist(() => post("/adit/tokens", { name, token }));
    field.control.value = "";
    await applied();
    await insist(refresh);
    say(outcome, token === null ? "Removed." : "Set.");
    return true;
  } catch (error) {
    blame(field, error.message.replace(/^token: /, ""));
    uncover(field);
    field.control.focus();
    return false;
  } finally {
    tellCards();
  }
}

async function removeIt(node, name) {
  const rejects = ENDPOINTS.includes(name) ? " Without a token the Command Post rejects its messages." : "";
  const text = `The box then uses the token that it came with${ofCourse(name) ? " or the common token" : ", if any"}.${rejects}`;
  if (await reviewed({ title: `Remove “${titleOf(name)}”?`, text, word: "Remove" })) await send(node, name, null);
}

function create(name) {
  const input = Object.assign(make("input"), { type: "password", autocomplete: "off", maxLength: 300, disabled: readOnly });
  const field = labelled(labelOf(name), input, HINTS[name] ?? "");
  const state = make("p.state"), outcome = make("p.outcome");
  outcome.setAttribute("role", "status");
  const [show, remove, set] = ["Show", "Remove", "Set"].map((word) => make("button", word));
  set.className = "set main";
  set.type = "submit";
  for (const button of [show, remove, set]) button.setAttribute("aria-label", `${button.textContent}: ${titleOf(name)}`);
  const node = make("form.token", field, state, make("div.answers", show, remove, set), outcome);
  node.noValidate = true;
  Object.assign(node, { field, outcome, state, buttons: [show, remove, set] });
  show.onclick = () => {
    input.type = input.type === "password" ? "text" : "password";
    const word = input.type === "password" ? "Show" : "Hide";
    say(show, word);
    show.setAttribute("aria-label", `${word}: ${titleOf(name)}`);
  };
  remove.onclick = () => removeIt(node, name);
  node.onsubmit = (event) => {
    event.preventDefault();
    reveal(field);
    const token = input.value.trim();
    if (token) send(node, name, token);
    else blame(field, "type a token first");
  };
  input.addEventListener("input", () => {
    blame(field, /^[!-~]{0,256}$/.test(input.value.trim()) ? "" : WRONG);
    tellCards();
  });
  return node;
}

function update(node, name) {
  const set = draft.tokens[name], needed = ENDPOINTS.includes(name);
  const odd = draft.oddTokens.find(({ path }) => path === name)?.what ?? "";
  const level = set ? (odd ? "wait" : "good") : needed ? "bad" : "quiet";
  node.state.dataset.level = level;
  if (!node.state.firstChild) node.state.append(make("span.badge"), make("span.odd"), " ", make("a"));
  const [badged, warning, own] = node.state.children;
  badge(badged, level, set ? "is set" : needed ? "is missing" : "not set");
  say(warning, odd && ` ${odd}`);
  const { course } = draft.base.command_post, isOverruled = needed && draft.tokens[`course.${course}.${name}`];
  own.hidden = !isOverruled;
  own.href = `#course-${course}`;
  say(own, isOverruled ? `Course ${course} has its own token` : "");
  const [show, remove, setIt] = node.buttons;
  show.hidden = setIt.hidden = readOnly;
  remove.hidden = readOnly || !set;
}

/** Sets whatever is typed and not set yet; whether all of it was taken. */
export async function setTyped() {
  for (const node of document.querySelectorAll("form.token")) {
    const token = node.field.control.value.trim();
    if (token && !(await send(node, node.dataset.key, token))) return false;
  }
  return true;
}

const putTokens = (place, names) => list(place, names, (name) => name, create, update);

/** The state of a card with tokens, if a token in `place` is typed and not set yet; else null. */
function typedIn(place) {
  const isTyped = [...place.querySelectorAll("form.token")].some((node) => node.field.control.value.trim());
  return isTyped ? ["A typed token is not set yet", "wait"] : null;
}

function stateOfEndpoints() {
  const missing = missingTokens({ settings: draft.base, tokens: draft.tokens });
  if (missing.length) return [missing.length === 1 ? `The ${missing[0]} token is missing` : "Both tokens are missing", "bad"];
  return [ENDPOINTS.every((name) => draft.tokens[name]) ? "Both tokens are set" : "The course in use has its own"];
}

const stateOfTeam = () => [draft.tokens.team ? "The token is set" : "Not set: clients use the Command Post’s"];

/** With a warning, if the box has one about the tokens `names`. */
const warned = ([words, level], names) =>
  draft.oddTokens.some(({ path }) => names.includes(path)) && level !== "bad" ? [`${words}, with a warning`, "wait"] : [words, level];

function showTokenCard(id, title, names, stateOf) {
  const tokens = make("div.tokens");
  addCard(document.querySelector("#step-tokens .cards"), id, title, () => typedIn(tokens) ?? warned(stateOf(), names), tokens);
  const show = () => putTokens(tokens, names.filter((name) => name in draft.tokens));
  onDraft(show);
  show();
}

export function showTokens(isReadOnly) {
  readOnly = isReadOnly;
  showTokenCard("tokens-post", "Command Post’s tokens", ENDPOINTS, stateOfEndpoints);
  showTokenCard("tokens-team", COMMON.team, ["team"], stateOfTeam);
}

const nameOf = (course) => (course ? `Course ${course}` : "No course");
const at = ({ address, port }) => `${address.includes(":") ? `[${address}]` : address}:${port}`;
const postOf = (settings, name) => (name ? settings.courses.find((course) => course.name === name) : settings.command_post);

function tokenOf(name, endpoint) {
  if (draft.tokens[`course.${name}.${endpoint}`]) return "own";
  return draft.tokens[endpoint] ? "common" : "missing";
}

/** What a switch to the course changes, from what is in use. */
function changesBy(name) {
  const { base } = draft, now = base.command_post.course;
  const capital = (word) => word[0].toUpperCase() + word.slice(1);
  const rows = (what, value) => ENDPOINTS.map((endpoint) => [`${capital(endpoint)} ${what}`, value(now, endpoint), value(name, endpoint)]);
  const addressOf = (course, endpoint) => {
    const post = postOf(base, course);
    return post ? at(post[endpoint]) : "removed";
  };
  const ownerOf = (course, endpoint) => {
    const token = tokenOf(course, endpoint);
    return token === "own" ? `own of ${nameOf(course)}` : token;
  };
  return [["Course", nameOf(now), nameOf(name)], ...rows("address", addressOf), ...rows("token", ownerOf)].filter(([, from, to]) => from !== to);
}

async function switchTo(name) {
  const outcome = document.querySelector("#step-courses > .outcome");
  const settings = () => ({ ...draft.base, command_post: { ...draft.base.command_post, course: name } });
  const changes = changesBy(name), isStale = () => !same(changesBy(name), changes);
  const asked = insist(() => post("/adit/settings/check", { settings: settings() }));
  const { warnings } = await asked.catch((error) => ({ warnings: [error.message] }));
  if (!(await reviewed({ title: `Switch to ${nameOf(name)}?`, changes, warnings, word: "Switch", isStale }))) return;
  say(outcome, "");
  const isDone = await save(settings());
  outcome.dataset.bad = !isDone;
  say(outcome, `${nameOf(name)} is ${isDone ? "in use" : "not in use"}.`);
}

/** What a card begins with: whether the course is in use, and the ways to test it and to switch to it. */
function createHead() {
  const [tries, button] = ["Try", "Switch"].map((word) => make("button", word));
  tries.dataset.tries = "";
  return make("div.course", make("span.name"), make("span.badge"), make("div.acts", tries, button));
}

/** `isNew`: of a card whose course has no name yet. */
function updateHead(node, name, isNew = false) {
  const [title, state, acts] = node.children, [tries, button] = acts.children;
  const inUse = !isNew && draft.base.command_post.course === name, isApplied = !isNew && postOf(draft.base, name) !== undefined;
  node.dataset.level = inUse ? "good" : "quiet";
  say(title, isNew ? "New course" : nameOf(name));
  badge(state, node.dataset.level, inUse ? "in use" : isApplied ? "not in use" : "not applied yet");
  button.setAttribute("aria-label", `Switch to ${nameOf(name)}`);
  if (inUse && button === document.activeElement) giveFocus(document.getElementById("courses-title"));
  button.hidden = inUse || !isApplied || readOnly;
  button.disabled = differs();
  button.onclick = () => switchTo(name);
  tries.setAttribute("aria-label", `Try ${nameOf(name)} before you switch to it`);
  tries.hidden = button.hidden;
  tries.onclick = () => tryCourse(name);
}

/** Which tokens a course has, and the level if it needs one now. */
function tokensOf(name) {
  const [own, missing] = ["own", "missing"].map((which) => ENDPOINTS.filter((endpoint) => tokenOf(name, endpoint) === which));
  const isNeeded = missing.length && draft.base.command_post.course === name;
  if (missing.length) return [`no ${missing.join(" and no ")} token`, isNeeded ? "bad" : "quiet"];
  return [own.length === 0 ? "common tokens" : own.length === 1 ? `own ${own[0]} token` : "own tokens"];
}

function stateOfCourse(course) {
  if (!course.name || !same(course, postOf(draft.base, course.name))) return ["Not applied yet", "wait"];
  const [tokens, level] = tokensOf(course.name);
  return [[...ENDPOINTS.map((endpoint) => at(course[endpoint])), tokens].join(", "), level];
}

/** The item of a course has its card with the fields already (field.js). */
function showCourse(item, course) {
  const { name } = course;
  if (!item.head) {
    item.head = createHead();
    item.querySelector("legend").after(item.head);
    item.tokens = make("div.tokens");
    item.querySelector(".fields").after(item.tokens);
    item.whose = make("span.spoken");
    item.querySelector("h3").append(item.whose);
  }
  item.id = `course-${name}`; // its address
  say(item.whose, ` of ${name ? nameOf(name) : "the new course"}`);
  followCard(item, () => typedIn(item) ?? stateOfCourse(course));
  updateHead(item.head, name, !name);
  putTokens(item.tokens, ENDPOINTS.map((endpoint) => `course.${name}.${endpoint}`).filter((token) => token in draft.tokens));
}

export function showCourses() {
  const overruled = document.getElementById("overruled"), none = createHead();
  document.getElementById("no-course").append(none);
  const show = () => {
    const { course } = draft.base.command_post;
    updateHead(none, "");
    document.querySelectorAll("[data-list=courses] .item").forEach((item, i) => showCourse(item, draft.settings.courses[i]));
    overruled.hidden = !course;
    overruled.dataset.level = "wait";
    badge(overruled.firstElementChild, "wait", `Course ${course} is in use and overrides these addresses.`);
  };
  onDraft(show);
  show();
}
