// A press goes to the control under the finger when it began. A tap's click comes after the changes that the tap caused, and the
// second click of a double tap may find another control in the same place. So a control that has appeared or moved takes no press
// until it has been still for a while. A press that began elsewhere goes to the control on which it began if the finger kept its
// place, and is dropped otherwise. Every page has this.

const STILL = 500; // ms: the second tap of a double tap comes sooner
// pixels: a control that moved less has not moved
const MOVED = 8;
const FOLLOWS = 150; // ms: a page that scrolls so soon after a press was scrolled by that press
const CONTROLS = "button, a[href], input, select, textarea, label, summary, canvas[tabindex]";
const ACT = ["Enter", " ", "Escape"];

let places = null; // from a control to its middle; null: the page has just been loaded
const moving = new Map(); // from a control that takes no press yet to the time when it moved
let scrolled = false; // by hand: the eye followed the controls
let timer = 0, ended = -Infinity;

const opened = new Set(document.querySelectorAll("dialog[open]")); // the last one opened lies on top

function stack(records) {
  for (const { target, attributeName } of records) {
    if (attributeName !== "open" || target.localName !== "dialog") continue;
    opened.delete(target);
    if (target.open) opened.add(target);
  }
}

/** Behind an open dialog nothing can be pressed: it appears when that closes. */
const reachable = () => ([...opened].filter((dialog) => dialog.isConnected).at(-1) ?? document).querySelectorAll(CONTROLS);

/** Finds what appeared or moved since the last look. */
function look() {
  const before = places;
  places = new Map();
  for (const control of reachable()) {
    const { x, y, width, height } = control.getBoundingClientRect();
    if (!width || control.disabled) continue;
    const place = [x + width / 2, y + height / 2], last = before?.get(control);
    places.set(control, place);
    if (!before || (last && (scrolled || Math.hypot(place[0] - last[0], place[1] - last[1]) < MOVED))) continue;
    moving.set(control, performance.now());
    control.dataset.moving = ""; // page.css lets no pointer reach it
  }
  scrolled = false;
  observer.takeRecords(); // of these marks
  if (moving.size && !timer) timer = setTimeout(settle, STILL);
}

function settle() {
  const until = performance.now() - STILL;
  for (const [control, since] of moving) {
    if (since > until && control.isConnected) continue;
    moving.delete(control);
    delete control.dataset.moving;
  }
  observer.takeRecords();
  timer = moving.size ? setTimeout(settle, STILL / 4) : 0;
}

// The observer runs before any further input, the click of the current tap included.
const observer = new MutationObserver((records) => {
  stack(records);
  look();
});
observer.observe(document, { subtree: true, childList: true, characterData: true, attributes: true });
addEventListener("resize", look);
addEventListener("scroll", () => {
  if (performance.now() - ended < FOLLOWS) look();
  else scrolled = true;
}, { capture: true, passive: true });
look();

function drop(event) {
  event.preventDefault();
  event.stopImmediatePropagation();
}

/** A label and what it labels are one. */
function controlAt(node) {
  const control = node.closest?.(CONTROLS);
  return control?.control ?? control;
}

// What the pointer came down on (null: on nothing), and where; undefined: no press is under way.
let press, down;

addEventListener("pointerdown", (event) => {
  press = controlAt(event.target) ?? null;
  down = event;
}, true);
addEventListener("pointercancel", () => (press = undefined), true);
for (const name of ["mousedown", "click"]) {
  addEventListener(name, (event) => {
    if (!event.isTrusted || !event.detail) return; // a script's, a key's or a screen reader's
    const control = controlAt(event.target), began = press;
    if (control && began !== undefined && control !== began) drop(event);
    if (name !== "click") return;
    press = undefined;
    ended = performance.now();
    // It has moved away from under the finger:
    if (began && control !== began && places.has(began) && Math.hypot(event.x - down.x, event.y - down.y) < MOVED) began.click();
  }, true);
}

let held = null; // the control that had the focus when a key went down

/** A key that is held acts on nothing that gets the focus meanwhile, and one pressed twice on nothing that was just given it. */
addEventListener("keydown", (event) => {
  const isNew = "given" in event.target.dataset;
  if (!event.repeat && !isNew) held = event.target;
  else if ((isNew || event.target !== held) && ACT.includes(event.key)) drop(event);
}, true);
