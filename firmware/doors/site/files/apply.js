// Applies typed settings or a file: shows them first, and never overwrites a newer change by somebody else.
import { answered } from "./dialog.js";
import { beginFrom, check, differs, draft, drop, flat, goOnFrom, merged, onDraft, onFindings, refresh, same, findings, keyOf } from "./draft.js";
import { make, say } from "./dom.js";
import { blameAll, fieldOf, revealAll, uncover } from "./field.js";
import { atThisScheme } from "./https.js";
import { inShort, nameOf, spoken } from "./names.js";
import { get, post } from "./session.js";
import { clip } from "./words.js";

const PATIENCE = 8000, PAUSE = 250; // ms
const place = document.getElementById("typed");
const state = place.querySelector(".state"), elsewhere = place.querySelector(".elsewhere");
const buttons = place.querySelectorAll("button");
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const dialog = document.getElementById("review");
const [heads, rows] = [dialog.querySelector("thead tr"), dialog.querySelector("tbody")];
const [no, yes] = [dialog.querySelector(".no"), dialog.querySelector(".yes")];

const fileSection = document.getElementById("step-file");
const MOST = 250_000; // bytes of a file; the box takes a little more

let outcome = "", link = "", isBusy = false;

const STALE = "Another operator has changed this meanwhile.";

/** A value as people read it. */
function shown(value) {
  if (value === "") return "(empty)";
  return value === null || value === undefined ? "–" : clip(typeof value === "object" ? JSON.stringify(value) : String(value), 300);
}

function head(text, scope) {
  const cell = make("th", text);
  cell.scope = scope;
  return cell;
}

let whenTold = () => {};
onDraft(() => whenTold());

/** Asks; gives true (`word`), false (`other`), or null where the dialog was left. `changes`: [path, value, ...]. If `isStale()` while it
 *  is open, it says so and takes no yes. */
export function reviewed({ title, text = "", columns = ["From", "To"], changes = [], warnings = [], word, other = "", isStale = () => false }) {
  dialog.querySelector("h2").textContent = title;
  dialog.querySelector(".text").textContent = text;
  heads.replaceChildren(...["Setting", ...columns].map((name) => head(name, "col")));
  const row = ([path, ...values]) => make("tr", head(nameOf(path), "row"), ...values.map((value) => make("td", shown(value))));
  rows.replaceChildren(...inShort(changes, (path) => keyOf(path)?.default).map(row));
  dialog.querySelector(".scroll").hidden = !changes.length;
  dialog.querySelector(".warnings").replaceChildren(...warnings.map((warning) => make("li", spoken(warning))));
  yes.textContent = word;
  no.textContent = other || "Cancel";
  yes.disabled = false;
  whenTold = () => {
    if (!isStale()) return;
    yes.disabled = true;
    dialog.querySelector(".text").textContent = `${STALE} Cancel, and look at it again.`;
  };
  return answered(dialog, [[no, other ? false : null], [yes, true]]);
}

export const fromTo = (changes) => changes.map(({ path, from, to }) => [path, from, to]);

/** Does something that the box applies: while another change is being applied, and where it is silent, again. */
export async function insist(action) {
  for (const end = performance.now() + PATIENCE; ; await sleep(PAUSE)) {
    try {
      return await action();
    } catch (error) {
      const passes = !error.status || (error.status === 409 && error.isBusy);
      if (!passes || performance.now() > end) throw error;
    }
  }
}

/** What the box runs with once a change is applied or reverted; null: it does not answer. */
export async function applied() {
  for (const end = performance.now() + PATIENCE; performance.now() < end; await sleep(PAUSE)) {
    const said = await get("/adit/settings").catch(() => null);
    if (said && !said.applying) return said;
  }
  return null;
}

/** Where the page is to be found once the team is served elsewhere; "": where it is. */
function newAddress({ team }, before) {
  const [listen] = team.listen;
  if (!listen || same(team.listen, before.team.listen)) return "";
  const host = listen.address === "0.0.0.0" || listen.address === "::" ? location.hostname : listen.address;
  const there = atThisScheme(`http://${host.includes(":") && host[0] !== "[" ? `[${host}]` : host}:${listen.port}/setup${location.hash}`);
  return location.protocol === "https:" && new URL(there).host === location.host ? "" : there;
}

