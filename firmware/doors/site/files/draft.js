// The typed settings, beside the box's settings from which they began. They survive errors, a lost connection and a reload of
// the page until they are applied or dropped. The box reports their errors.
import { get, post } from "./session.js";

const STORED = "adit.typed";
const PAUSE = 300, RETRY = 2000, EVERY = 4000; // ms without a key, ms until a silent box is asked again, ms between questions
const hearers = [], judges = [];

/** `base` and `tag`: what it began from; `newer`: what somebody else saved meanwhile; `keys`: by path. */
export const draft = { settings: null, base: null, tag: "", newer: null, saved: false, tokens: {}, oddTokens: [], keys: new Map() };

export const ENDPOINTS = ["scoring", "mapping"];

/** Tokens without which the Command Post of these settings lets nothing in. */
export const missingTokens = ({ settings, tokens }) =>
  ENDPOINTS.filter((name) => !tokens[name] && !tokens[`course.${settings.command_post.course}.${name}`]);

/** `hear(what)`: "typed", "begun" (from other settings than were typed here), or "told" (of tokens, or something newer). */
export const onDraft = (hear) => hearers.push(hear);

export const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);
export const differs = () => !same(draft.settings, draft.base);

const parts = (path) => path.split(/[.[\]]+/).filter(Boolean);
export const keyOf = (path) => draft.keys.get(path.replace(/\[[^\]]+\]/g, "[]"));
export const read = (path, from = draft.settings) => parts(path).reduce((value, name) => value?.[name], from);

export function write(path, value) {
  const names = parts(path), last = names.pop();
  names.reduce((object, name) => object[name], draft.settings)[last] = value;
  tell("typed");
}

function tell(what) {
  if (differs()) sessionStorage.setItem(STORED, JSON.stringify({ settings: draft.settings, base: draft.base, tag: draft.tag }));
  else sessionStorage.removeItem(STORED);
  for (const hear of hearers) hear(what);
}

/** Begins from `said`, with `settings` as typed. */
export function beginFrom(said, settings = said.settings) {
  Object.assign(draft, { settings: structuredClone(settings), base: said.settings, tag: said.tag, newer: null });
  tell("begun");
}

/** The same; what was typed after `before` stays. */
export const goOnFrom = (said, before) => beginFrom(said, merged(before, draft.settings, said.settings));

export const drop = () => beginFrom({ settings: draft.base, tag: draft.tag });

/** What refresh() tells of, beside settings. */
const aside = () => [draft.saved, draft.tokens, draft.oddTokens, draft.newer?.tag];

/** Asks the box again; what is typed stays, and `newer` is set where it began from other settings. */
export async function refresh() {
  const { tag } = draft, before = aside();
  const said = await get("/adit/settings");
  if (draft.tag !== tag) return; // what it began from meanwhile is newer
  const keys = new Map(said.keys.map((key) => [key.path, key]));
  Object.assign(draft, { saved: said.saved, tokens: said.tokens, oddTokens: said.odd_tokens, keys });
  const fresh = !draft.tag;
  if (fresh) Object.assign(draft, JSON.parse(sessionStorage.getItem(STORED) ?? "{}"));
  if (!draft.tag || (said.tag !== draft.tag && !differs())) return beginFrom(said);
  draft.newer = said.tag === draft.tag ? null : said;
  if (fresh) tell("begun");
  else if (!same(aside(), before)) tell("told");
}

/** Follows what other operators save, unless something is typed: then it is asked for when that is applied. */
export async function followSettings() {
  if (!document.hidden && !differs()) await refresh().catch(() => {}); // the page says elsewhere that the box is lost
  setTimeout(followSettings, EVERY);
}

const isObject = (value) => value !== null && typeof value === "object";
/** A Map of the items of a list by their names; rows of one name (or without any yet) are told apart by their order. */
function named(items) {
  const counts = new Map();
  return new Map(items.map((item) => {
    const name = item.name ?? JSON.stringify(item), nth = counts.get(name) ?? 0;
    counts.set(name, nth + 1);
    return [`${nth} ${name}`, item];
  }));
}

/** `theirs` with what was changed from `base` to `mine`; items of lists are known by their names. */
export function merged(base, mine, theirs) {
  if (same(mine, base)) return theirs;
  if (same(theirs, base) || ![base, mine, theirs].every(isObject)) return mine;
  if (!Array.isArray(mine)) {
    return Object.fromEntries(Object.keys(theirs).map((name) => [name, merged(base[name], mine[name], theirs[name])]));
  }
  const [was, own, newer] = [base, mine, theirs].map(named);
  const kept = [...newer].filter(([name]) => own.has(name) || !was.has(name));
  const added = [...own].filter(([name, item]) => !newer.has(name) && !same(item, was.get(name)));
  const mergedItem = ([name, item]) => (own.has(name) ? merged(was.get(name), own.get(name), item) : item);
  return [...kept.map(mergedItem), ...added.map(([, item]) => item)];
}

/** All values by their paths; items of lists by their names. */
export function flat(value, path = "", into = new Map()) {
  if (!isObject(value)) return into.set(path, value);
  const step = (name, item) => (Array.isArray(value) ? `${path}[${item.name ?? name}]` : path ? `${path}.${name}` : name);
  for (const [name, item] of Object.entries(value)) flat(item, step(name, item), into);
  return into;
}

let timer = 0, asked = 0;

/** {errors, changes, warnings}, and `trouble` where the box could not be asked. */
export let findings = { errors: [], changes: [], warnings: [], trouble: "" };
export const onFindings = (hear) => judges.push(hear);

function set(next) {
  findings = { errors: [], changes: [], warnings: [], trouble: "", ...next };
  for (const hear of judges) hear(findings);
}

function forget() {
  ++asked;
  set({});
}

/** Asks now. A late answer to an older question is not taken. */
export async function check() {
  clearTimeout(timer);
  const mine = ++asked;
  try {
    const said = await post("/adit/settings/check", { settings: draft.settings });
    if (mine === asked) set(said);
  } catch (error) {
    if (mine !== asked) return findings;
    set({ errors: findings.errors, changes: findings.changes, trouble: error.message });
    if (!error.status) timer = setTimeout(check, RETRY);
  }
  return findings;
}

export function checkAsTyped() {
  if (differs()) check(); // it was typed before the page was loaded
  onDraft((what) => {
    if (what === "told") return;
    clearTimeout(timer);
    if (!differs()) return forget();
    timer = setTimeout(check, PAUSE);
  });
}
