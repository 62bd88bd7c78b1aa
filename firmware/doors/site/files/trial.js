// The connection test, of the settings in use or of typed values: each step to each endpoint as it runs, with advice if it fails. A
// result belongs to the tested values and goes once they differ.
import { forgetOutcome } from "./apply.js";
import { badge, list, make, say } from "./dom.js";
import { draft, ENDPOINTS, onDraft, same } from "./draft.js";
import { named, spoken } from "./names.js";
import { get, post } from "./session.js";

const EVERY = 500, IDLE = 4000; // ms, while a test runs, and else: another operator may begin one, or save
const NAMES = {
  link: "Cable and link",
  address: "The box’s address",
  cables: "Cables and ports",
  reach: "Connection",
  token: "Token",
  clock: "Clocks",
};
const LEVELS = { waiting: "quiet", running: "ask", good: "good", bad: "bad", skipped: "quiet" };
const places = new Map([...document.querySelectorAll("[data-tried]")].map((place) => [place.dataset.tried, place]));
const parts = (place) => [".outcome", ".endpoints"].map((part) => place.querySelector(part));

/** What is typed for a token and not set yet; null: nothing. */
const typedToken = (name) => document.querySelector(`form.token[data-key="${name}"]`)?.field.control.value.trim() || null;

/** Of what is in use: "good", "bad", or "" if it was not tested to its end. */
export let result = "";
let view = null; // GET /adit/test, as last heard
let own = null; // of the test that this page began last: {number, where, body, values}
let note = null; // in the place of a result: {where, body, values, text, isBad, isBusy: until another test has ended}
let lost = ""; // why the box does not tell of a test
let isBeginning = false;
let asked = 0, timer = 0;

/** The card that has what a failed step is about, and the link's words; [""]: this page has none. */
function wayTo(step, endpoint) {
  const course = view.applied ? draft.base.command_post.course : view.course;
  if (step === "address") return ["#network", "Open the box’s address"];
  if (step === "reach") return [course ? `#course-${course}` : "#post", "Open the Command Post’s address"];
  if (step !== "token") return [""];
  return [draft.tokens[`course.${course}.${endpoint}`] ? `#course-${course}` : "#tokens-post", "Open the token"];
}

function updateStep(node, { name, state, said, advice }, endpoint) {
  const [badged, title, sentence, help, way] = node.children;
  node.dataset.level = LEVELS[state] ?? "quiet";
  badge(badged, node.dataset.level, state);
  say(title, NAMES[name] ?? name);
  say(sentence, spoken(said ?? ""));
  say(help, spoken(advice ?? ""));
  const [address, words] = state === "bad" ? wayTo(name, endpoint) : [""];
  way.hidden = !address;
  way.href = address;
  say(way, words ?? "");
}

const createStep = () => make("li", ...["badge", "title", "said", "advice"].map((part) => make(`span.${part}`)), make("a.way"));

function update(node, { name, address, steps }) {
  const [title, where, place] = node.children;
  say(title, name);
  say(where, address);
  list(place, steps, (step) => step.name, createStep, (item, step) => updateStep(item, step, name));
}

/** What body() gives now, in the settings that the page began from. */
const valuesOf = (body) => ({ tag: draft.tag, ...body() });
const isOfThese = ({ body, values }) => same(values, valuesOf(body));
const isOwn = () => own !== null && own.number === view.number;

function placeOf({ applied, course }) {
  if (applied) return "applied";
  return isOwn() ? own.where : course ? "course" : "typed";
}

/** Whether the result is of what the page shows; another's may be. For settings in use, the box knows. */
const isCurrent = ({ applied, outdated }) => !outdated && (applied || !isOwn() || isOfThese(own));

/** Of a result that is not of the settings in use; "" if they are the same. */
function ofWhat() {
  if (!isOwn()) return "This test began elsewhere, perhaps with other values.";
  if (own.where === "course") return "This course is not in use yet."; // only a saved one can be tried
  const isInUse = !draft.base.command_post.course && same(own.values, { tag: draft.tag, ...typed(draft.base, () => null) });
  return isInUse ? "" : "These values are not applied yet.";
}