const OWN = "Saved. The box's answer was lost.";

/** Whether the box uses what was sent: then a save whose answer was lost is this page's own, not another operator's. */
async function isSaved(settings) {
  const { errors, changes } = await post("/adit/settings/check", { settings });
  return !errors.length && !changes.length;
}

/** Two operators: theirs is in use, and one goes on from it. If the box does not answer, that is asked with the next save. */
async function settle() {
  const { base, newer } = draft, mine = structuredClone(draft.settings);
  const isOwn = await isSaved(mine).catch(() => null);
  if (isOwn) return goOnFrom(newer, mine), report(OWN);
  if (isOwn === null) return;
  const [was, own, theirs] = [base, mine, newer.settings].map((each) => flat(each));
  const isOther = (path) => own.get(path) !== was.get(path) || theirs.get(path) !== was.get(path);
  const paths = [...new Set([...theirs.keys(), ...own.keys()])].filter(isOther);
  const answer = await reviewed({
    title: "Another operator has saved settings",
    text: "Their settings are in use now. If you keep your changes, they are added to these settings, and you can still edit them.",
    columns: ["Before", "Theirs", "Yours"],
    changes: paths.map((path) => [path, was.get(path), theirs.get(path), own.get(path)]),
    word: "Keep mine on top of theirs",
    other: "Drop mine",
  });
  if (answer !== null) beginFrom(newer, answer ? merged(base, mine, newer.settings) : undefined);
}

/** Posts settings that were looked at; whether the box runs with them now. */
export async function save(settings) {
  const { tag, base } = draft, before = structuredClone(draft.settings);
  isBusy = true;
  link = "";
  report("The box applies the changes.");
  try {
    const { changes } = await insist(() => post("/adit/settings", { settings, base: tag }));
    link = newAddress(settings, base);
    if (link) report("Within a second the page moves to");
    const said = await applied();
    const isDone = said && (said.tag !== tag || !changes.length);
    if (said && !isDone) link = "";
    if (isDone) goOnFrom(said, before);
    if (said) await refresh();
    if (link) report("The page has moved to");
    else if (isDone) report("Applied.");
    else report(said ? said.trouble || "The change was reverted." : "The box does not answer.");
    return isDone;
  } catch (error) {
    return notSaved(error, settings, { base, before });
  } finally {
    isBusy = false;
    show();
  }
}

/** A save that failed, or whose answer was lost. */
async function notSaved(error, settings, { base, before }) {
  if (error.status && error.status !== 409) return report(error.message), false;
  if (await isSaved(settings).catch(() => false)) {
    const said = await applied();
    if (said) goOnFrom(said, before);
    return report(OWN), true;
  }
  if (!error.status) link = newAddress(settings, base);
  if (link) return report(`${error.message} The page may have moved to`), false;
  if (error.status) await refresh().catch(() => {});
  report(draft.newer ? "" : error.message);
  if (draft.newer) await settle();
  return false;
}

function report(text) {
  outcome = text;
  show();
}

/** What was applied says nothing of what is done next. */
export function forgetOutcome() {
  if (!isBusy && !link) report("");
}

/** Shows what is to change and applies it where that is wanted; whether nothing is left to apply. */
export async function apply() {
  if (!differs()) return true;
  await refresh().catch(() => {});
  if (draft.newer) await settle();
  const { errors, changes, warnings, trouble } = await check();
  if (trouble) return report(`${trouble} Your changes are kept.`), false;
  revealAll();
  if (errors.length) return goTo(errors[0]), false;
  const settings = structuredClone(draft.settings);
  const yes = await reviewed({ title: "Apply these changes?", changes: fromTo(changes), warnings, word: "Apply" });
  return yes === true && save(settings);
}

