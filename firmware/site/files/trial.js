// The test: each step to each endpoint, as it runs, and what to do where it fails.
import { badge, list, make, say } from "./dom.js";
import { get, post } from "./session.js";

const EVERY = 500; // ms
const NAMES = {
  link: "Cable and link",
  address: "Nobody else has the box’s address",
  cables: "Each cable is in its port",
  reach: "The endpoint answers",
  token: "The token is taken",
  clock: "The clocks agree",
};
const LEVELS = { waiting: "quiet", running: "ask", good: "good", bad: "bad", skipped: "quiet" };
const section = document.getElementById("step-test");
const [button, outcome, rows] = ["button", ".outcome", ".endpoints"].map((part) => section.querySelector(part));

/** "good", "bad", or "" where it was not run to its end. */
export let result = "";

function updateStep(node, { name, state, said, advice }) {
  const [badged, title, sentence, help] = node.children;
  node.dataset.level = LEVELS[state] ?? "quiet";
  badge(badged, node.dataset.level, state);
  say(title, NAMES[name] ?? name);
  say(sentence, said ?? "");
  say(help, advice ?? "");
}

const createStep = () => make("li", ...["badge", "title", "said", "advice"].map((part) => make(`span.${part}`)));

function update(node, { name, address, steps }) {
  const [title, where, place] = node.children;
  say(title, name);
  say(where, address);
  list(place, steps, (step) => step.name, createStep, updateStep);
}

/** What came of it, in a sentence. */
function verdictOf(states, running) {
  if (running) return "It is running. No report is spent.";
  if (!result) return "";
  const bad = states.filter((state) => state === "bad").length;
  return `${bad ? `${bad} of ${states.length} steps failed` : "All is well"}. No report was spent.`;
}

function show({ running, endpoints }) {
  list(rows, endpoints, ({ name }) => name, () => make("li.trial", make("h3"), make("span.address"), make("ol")), update);
  const states = endpoints.flatMap(({ steps }) => steps.map(({ state }) => state));
  const isDone = !running && states.some((state) => state === "good" || state === "bad");
  result = !isDone ? "" : states.includes("bad") ? "bad" : "good";
  button.disabled = running;
  outcome.dataset.bad = result === "bad";
  say(outcome, verdictOf(states, running));
  document.dispatchEvent(new Event("tested"));
}

async function follow() {
  try {
    const said = await get("/adit/test");
    show(said);
    if (said.running) setTimeout(follow, EVERY);
  } catch (error) {
    say(outcome, error.message);
    outcome.dataset.bad = true;
    if (!error.status) setTimeout(follow, 4 * EVERY);
    else button.disabled = document.body.dataset.role !== "operator";
  }
}

export function offerTest() {
  button.hidden = document.body.dataset.role !== "operator";
  button.addEventListener("click", async () => {
    button.disabled = true;
    outcome.dataset.bad = false;
    say(outcome, "It begins.");
    try {
      await post("/adit/test");
    } catch (error) {
      outcome.dataset.bad = true;
      button.disabled = false;
      return say(outcome, error.message);
    }
    follow();
  });
  follow();
}
