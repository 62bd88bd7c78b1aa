// The Test, and tries of what is not applied yet: each step to each endpoint, as it runs, and what to do where it fails.
import { badge, list, make, say } from "./dom.js";
import { draft, ENDPOINTS } from "./draft.js";
import { named, spoken } from "./names.js";
import { get, post } from "./session.js";

const EVERY = 500; // ms
const NAMES = {
  link: "Cable and link",
  address: "No other machine has the box’s address",
  cables: "Each cable is in its port",
  reach: "The endpoint answers",
  token: "The token is accepted",
  clock: "The clocks agree",
};
const LEVELS = { waiting: "quiet", running: "ask", good: "good", bad: "bad", skipped: "quiet" };
const places = new Map([...document.querySelectorAll("[data-tried]")].map((place) => [place.dataset.tried, place]));
const parts = (place) => [".outcome", ".endpoints"].map((part) => place.querySelector(part));

/** What is typed for a token and not set yet; null: nothing. */
const typedToken = (name) => document.querySelector(`form.token[data-key="${name}"]`)?.field.control.value.trim() || null;

/** Of what is in use: "good", "bad", or "" where it was not run to its end. */
export let result = "";
/** Where what runs now was begun; "": it runs since before this page, or elsewhere. */
let begun = "";
let isRunning = false;
let asked = 0;

function updateStep(node, { name, state, said, advice }) {
  const [badged, title, sentence, help] = node.children;
  node.dataset.level = LEVELS[state] ?? "quiet";
  badge(badged, node.dataset.level, state);
  say(title, NAMES[name] ?? name);
  say(sentence, spoken(said ?? ""));
  say(help, spoken(advice ?? ""));
}

const createStep = () => make("li", ...["badge", "title", "said", "advice"].map((part) => make(`span.${part}`)));

function update(node, { name, address, steps }) {
  const [title, where, place] = node.children;
  say(title, name);
  say(where, address);
  list(place, steps, (step) => step.name, createStep, updateStep);
}

/** What came of it, in a sentence. */
function verdictOf(states, { running, applied }) {
  const how = applied ? "It spends no report." : "The run continues, and no report is spent.";
  if (running) return `The test is running. ${how}`;
  const bad = states.filter((state) => state === "bad").length;
  const verdict = bad ? `${bad} of ${states.length} steps failed.` : states.includes("good") ? "All is well." : "";
  return verdict && `${verdict} ${applied ? "No report was spent." : "These values are not applied yet. No report was spent."}`;
}

function report(place, text, isBad) {
  const [outcome] = parts(place);
  outcome.dataset.bad = isBad;
  say(outcome, text);
}

/** The buttons that begin one, while none runs. */
export function barTries() {
  for (const button of document.querySelectorAll("button[data-tries]")) button.disabled = isRunning;
}

function show(view) {
  const { running, applied, course, endpoints } = view;
  const place = places.get(begun || (applied ? "applied" : course ? "course" : "typed"));
  list(parts(place)[1], endpoints, ({ name }) => name, () => make("li.trial", make("h3"), make("span.address"), make("ol")), update);
  const states = endpoints.flatMap(({ steps }) => steps.map(({ state }) => state));
  const isDone = !running && states.some((state) => state === "good" || state === "bad");
  isRunning = running;
  if (applied) result = !isDone ? "" : states.includes("bad") ? "bad" : "good";
  report(place, verdictOf(states, view), !running && states.includes("bad"));
  if (!running) begun = "";
  barTries();
  document.dispatchEvent(new Event("tested"));
}

/** What was asked for before a press says nothing of what it began. */
async function follow() {
  const mine = ++asked;
  try {
    const said = await get("/adit/test");
    if (mine !== asked) return;
    show(said);
    if (said.running) setTimeout(follow, EVERY);
  } catch (error) {
    if (mine !== asked) return;
    report(places.get(begun || "applied"), error.message, true);
    isRunning = !error.status;
    barTries();
    if (isRunning) setTimeout(follow, 4 * EVERY);
  }
}

async function begin(where, body) {
  ++asked;
  isRunning = true;
  begun = where;
  barTries();
  report(places.get(where), "The test begins.", false);
  places.get(where).scrollIntoView({ block: "start" }); // its steps come into sight above the bar of what was typed
  try {
    await post("/adit/test", body);
  } catch (error) {
    report(places.get(where), named(error.message, "command_post."), true);
    begun = "";
    isRunning = error.status === 409; // another's runs, which is followed instead
    barTries();
    if (!isRunning) return;
  }
  follow();
}

/** What stands in the form, with whatever tokens are typed: as it would be without a course. */
function typed() {
  const { command_post: post } = draft.settings;
  return { course: "", ...Object.fromEntries(ENDPOINTS.map((name) => [name, { ...post[name], token: typedToken(name) }])) };
}

/** Tries a course's Command Post before it is switched to. */
export const tryCourse = (name) =>
  begin("course", { course: name, ...Object.fromEntries(ENDPOINTS.map((endpoint) => [endpoint, { token: typedToken(`course.${name}.${endpoint}`) }])) });

export function offerTest() {
  const isOperator = document.body.dataset.role === "operator";
  for (const [where, place] of places) {
    const button = place.querySelector("button[data-tries]");
    if (!button) continue;
    button.hidden = !isOperator;
    button.addEventListener("click", () => begin(where, where === "applied" ? {} : typed()));
  }
  follow();
}