/** To the field of a setting, in whichever step it is. */
export function goTo({ path }) {
  const field = fieldOf(path);
  if (!field) return;
  const step = field.closest("section").id.replace("step-", "#");
  if (location.hash !== step) location.hash = step;
  uncover(field);
  requestAnimationFrame(() => requestAnimationFrame(() => field.control.focus()));
}

function errorLink(error) {
  const item = make("button", `${nameOf(error.path)}: ${spoken(error.what)}`);
  item.addEventListener("click", () => goTo(error));
  return make("li", error.field ? item : item.textContent);
}

/** An item that was added or removed is one change, however many values it has. */
const countOf = (changes) => new Set(changes.map(({ path, from, to }) => (from === null || to === null ? path.replace(/\].*/, "]") : path))).size;

function described(errors) {
  const { changes, trouble } = findings;
  if (trouble) return `${trouble} Your changes are kept, and checked when it answers.`;
  if (errors.length) return `${errors.length === 1 ? "1 error" : `${errors.length} errors`} to correct before you can apply.`;
  const count = countOf(changes);
  if (findings.errors.length || !count) return "Your changes are not yet applied."; // errors show once the field is left; no count: not checked yet
  return `${count === 1 ? "1 change" : `${count} changes`} not yet applied.`;
}

function show() {
  const typed = differs();
  place.hidden = !typed && !outcome;
  const errors = blameAll(findings.errors);
  say(state, isBusy || !typed ? outcome : [outcome, described(errors)].filter(Boolean).join(" "));
  if (link) state.append(" ", Object.assign(make("a", link), { href: link }));
  for (const button of buttons) button.hidden = !typed || isBusy;
  const here = document.querySelector("#sheets > section:not([hidden])");
  const others = errors.filter(({ field }) => !field || !here?.contains(field));
  elsewhere.replaceChildren(...others.map(errorLink));
  document.body.dataset.typed = typed;
}

export function offerApply() {
  const [dropIt, applyIt] = buttons;
  new ResizeObserver(() => document.documentElement.style.setProperty("--bar", `${place.offsetHeight}px`)).observe(place);
  dropIt.addEventListener("click", () => {
    outcome = "";
    drop();
  });
  applyIt.addEventListener("click", apply);
  onDraft((what) => {
    if (what === "typed" && !isBusy) outcome = link = "";
    show();
  });
  onFindings(show);
  document.addEventListener("revealed", show);
  addEventListener("hashchange", () => requestAnimationFrame(show));
  if (draft.newer) settle();
}

function reportFile(text, { isBad = true, errors = [] } = {}) {
  const [said, wrong] = fileSection.querySelectorAll(".outcome, .warnings");
  said.dataset.bad = isBad;
  say(said, text);
  wrong.replaceChildren(...errors.map(({ path, what }) => make("li", `${path && `${nameOf(path)}: `}${spoken(what)}`)));
}

async function readFile(file) {
  if (file.size > MOST) throw new Error("The file is too long for a settings file.");
  try {
    return JSON.parse(await file.text());
  } catch {
    throw new Error("The file is not JSON, so it is not a settings file.");
  }
}

async function takeFile(file) {
  const settings = await readFile(file);
  const { errors, changes, warnings } = await post("/adit/settings/check", { settings });
  if (errors.length) return reportFile("The file was not applied, because it has errors.", { errors });
  if (!changes.length) return reportFile("The box already uses the settings in this file.");
  const text = differs() ? "Your changes that are not applied are dropped." : "";
  const yes = await reviewed({ title: `Apply ${file.name}?`, text, changes: fromTo(changes), warnings, word: "Apply" });
  if (!yes) return reportFile("The file was not applied.");
  reportFile("");
  if (await save(settings)) reportFile("Applied.", { isBad: false });
}

/** Settings from a file: checked by the box, shown, and only then applied. */
export function offerImport() {
  const input = fileSection.querySelector("input");
  input.addEventListener("change", async () => {
    const [file] = input.files;
    if (!file) return;
    reportFile("");
    await takeFile(file).catch((error) => reportFile(error.message));
    input.value = "";
  });
}
