// Tokens: they are typed and set, and never shown again.
import { applied, insist } from "./apply.js";
import { confirmed } from "./dialog.js";
import { badge, list, make, say } from "./dom.js";
import { draft, ENDPOINTS, onDraft, refresh } from "./draft.js";
import { blame, labelled } from "./field.js";
import { post } from "./session.js";

const COMMON = { scoring: "Scoring endpoint’s token", mapping: "Mapping endpoint’s token", team: "The team’s own token" };
const HINTS = {
  scoring: "Given by the Command Post’s staff; reports and the run’s status need it.",
  mapping: "Given by the Command Post’s staff; maps, states and markers need it.",
  team: "For scripts and stations of the team, if these are to have one of their own.",
};
const ofCourse = (name) => name.startsWith("course.");
const labelOf = (name) => COMMON[name] ?? name.replace(/^course\.(.+)\.(\w+)$/, "Course $1: $2 token of its own");
const hintOf = (name) => HINTS[name] ?? "Without one, the common token counts.";

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
    blame(field, error.message);
    field.control.focus();
    return false;
  }
}

async function removeIt(node, name) {
  const text = "The one that the box was given, if any, counts then; without one the Command Post lets nothing in.";
  if (await confirmed({ title: `Remove “${labelOf(name)}”?`, text, word: "Remove it" })) await send(node, name, null);
}

function create(name) {
  const input = Object.assign(make("input"), { type: "password", autocomplete: "off", spellcheck: false, maxLength: 300, disabled: readOnly });
  const field = labelled(labelOf(name), input, hintOf(name));
  const state = make("p.state"), outcome = make("p.outcome");
  outcome.setAttribute("role", "status");
  const [show, remove, set] = ["Show", "Remove", "Set"].map((word) => Object.assign(make("button", word), { type: "button" }));
  set.className = "set main";
  set.type = "submit";
  for (const [button, word] of [[show, "Show"], [remove, "Remove"], [set, "Set"]]) button.setAttribute("aria-label", `${word}: ${labelOf(name)}`);
  const node = make("form.token", field, state, make("div.answers", show, remove, set), outcome);
  node.noValidate = true;
  Object.assign(node, { field, outcome, state, buttons: [show, remove, set] });
  show.onclick = () => {
    input.type = input.type === "password" ? "text" : "password";
    const word = input.type === "password" ? "Show" : "Hide";
    say(show, word);
    show.setAttribute("aria-label", `${word}: ${labelOf(name)}`);
  };
  remove.onclick = () => removeIt(node, name);
  node.onsubmit = (event) => {
    event.preventDefault();
    const token = input.value.trim();
    if (token) send(node, name, token);
    else blame(field, "nothing is typed yet");
  };
  input.addEventListener("input", () => blame(field, /^[!-~]{0,256}$/.test(input.value.trim()) ? "" : "expected 1 to 256 visible ASCII characters"));
  return node;
}

function update(node, name) {
  const set = draft.tokens[name], needed = ENDPOINTS.includes(name);
  const level = set ? "good" : needed ? "bad" : "quiet";
  node.state.dataset.level = level;
  if (!node.state.firstChild) node.state.append(make("span.badge"));
  badge(node.state.firstChild, level, set ? "is set" : needed ? "is missing" : "none");
  const [show, remove, setIt] = node.buttons;
  show.hidden = setIt.hidden = readOnly;
  remove.hidden = readOnly || !set;
}

/** Sets whatever is typed and not set yet; whether all of it was taken. */
export async function setTyped() {
  for (const node of document.querySelectorAll("#step-tokens form.token")) {
    const token = node.field.control.value.trim();
    if (token && !(await send(node, node.dataset.key, token))) return false;
  }
  return true;
}

export function showTokens(isReadOnly) {
  readOnly = isReadOnly;
  const show = () => {
    const names = Object.keys(draft.tokens);
    const put = (step, which) => list(document.querySelector(`#${step} .tokens`), names.filter(which), (name) => name, create, update);
    put("step-tokens", (name) => !ofCourse(name));
    put("step-courses", ofCourse);
  };
  onDraft(show);
  show();
}