/** What came of it, in sentences. */
function verdictOf(states) {
  const { running, applied, outdated } = view;
  if (lost && running) return lost;
  if (running) return `The test is running. ${applied ? "It uses up no report." : "The run continues, and no report is used up."}`;
  if (outdated) return "The settings have changed since the last test.";
  const bad = view.endpoints.flatMap((each) => each.steps.filter(({ state }) => state === "bad").map((step) => `${each.name} ${(NAMES[step.name] ?? step.name).toLowerCase()}`));
  const verdict = bad.length ? `${bad.length} of ${states.length} steps failed: ${bad.join(", ")}.` : states.includes("good") ? "All is well." : "";
  if (!verdict || !isCurrent(view)) return "";
  return [verdict, applied ? "" : ofWhat(), "No report was used up."].filter(Boolean).join(" ");
}

function showAt(place, { text = "", isBad = false, endpoints = [] }) {
  const [outcome, ends] = parts(place);
  outcome.dataset.bad = isBad;
  say(outcome, text);
  list(ends, endpoints, ({ name }) => name, () => make("li.trial", make("h3"), make("span.address"), make("ol")), update);
}

/** The buttons that begin a test are disabled while one runs. */
function barTries() {
  const isBarred = isBeginning || Boolean(view?.running);
  for (const button of document.querySelectorAll("button[data-tries]")) button.disabled = isBarred;
}

function resultOf({ running, applied, outdated }, states) {
  if (running || !applied || outdated) return "";
  return states.includes("bad") ? "bad" : states.includes("good") ? "good" : "";
}

/** Shows the last test in its place, and nothing in the others. */
function show() {
  if (note && !isOfThese(note)) note = null;
  const states = (view?.endpoints ?? []).flatMap(({ steps }) => steps.map(({ state }) => state));
  const where = view ? placeOf(view) : "applied";
  for (const [name, place] of places) {
    if (note?.where === name) showAt(place, note);
    else if (name !== where) showAt(place, {});
    else if (!view) showAt(place, { text: lost, isBad: true });
    else if (!isCurrent(view)) showAt(place, { text: verdictOf(states) });
    else showAt(place, { text: verdictOf(states), isBad: !view.running && states.includes("bad"), endpoints: view.endpoints });
  }
  barTries();
  const before = result;
  result = view ? resultOf(view, states) : "";
  if (result !== before) document.dispatchEvent(new Event("tested"));
}

/** Asks how the last test stands, and again later. An answer that was asked for before a press says nothing of its test. */
async function follow() {
  clearTimeout(timer);
  const mine = ++asked;
  const said = await get("/adit/test").catch(({ message }) => ({ lost: message }));
  if (mine !== asked) return;
  lost = said.lost ?? "";
  if (!lost) view = said;
  if (note?.isBusy && !view?.running) note = null;
  if (own && view && view.number < own.number) own = null; // aditd has restarted
  show();
  followLater();
}

function followLater() {
  clearTimeout(timer);
  timer = setTimeout(() => (document.hidden ? followLater() : follow()), view?.running ? EVERY : IDLE);
}

/** Begins a test of body(), whose result is shown at `where`. */
async function begin(where, body) {
  ++asked;
  const begun = { where, body, values: valuesOf(body) };
  note = { ...begun, text: "The test begins.", isBad: false };
  isBeginning = true;
  forgetOutcome();
  show();
  places.get(where).scrollIntoView({ block: "start" }); // its steps come into sight above the bar of typed changes
  try {
    view = await post("/adit/test", body());
    own = { ...begun, number: view.number };
    note = null;
  } catch (error) {
    note = { ...begun, text: named(error.message, "command_post."), isBad: true, isBusy: error.status === 409 };
  }
  isBeginning = false;
  show();
  follow();
}

/** The addresses of `settings` and the tokens that are typed, as they would be without a course. */
function typed({ command_post: post } = draft.settings, tokenOf = typedToken) {
  return { course: "", ...Object.fromEntries(ENDPOINTS.map((name) => [name, { ...post[name], token: tokenOf(name) }])) };
}

/** Tries a course's Command Post before it is switched to. */
export function tryCourse(name) {
  const tokens = () => ENDPOINTS.map((endpoint) => [endpoint, { token: typedToken(`course.${name}.${endpoint}`) }]);
  return begin("course", () => ({ course: name, ...Object.fromEntries(tokens()) }));
}

export function offerTest() {
  const isOperator = document.body.dataset.role === "operator";
  for (const [where, place] of places) {
    const button = place.querySelector("button[data-tries]");
    if (!button) continue;
    button.hidden = !isOperator;
    button.addEventListener("click", () => begin(where, where === "applied" ? () => ({}) : () => typed()));
  }
  document.addEventListener("input", show);
  onDraft((what) => {
    show();
    if (what !== "typed") follow();
  });
  follow();
}
