// The test: each step to each endpoint, as it runs, and what to do where it fails.
import { badge, list, make, say } from "./dom.js";
import { get, post } from "./session.js";

const EVERY = 500; // ms
const section = document.getElementById("step-test");
const button = section.querySelector("button"), outcome = section.querySelector(".outcome"), rows = section.querySelector(".endpoints");
const NAMES = { link: "Cable and link", address: "Nobody else has the box’s address", reach: "The endpoint answers", token: "The token is taken", clock: "The clocks agree" };
const LEVELS = { waiting: "quiet", running: "ask", good: "good", bad: "bad", skipped: "quiet" };

/** "good", "bad", or "" where it was not run to its end. */
export let result = "";

function updateStep(node, { name, state, said, advice }) {
  const [state_, title, sentence, help] = node.children;
  node.dataset.level = LEVELS[state] ?? "quiet";
  badge(state_, LEVELS[state] ?? "quiet", state);
  say(title, NAMES[name] ?? name);
  say(sentence, said ?? "");
  say(help, advice ?? "");
}

function update(node, { name, address, steps }) {
  const [title, where, list_] = node.children;
  say(title, name);
  say(where, address);
  list(list_, steps, (step) => step.name, () => make("li", make("span.badge"), make("span.title"), make("span.said"), make("span.advice")), updateStep);
}

function show({ running, endpoints }) {
  list(rows, endpoints, ({ name }) => name, () => make("li.trial", make("h3"), make("span.address"), make("ol")), update);
  const states = endpoints.flatMap(({ steps }) => steps.map(({ state }) => state));
  const isDone = !running && states.some((state) => state === "good" || state === "bad");
  result = !isDone ? "" : states.includes("bad") ? "bad" : "good";
  button.disabled = running;
  outcome.dataset.bad = result === "bad";
  const bad = states.filter((state) => state === "bad").length;
  say(outcome, running ? "It is running. No report is spent." : { good: "All is well. No report was spent.", bad: `${bad} of ${states.length} steps failed. No report was spent.`, "": "" }[result]);
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
