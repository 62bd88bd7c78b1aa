// Composes a report by hand, in place of the list of reports: type, place, a check for earlier reports there, send.
// The map does not move: a tap on it sets the place, and no dialog opens under the finger.
import { ACCEPTED, barred, tell } from "./actions.js";
import { icon } from "./artifact_icons.js";
import { notesOn } from "./check.js";
import { list, make, mark, say } from "./dom.js";
import { heightNote, heightsAt, heightWords, REACH } from "./height.js";
import { map } from "./map_controls.js";
import { sameAs } from "./near.js";
import { reveal } from "./reports.js";
import { post } from "./session.js";
import { closeSide, openSide, side, whenSide } from "./side.js";
import { clip, metres, numberIn } from "./words.js";

// ICD 5.2; embed.cmake puts the words of that file here.
const TYPES = ["artifact_types.inc"];
const AXES = ["x", "y", "z"];

const panel = document.getElementById("compose");
const at = (name) => panel.querySelector(`.${name}`);
const field = (axis) => panel.querySelector(`input[name=${axis}]`);
const again = panel.querySelector(".again input");
let view = null, type = "", step = "what", busy = false;
let old = null; // the held report that is corrected; null: the report is new
let height = null; // where z is from, as of heightsAt(); null: typed

const types = TYPES.map((name) => {
  const button = make("button.type", icon(name), make("span", name));
  button.addEventListener("click", () => choose(name));
  at("types").append(button);
  return { name, button };
});

function go(next) {
  step = next;
  at("types").hidden = step !== "what";
  at("place").hidden = step !== "where";
  at("check").hidden = step !== "check";
  say(panel.querySelector(".name"), old ? `Correct report ${old.number}` : "New report");
  say(panel.querySelector(".count"), { what: "choose a type", where: type, check: "check, then send" }[step]);
  for (const { name, button } of types) button.setAttribute("aria-pressed", String(name === type));
  complain(null);
  // The checked report is sent unchanged: from now on a tap on the map does not move the place.
  map.setTap(side() === "compose" && step !== "check" ? put : null);
}

function complain(error) {
  say(at("trouble"), error?.message ?? "");
  for (const axis of AXES) field(axis).setAttribute("aria-invalid", String(error?.field === field(axis)));
  error?.field?.focus();
}

/** Where, as it is typed; throws what is wrong with which field. */
function typed() {
  const position = {};
  for (const axis of AXES) {
    const text = field(axis).value.trim();
    position[axis] = numberIn(text);
    if (!Number.isFinite(position[axis])) {
      const got = text ? `, got ${clip(text, 40)}` : "";
      throw Object.assign(new Error(`${axis}: expected metres, such as 12.5${got}.`), { field: field(axis) });
    }
  }
  return position;
}

const isPlaced = () => AXES.every((axis) => field(axis).value);

function choose(name) {
  type = name;
  if (isPlaced()) return check();
  go("where");
  panel.querySelector("h2").focus();
}

/** A tap on the map. The height is of this place: what was typed for another one is gone. */
function put({ x, y }) {
  field("x").value = x.toFixed(2);
  field("y").value = y.toFixed(2);
  map.setCross({ x, y });
  const tracks = map.tracks(), heights = tracks ? heightsAt({ x, y }, tracks) : [];
  if (heights.length === 1) setHeight(heights[0]);
  else if (heights.length) setHeight(null, `The heights within ${REACH} m of this place differ: choose one, or type z.`, heights);
  else setHeight(null, tracks ? `No data within ${REACH} m of this place: type z.` : "The robots’ tracks have not loaded: type z, or tap again.");
  complain(null);
  if (step === "where" && isPlaced()) check();
}

/** Sets z from a track, or leaves it empty, with the reason and the heights to choose from. */
function setHeight(found, reason = "", choices = []) {
  height = found;
  field("z").value = found ? found.z.toFixed(2) : "";
  say(at("height"), found ? heightNote(found, view.now).text : reason);
  offerHeights(choices);
}

function offerHeights(choices) {
  at("heights").hidden = !choices.length;
  at("heights").replaceChildren(...choices.map((choice) => {
    const button = make("button", heightWords(choice, view.now));
    button.addEventListener("click", () => {
      setHeight(choice);
      check();
    });
    return button;
  }));
}

