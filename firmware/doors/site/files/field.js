// One setting as a field: its meaning, its allowed values, its error.
import { makeCard, openAround, openFound } from "./card.js";
import { make, say } from "./dom.js";
import { draft, keyOf, onDraft, read, same, write } from "./draft.js";
import { grouped } from "./grouped.js";
import { label as call, nameOf, partsOf, spoken } from "./names.js";
import { styleOf } from "./robot_colour.js";
import { addCard, stateOfGroup } from "./setup_cards.js";
import { whenThemeChanges } from "./theme_now.js";
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
  control.addEventListener("blur", () => {
    if (!field.isRevealed) reveal(field);
  });
  return Object.assign(field, { label, control, wrong, what: "", isRevealed: false });
}

/** Opens what the field is behind. */
export function uncover(field) {
  field.closest(".rare")?.isOpen(true);
  openAround(field);
}

/** Says at a field what is wrong; "": nothing is. An error first shows when the field loses the focus: nobody has finished typing before. */
export function blame(field, what) {
  field.what = what;
  const isWrong = what !== "" && field.isRevealed;
  if (isWrong && !field.control.hasAttribute("aria-invalid")) uncover(field);
  say(field.wrong, isWrong ? `${field.label}: ${spoken(what)}` : "");
  if (isWrong) field.control.setAttribute("aria-invalid", "true");
  else field.control.removeAttribute("aria-invalid");
}

/** Shows the field's errors from now on; the document hears "revealed". */
export function reveal(field) {
  field.isRevealed = true;
  blame(field, field.what);
  document.dispatchEvent(new Event("revealed"));
}

export const revealAll = () => known.forEach(reveal);

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

