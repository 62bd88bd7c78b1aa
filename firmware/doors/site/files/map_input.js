// Fingers, mouse and keys on the map.

const TAP = 8; // pixels: one finger that moves less is a tap
const STEP = 60; // pixels a key press moves

/** Moves `view` as it is told. Calls `moved()` after each change, `held(true or false)` as fingers come down and are lifted, and
 *  `tapped({x, y})` for a tap. */
export function listenTo(canvas, view, { moved, held, tapped, fit }) {
  const fingers = new Map(); // pointerId to [left, top]
  let travelled = 0, alone = true;

  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  /** @param {number[][]} places: of one finger, or of two */
  const middle = ([[a, b], [c, d] = [a, b]]) => [(a + c) / 2, (b + d) / 2];
  /** @param {number[][]} places */
  const apart = ([[a, b], [c, d] = [a, b]]) => Math.hypot(a - c, b - d);

  canvas.addEventListener("pointerdown", (event) => {
    if (event.button > 0) return;
    alone = !fingers.size;
    if (alone) travelled = 0;
    fingers.set(event.pointerId, at(event));
    held(true);
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!fingers.has(event.pointerId)) return;
    const before = [...fingers.values()];
    fingers.set(event.pointerId, at(event));
    const after = [...fingers.values()];
    const [left, top] = middle(before), [newLeft, newTop] = middle(after);
    travelled += Math.hypot(newLeft - left, newTop - top) + Math.abs(apart(after) - apart(before));
    if (travelled < TAP) return;
    view.pan(newLeft - left, newTop - top);
    if (after.length > 1 && apart(before) > 0) view.zoom(apart(after) / apart(before), newLeft, newTop);
    moved();
  });
  const up = (event) => {
    const was = fingers.delete(event.pointerId);
    if (was && !fingers.size) held(false);
    if (was && alone && travelled < TAP && event.type === "pointerup") tapped(view.toMetres(...at(event)));
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);

  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 24 : 1;
    view.zoom(2 ** ((-event.deltaY * lines) / 240), ...at(event));
    moved();
  }, { passive: false });

  const keys = {
    ArrowLeft: () => view.pan(STEP, 0),
    ArrowRight: () => view.pan(-STEP, 0),
    ArrowUp: () => view.pan(0, STEP),
    ArrowDown: () => view.pan(0, -STEP),
    "+": () => view.zoom(1.5),
    "=": () => view.zoom(1.5),
    "-": () => view.zoom(1 / 1.5),
    Enter: () => tapped(view.centre),
  };
  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || (!keys[event.key] && event.key !== "f")) return;
    event.preventDefault();
    event.stopPropagation();
    if (event.key === "f") return fit();
    keys[event.key]();
    moved();
  });
}