/** A height belongs to its place: once another x or y is typed, z is typed, too. */
function typedPlace() {
  if (height || at("height").textContent) setHeight(null, "Type z of this place.");
}

function typedHeight() {
  height = null;
  say(at("height"), "");
  offerHeights([]);
}

function check() {
  try {
    const position = typed();
    map.setCross(position);
    again.checked = false;
    go("check");
    showCheck();
    panel.querySelector("h2").focus();
  } catch (error) {
    if (step !== "where") go("where");
    complain(error);
  }
}

/** What is known of it changes while one looks at it; what is sent does not. */
function showCheck() {
  const position = typed(), { x, y, z } = position;
  if (at("picture").dataset.of !== type) at("picture").replaceChildren(icon(type));
  mark(at("picture"), "of", type);
  say(panel.querySelector(".summary .type"), type);
  say(panel.querySelector(".summary .where"), `at ${metres(x)}, ${metres(y)}, ${metres(z)} m`);
  say(at("send"), `Send ${type}`);
  const create = () => make("li", make("span.glyph"), make("span"));
  const notes = [heightNote(height, view.now), ...notesOn(view, { number: old?.number, type, position })];
  list(at("notes"), notes, ({ key }) => key, create, (node, { level, text }) => {
    mark(node.firstChild, "level", level);
    say(node.lastChild, text);
  });
  at("again").hidden = old !== null || !sameAs(view, { type, position });
  at("send").disabled = busy || Boolean(barred());
  say(panel.querySelector(".check .barred"), barred());
}

async function send() {
  const { x, y, z } = typed(), resubmit = !at("again").hidden && again.checked;
  const before = new Set(view.reports.map(({ number }) => number)); // the list may have it before the answer comes
  busy = at("send").disabled = true;
  try {
    const answer = old ? await post(`/adit/reports/${old.number}/correct`, { type, x, y, z }) : await post("/adit/reports", { type, x, y, z, resubmit });
    tell(answer.report, old ? `Corrects report ${old.number}.` : before.has(answer.report) ? "The box has the same report already: this one." : ACCEPTED);
    drop();
    revealSoon(answer.report);
  } catch (error) {
    complain(error);
  } finally {
    busy = false;
    at("send").disabled = Boolean(barred());
  }
}

/** The list has it with the next event. */
function revealSoon(number, tries = 20) {
  if (!reveal(number) && tries > 0) setTimeout(revealSoon, 100, number, tries - 1);
}

/** It is sent, or given up. */
function drop() {
  begin(null);
  closeSide();
}

/** With the values of a held report, or with none. */
function begin(report) {
  old = report;
  for (const axis of AXES) field(axis).value = report ? String(report.position[axis]) : "";
  typedHeight();
  type = report?.type ?? "";
  step = report ? "where" : "what";
}

/** Sends another report in the place of a held one. */
export function correct(report) {
  begin(report);
  openSide("compose");
}

/** Where it was left: what was chosen is kept until it is sent or cancelled. */
export function compose() {
  if (!view || barred()) return;
  if (old) begin(null);
  openSide("compose");
}

whenSide("compose", (isOpen) => {
  go(step === "check" ? "where" : step);
  const place = isOpen && field("x").value && field("y").value;
  map.setCross(place ? { x: numberIn(field("x").value), y: numberIn(field("y").value) } : null);
});

/** Follows the run: what is near may change, and whether anything can be sent. */
export function showCompose(next) {
  view = next;
  for (const button of document.querySelectorAll("button.compose")) button.disabled = Boolean(barred());
  if (side() === "compose" && step === "check") showCheck();
}

for (const button of document.querySelectorAll("button.compose")) button.addEventListener("click", compose);
for (const axis of ["x", "y"]) field(axis).addEventListener("input", typedPlace);
field("z").addEventListener("input", typedHeight);
at("go").addEventListener("click", check);
at("elsewhere").addEventListener("click", () => go("where"));
for (const button of panel.querySelectorAll(".change")) button.addEventListener("click", () => go("what"));
panel.querySelector(".head .close").addEventListener("click", drop);
at("send").addEventListener("click", send);
panel.addEventListener("keydown", (event) => {
  if (event.key !== "Enter" || event.target.type !== "text") return;
  event.preventDefault();
  check();
});