/** The field of the setting at `path`. */
function setting(path, label) {
  const key = keyOf(path), control = controlOf(key);
  const field = labelled(label, control, spoken(hintOf(key)));
  field.dataset.path = path;
  field.show = () => {
    const value = read(path);
    if (value === undefined) return;
    if (path.endsWith(".colour")) control.style.setProperty("--robot", value === "auto" ? "" : styleOf(key.words.indexOf(value) - 1));
    if (document.activeElement === control || same(valueOf(control, key), value)) return; // as it is typed
    if (key.kind === "flag") control.checked = value;
    else control.value = value;
  };
  control.addEventListener("input", () => {
    write(path, valueOf(control, key));
    field.show();
  });
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

const PORT = 8000; // of the Command Post (ICD 3), and of a new address of the box
const capital = (text) => text[0].toUpperCase() + text.slice(1);
const blank = (keys) => {
  const item = {};
  for (const [name, { default: usual }] of keys) {
    const names = name.split("."), last = names.pop();
    names.reduce((object, each) => (object[each] ??= {}), item)[last] = usual ?? (last === "port" ? PORT : "");
  }
  return item;
};

/** Opens and closes the rare fields of an item. */
function rareFields(fields) {
  const rare = make("div.fields.rare", ...fields), button = make("button.opens");
  rare.isOpen = (isOpen) => {
    rare.hidden = !isOpen;
    button.setAttribute("aria-expanded", String(isOpen));
  };
  rare.isOpen(false);
  const show = () => {
    const set = fields.filter(({ dataset: { path } }) => !same(read(path), keyOf(path).default)).length;
    say(button, set ? `Advanced (${set})` : "Advanced");
  };
  button.addEventListener("click", () => rare.isOpen(rare.hidden));
  rare.addEventListener("input", show);
  show();
  return [button, rare];
}

/** A list of settings at `place`: an item can be added and removed. Fields that `data-rare` names are closed at first. With `data-folds`, the
 *  title of a card, all fields of an item are in its card. */
export function listOf(place) {
  const { list: path, item, add, rare = "", folds } = place.dataset;
  const start = `${path}[].`;
  const keys = [...draft.keys].filter(([key]) => key.startsWith(start)).map(([key, row]) => [key.slice(start.length), row]);
  const labelOf = (name) => capital(partsOf(name));
  const [rareKeys, usualKeys] = [true, false].map((is) => keys.filter(([name]) => rare.split(" ").includes(name) === is));
  const titles = make("div.titles", ...usualKeys.map(([name]) => make("span", labelOf(name))));
  titles.setAttribute("aria-hidden", "true"); // each field has its label
  const rows = make("div.items"), more = make("button", add);
  place.append(titles, rows, make("div.answers", more));

  const row = (i) => {
    const remove = make("button.remove", "Remove");
    remove.setAttribute("aria-label", `Remove: ${item} ${i + 1}`);
    remove.addEventListener("click", () => {
      rows.replaceChildren(); // the paths of the rows after it are others now
      write(path, read(path).filter((_, each) => each !== i));
      (rows.children[i]?.querySelector("summary, input") ?? more).focus();
    });
    const fields = (of) => of.map(([name]) => setting(`${path}[${i}].${name}`, labelOf(name)));
    const usual = make("div.fields", ...fields(usualKeys)), others = rareKeys.length ? rareFields(fields(rareKeys)) : [];
    const inside = [usual, ...others, ...(readOnly ? [] : [remove])];
    return make("fieldset.item", make("legend", `${item} ${i + 1}`), ...(folds ? [makeCard(folds, ...inside)] : inside));
  };
  const show = () => {
    const count = read(path).length;
    if (count < rows.children.length) rows.replaceChildren();
    while (rows.children.length < count) rows.append(row(rows.children.length));
    titles.hidden = count === 0;
    for (const field of known) if (!field.isConnected) known.delete(field);
  };
  more.hidden = readOnly;
  more.addEventListener("click", () => {
    write(path, [...read(path), blank(keys)]);
    rows.lastElementChild.querySelector("input").focus();
  });
  onDraft(show);
  show();
}

/** Says at each field what is wrong with it; gives the errors that are shown, with their fields if they have one. */
export function blameAll(errors) {
  const placed = errors.map((error) => ({ ...error, field: fieldOf(error.path) }));
  for (const field of known) blame(field, placed.filter((each) => each.field === field).map(({ what }) => what).join(". "));
  return placed.filter(({ field }) => !field || field.isRevealed);
}

/** The field of a path, or the first one under it ("team.listen[1]"). */
export function fieldOf(path) {
  const all = [...known].filter((field) => field.isConnected);
  return all.find((field) => field.dataset.path === path) ?? all.find((field) => field.dataset.path.startsWith(path));
}

const showAllFields = () => known.forEach((field) => field.show());
whenThemeChanges(showAllFields);
onDraft((what) => {
  if (what === "begun") showAllFields();
});

// Settings that are shown elsewhere, or not at all: the layout's version.
const ELSEWHERE = /\[\]|^version$|^command_post\.(course|scoring|mapping)|^network\.allow_overlap$/;

/** All the other settings, made of what the box tells of its keys. */
export function showAll() {
  const section = document.getElementById("step-all");
  const place = section.querySelector(".all"), search = section.querySelector("input"), empty = section.querySelector(".empty");
  const groups = grouped([...draft.keys.keys()].filter((path) => !ELSEWHERE.test(path)), (path) => path.split(".")[0]);
  for (const [name, paths] of groups) {
    const fields = paths.map((path) => setting(path, nameOf(path)));
    addCard(place, `all-${name}`, nameOf(name), () => stateOfGroup(paths), make("div.fields", ...fields));
  }
  search.addEventListener("input", () => {
    const words = search.value.toLowerCase().split(/\s+/);
    const isFound = (text) => words.every((word) => text.includes(word));
    for (const field of place.querySelectorAll(".field")) field.hidden = !isFound(`${field.textContent} ${field.dataset.path}`.toLowerCase());
    for (const group of place.children) {
      group.hidden = !group.querySelector(".field:not([hidden])");
      openFound(group, search.value !== "" && !group.hidden);
    }
    const found = place.querySelectorAll(".field:not([hidden])").length;
    say(empty, !search.value ? "" : found ? `${found} found.` : "No setting matches.");
  });
}
