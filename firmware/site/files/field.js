// One setting as a field: what it means, what is allowed, what is wrong with it.
import { make, say } from "./dom.js";
import { draft, keyOf, onDraft, read, same, write } from "./draft.js";
import { grouped } from "./grouped.js";
import { label as call, nameOf, spoken } from "./names.js";
import { numberIn } from "./words.js";

const known = new Set();
let readOnly = false;
let number = 0;

export const onlyShow = () => (readOnly = true);

/** A field of any form: a label, a control, what is to be known of it, and what is wrong with it. */
export function labelled(label, control, hint) {
  const id = `field-${++number}`;
  const name = make("label", label), note = make("p.note", hint), wrong = make("p.wrong");
  [control.id, note.id, wrong.id] = [id, `${id}-note`, `${id}-wrong`];
  name.htmlFor = id;
  control.setAttribute("aria-describedby", `${wrong.id} ${note.id}`);
  const field = make(control.type === "checkbox" ? "div.field.flag" : "div.field", name, control, wrong, note);
  return Object.assign(field, { control, wrong, note });
}

/** Says at a field what is wrong; "": nothing is. */
export function blame(field, what) {
  say(field.wrong, spoken(what));
  if (what) field.control.setAttribute("aria-invalid", "true");
  else field.control.removeAttribute("aria-invalid");
}

function controlOf({ kind, words }) {
  if (kind === "choice") {
    return make("select", ...words.map((word) => Object.assign(make("option", word || "none"), { value: word })));
  }
  const input = make("input");
  input.type = kind === "flag" ? "checkbox" : "text";
  Object.assign(input, { autocomplete: "off", spellcheck: false, autocapitalize: "none" });
  if (kind === "whole") input.inputMode = "numeric";
  if (kind === "real") input.inputMode = "decimal";
  return input;
}

/** A number where it is one; the box says what is wrong with anything else. */
function valueOf(control, { kind }) {
  if (kind === "flag") return control.checked;
  const text = control.value.trim();
  const typed = kind === "real" ? numberIn(text) : NaN;
  if (Number.isFinite(typed)) return typed;
  return (kind === "whole" || kind === "real") && text && Number.isFinite(Number(text)) ? Number(text) : text;
}

const written = (value) => (value === "" ? "empty" : String(value));
const hintOf = ({ meaning, kind, range, required, default: usual }) =>
  `${meaning} ${kind === "flag" ? "" : `Allowed: ${range}. `}${required ? "" : `By default ${written(usual)}.`}`;

/** The field of the setting at `path`, which has a key: shown, too, where `written` says so. */
function setting(path, label, written = "") {
  const key = keyOf(path), control = controlOf(key);
  const field = labelled(label, control, hintOf(key));
  if (written) field.firstChild.append(" ", make("code", written));
  field.dataset.path = path;
  field.show = () => {
    const value = read(path);
    if (value === undefined || document.activeElement === control || same(valueOf(control, key), value)) return; // as it is typed
    if (key.kind === "flag") control.checked = value;
    else control.value = value;
  };
  control.addEventListener("input", () => write(path, valueOf(control, key)));
  control.addEventListener("blur", field.show);
  control.disabled = readOnly;
  field.show();
  known.add(field);
  return field;
}

/** Puts fields where a page has `data-path` for them. */
export function fillIn() {
  for (const place of document.querySelectorAll("[data-fields] [data-path]")) {
    const { path } = place.dataset, name = place.textContent;
    call(path, name);
    place.replaceWith(setting(path, name));
  }
}

const capital = (text) => text[0].toUpperCase() + text.slice(1);
const blank = (keys) => {
  const item = {};
  for (const [name, { default: usual }] of keys) {
    const names = name.split("."), last = names.pop();
    names.reduce((object, each) => (object[each] ??= {}), item)[last] = usual ?? "";
  }
  return item;
};

/** A list of settings at `place`: an item can be added and removed. */
export function listOf(place) {
  const { list: path, item, add } = place.dataset;
  const start = `${path}[].`;
  const keys = [...draft.keys].filter(([key]) => key.startsWith(start)).map(([key, row]) => [key.slice(start.length), row]);
  const rows = make("div.items"), more = make("button", add);
  more.type = "button";
  place.append(rows, make("div.answers", more));
  let shown = 0;

  const row = (i) => {
    const remove = make("button", "Remove");
    remove.type = "button";
    remove.setAttribute("aria-label", `Remove: ${item} ${i + 1}`);
    remove.addEventListener("click", () => {
      write(path, read(path).filter((_, each) => each !== i));
      (rows.children[i]?.querySelector("input") ?? more).focus();
    });
    const fields = keys.map(([name]) => setting(`${path}[${i}].${name}`, capital(name.replace(".", " "))));
    return make("fieldset.item", make("legend", `${item} ${i + 1}`), make("div.fields", ...fields), ...(readOnly ? [] : [remove]));
  };
  const show = () => {
    const count = read(path).length;
    if (count === shown) return;
    shown = count;
    for (const field of rows.querySelectorAll(".field")) known.delete(field);
    rows.replaceChildren(...Array.from({ length: count }, (_, i) => row(i)));
  };
  more.hidden = readOnly;
  more.addEventListener("click", () => {
    write(path, [...read(path), blank(keys)]);
    rows.lastElementChild.querySelector("input").focus();
  });
  onDraft(show);
  show();
}

/** Says at each field what is wrong with it; gives the errors with their fields, where there is one. */
export function blameAll(errors) {
  const placed = errors.map((error) => ({ ...error, field: fieldOf(error.path) }));
  for (const field of known) blame(field, placed.filter((each) => each.field === field).map(({ what }) => what).join(". "));
  return placed;
}

/** The field of a path, or the first one under it ("team.listen[1]"). */
export function fieldOf(path) {
  const all = [...known].filter((field) => field.isConnected);
  return all.find((field) => field.dataset.path === path) ?? all.find((field) => field.dataset.path.startsWith(path));
}

onDraft((what) => {
  if (what === "begun") for (const field of known) field.show();
});

// What has a place of its own, or none: the layout's version.
const ELSEWHERE = /\[\]|^version$|^command_post\.(course|scoring|mapping)|^network\.allow_overlap$/;

/** All the other settings, made of what the box tells of its keys. */
export function showAll() {
  const section = document.getElementById("step-all");
  const place = section.querySelector(".all"), search = section.querySelector("input"), empty = section.querySelector(".empty");
  const groups = grouped([...draft.keys.keys()].filter((path) => !ELSEWHERE.test(path)), (path) => path.split(".")[0]);
  for (const [name, paths] of groups) {
    const fields = paths.map((path) => setting(path, nameOf(path), path));
    place.append(make("fieldset", make("legend", name.replace("_", " ")), make("div.fields", ...fields)));
  }
  search.addEventListener("input", () => {
    const words = search.value.toLowerCase().split(/\s+/);
    const isFound = (text) => words.every((word) => text.includes(word));
    for (const field of place.querySelectorAll(".field")) field.hidden = !isFound(field.textContent.toLowerCase());
    for (const group of place.children) group.hidden = !group.querySelector(".field:not([hidden])");
    const found = place.querySelectorAll(".field:not([hidden])").length;
    say(empty, !search.value ? "" : found ? `${found} found.` : "No setting matches.");
  });
}
