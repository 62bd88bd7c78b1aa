// A report composed by hand: what and where, then a look at what is there already, then send.
import { barred, tell } from "./actions.js";
import { open } from "./dialog.js";
import { make, say } from "./dom.js";
import { map, pick } from "./map_controls.js";
import { nearTo, sameAs } from "./near.js";
import { reveal } from "./reports.js";
import { post } from "./session.js";
import { life } from "./arriving.js";
import { ago, clip, metres } from "./words.js";

// ICD 5.2; embed.cmake puts the words of that file here.
const TYPES = ["artifact_types.inc"];
const AXES = ["x", "y", "z"];
const ROBOT_NEAR = 20; // m: so far a robot's height is a fair guess

const dialog = document.getElementById("compose");
const at = (name) => dialog.querySelector(`.${name}`);
const field = (axis) => dialog.querySelector(`input[name=${axis}]`);
let view = null;

for (const type of TYPES) {
  const radio = make("input");
  Object.assign(radio, { type: "radio", name: "type", value: type });
  at("types").append(make("label", radio, make("span", type)));
}

/** The report as it is typed, or throws what is wrong with which field. */
function typed() {
  const type = dialog.querySelector("input[name=type]:checked")?.value;
  if (!type) throw Object.assign(new Error("Choose what it is."), { field: dialog.querySelector("input[name=type]") });
  const position = {};
  for (const axis of AXES) {
    const text = field(axis).value.trim().replace("−", "-");
    position[axis] = Number(text);
    if (!/^[-+]?(\d+\.?\d*|\.\d+)$/.test(text) || !Number.isFinite(position[axis])) {
      throw Object.assign(new Error(`${axis}: expected metres, as in 12.5${text ? `, got ${clip(text, 40)}` : ""}.`), { field: field(axis) });
    }
  }
  return { type, position };
}

function complain(error) {
  say(at("trouble"), error?.message ?? "");
  for (const axis of AXES) field(axis).setAttribute("aria-invalid", String(error?.field === field(axis)));
  error?.field?.focus();
}

function step(name) {
  at("fields").hidden = name !== "fields";
  at("check").hidden = name !== "check";
  complain(null);
}

const named = (report) => `#${report.number} ${report.type}`;
const stands = (report) => `${life(report).word}, ${ago(view.now - report.received)}`;

/** What a person should know before it is sent. */
function notes(report) {
  const same = sameAs(view, report);
  const near = nearTo(view, report).filter(({ other }) => other.number !== same?.number);
  const left = view.run ? `${view.run.remaining_reports} reports are left.` : "How many reports are left is not known.";
  return [
    ...(same ? [`Reported already, at the very same place: ${named(same)}, ${stands(same)}. Sending it again changes nothing and costs nothing.`] : []),
    ...near.map(({ other, metres: apart }) => `Near: ${named(other)}, ${apart.toFixed(1)} m away, ${stands(other)}. It may be the same one.`),
    ...(same || near.length ? [] : [`No ${report.type} was reported within ${view.near_metres} m.`]),
    left,
  ];
}

function check() {
  try {
    const report = typed();
    const { x, y, z } = report.position;
    step("check");
    say(at("summary"), `${report.type} at ${metres(x)}, ${metres(y)}, ${metres(z)} m`);
    at("notes").replaceChildren(...notes(report).map((note) => make("li", note)));
    at("again").hidden = !sameAs(view, report);
    at("again").querySelector("input").checked = false;
    at("send").focus();
  } catch (error) {
    complain(error);
  }
}

async function send() {
  const report = typed();
  const before = new Set(view.reports.map(({ number }) => number)); // the list may have it before the answer comes
  at("send").disabled = true;
  try {
    const answer = await post("/adit/reports", { type: report.type, ...report.position, resubmit: at("again").querySelector("input").checked });
    tell(answer.report, before.has(answer.report) ? "The same was reported before: this is it." : "Taken; it is sent in its turn.");
    dialog.close();
    clear();
    revealSoon(answer.report);
  } catch (error) {
    complain(error);
  } finally {
    at("send").disabled = Boolean(barred());
  }
}

/** The list has it with the next event. */
function revealSoon(number, tries = 20) {
  if (!reveal(number) && tries > 0) setTimeout(revealSoon, 100, number, tries - 1);
}

function clear() {
  for (const input of dialog.querySelectorAll("input[type=text]")) input.value = "";
  for (const input of dialog.querySelectorAll("input[type=radio]")) input.checked = false;
  map.setCross(null);
}

function put({ x, y }) {
  field("x").value = x.toFixed(2);
  field("y").value = y.toFixed(2);
  map.setCross({ x, y });
  const [nearest] = view.robots
    .map(({ name, position }) => ({ name, z: position.z, apart: Math.hypot(position.x - x, position.y - y) }))
    .sort((a, b) => a.apart - b.apart);
  const known = nearest && nearest.apart < ROBOT_NEAR;
  if (known) field("z").value = nearest.z.toFixed(2);
  say(at("height"), known ? `z is ${nearest.name}’s, ${nearest.apart.toFixed(0)} m from there: correct it where it differs.` : "");
}

async function pickPlace() {
  dialog.close();
  const place = await pick("Tap the place, or move the map and press Enter.");
  if (place) put(place);
  step("fields");
  open(dialog);
}

export function compose() {
  if (!view || barred()) return;
  step("fields");
  open(dialog);
}

/** Follows the run: what is near may change, and whether anything can be sent. */
export function showCompose(next) {
  view = next;
  const reason = barred();
  for (const button of document.querySelectorAll("button.compose")) button.disabled = Boolean(reason);
  if (dialog.open) {
    at("send").disabled = Boolean(reason);
    say(at("barred"), reason);
  }
}

for (const button of document.querySelectorAll("button.compose")) button.addEventListener("click", compose);
at("pick").addEventListener("click", pickPlace);
at("go").addEventListener("click", check);
at("change").addEventListener("click", compose);
at("send").addEventListener("click", send);
dialog.addEventListener("keydown", (event) => {
  if (event.key !== "Enter" || event.target.tagName !== "INPUT" || at("fields").hidden) return;
  event.preventDefault();
  check();
});
