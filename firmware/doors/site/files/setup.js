// Set-up: the box's addresses, the Command Post's, tokens, robots, courses and all else, in steps: in order at first, in
// any order later.
import "./presses.js";
import { apply, goTo, offerApply, offerImport } from "./apply.js";
import { followAddress } from "./card.js";
import { setTyped, showCourses, showTokens } from "./courses.js";
import { badge, list, make, mark, say } from "./dom.js";
import { checkAsTyped, draft, followSettings, missingTokens, onDraft, onFindings, refresh, findings } from "./draft.js";
import { blameAll, fillIn, listOf, onlyShow, showAll } from "./field.js";
import { offerNetwork, showNetwork } from "./network.js";
import { followNetwork } from "./pending.js";
import { showPorts } from "./ports.js";
import { isFault, session, showWho, toLogin } from "./session.js";
import { counted, tellCards } from "./setup_cards.js";
import { offerTest, result } from "./trial.js";

const RETRY = 2000; // ms
const link = document.getElementById("link");
const sections = [...document.querySelectorAll("#sheets > section")];
const FIRST = 5; // those that lead through in order
const place = document.querySelector("#steps ol"), turn = document.getElementById("turn");
const [back, next] = turn.querySelectorAll("button");

const nameOf = (section) => section.id.replace("step-", "");
const titleOf = (section) => section.querySelector("h2").textContent;

/** The step that the address names, or in which it names a card. */
function here() {
  const named = document.getElementById(location.hash.slice(1));
  return Math.max(0, sections.findIndex((section) => `#${nameOf(section)}` === location.hash || section.contains(named)));
}

/** How far a step is: a level, and its word. */
const STATES = {
  post: () => ["good", "set"],
  tokens: () => (missingTokens({ settings: draft.base, tokens: draft.tokens }).length ? ["bad", "missing"] : ["good", "set"]),
  robots: () => (draft.base.robots.length ? ["good", `${draft.base.robots.length} named`] : ["quiet", "any name"]),
  test: () => ({ good: ["good", "passed"], bad: ["bad", "failed"], "": ["quiet", "not run"] })[result],
  courses: () => ["quiet", draft.base.command_post.course ? `${draft.base.command_post.course} in use` : draft.base.courses.length ? `${draft.base.courses.length} saved` : "none"],
};

function stateOf(section, errors) {
  const wrong = errors.filter(({ field }) => field && section.contains(field)).length;
  return wrong ? ["bad", counted(wrong, "error")] : (STATES[nameOf(section)]?.() ?? ["quiet", ""]);
}

function update(node, section, errors) {
  const link = node.firstChild, i = sections.indexOf(section), [level, word] = stateOf(section, errors);
  if (i === here()) link.setAttribute("aria-current", "step");
  else link.removeAttribute("aria-current");
  say(link.firstChild, i < FIRST ? `${i + 1}. ${titleOf(section)}` : titleOf(section));
  mark(link, "level", level);
  link.lastChild.hidden = !word;
  badge(link.lastChild, level, word);
}

function create(section) {
  return make("li", Object.assign(make("a", make("span"), make("span.badge")), { href: `#${nameOf(section)}` }));
}

function show() {
  const errors = blameAll(findings.errors), at = here();
  tellCards();
  list(place, sections, nameOf, create, (node, section) => update(node, section, errors));
  back.hidden = at === 0;
  next.hidden = at === sections.length - 1;
  say(next, at === FIRST - 1 ? "Go to the run" : "Next");
  showMissing();
}

function showMissing() {
  const sign = document.getElementById("missing"), missing = missingTokens({ settings: draft.base, tokens: draft.tokens });
  sign.hidden = missing.length === 0;
  say(sign.querySelector(".text"), `Not set up yet: the ${missing.join(" and the ")} token ${missing.length > 1 ? "are" : "is"} missing.`);
}

function turnTo(focus) {
  const at = here();
  sections.forEach((section, i) => (section.hidden = i !== at));
  show();
  place.children[at].scrollIntoView({ block: "nearest", inline: "center" });
  if (!focus) return;
  scrollTo(0, 0);
  sections[at].querySelector("h2").focus();
}

const go = (section) => (location.hash = nameOf(section));

/** What was typed in a step is set before the next one. */
async function goOn() {
  const at = here();
  if (!(await setTyped())) return;
  if (!(await apply())) return;
  if (at === FIRST - 1) location.href = "/";
  else go(sections[at + 1]);
}

function leadThrough() {
  addEventListener("hashchange", () => turnTo(true));
  for (const each of ["tested", "revealed"]) document.addEventListener(each, show);
  back.addEventListener("click", () => go(sections[here() - 1]));
  next.addEventListener("click", async () => {
    next.disabled = true;
    await goOn().finally(() => (next.disabled = false));
  });
  onDraft(show);
  onFindings(show);
  for (const each of [document.getElementById("steps"), document.getElementById("sheets")]) each.hidden = false;
  turnTo(false);
}

function linkIs(lost) {
  badge(link, lost ? "bad" : "good", lost ? "Box lost" : "Live");
}

async function begin() {
  const { role } = await session();
  if (!role) return toLogin();
  const isViewer = role !== "operator";
  document.body.dataset.role = role;
  document.getElementById("looks").hidden = !isViewer;
  showWho(document.getElementById("who"));
  await refresh();
  if (isViewer) onlyShow();
  else checkAsTyped();
  offerNetwork();
  fillIn();
  for (const place of document.querySelectorAll("[data-list]")) listOf(place);
  showAll();
  showTokens(isViewer);
  showCourses();
  offerTest();
  offerImport();
  document.querySelector(".choose").hidden = isViewer;
  leadThrough();
  followAddress();
  offerApply();
  const wanted = new URLSearchParams(location.search).get("setting"); // a way from elsewhere: refusals.js
  if (wanted) goTo({ path: wanted });
  followSettings();
  followNetwork((network, error) => {
    if (network) showPorts(document.querySelector("#step-network .ports"), network);
    if (network) showNetwork(network);
    if (error !== undefined) linkIs(error !== null && !error.status);
  });
}

begin().catch((error) => {
  if (isFault(error)) return;
  linkIs(true);
  if (error.status) throw error;
  setTimeout(() => location.reload(), RETRY);
});
