// Ticks at the slider of time: reports above its line, alarms below.
import { themeColours } from "./map_theme.js";

const THUMB = 8; // pixels: half of the slider's, which its line ends within
const NEAR = 3; // pixels: two ticks are one

const SHAPES = {
  bad: [[-1, -1], [1, 1], [0, 0], [1, -1], [-1, 1]],
  ask: [[0, -1.2], [1.2, 0], [0, 1.2], [-1.2, 0], [0, -1.2]],
};

/** A line with the shape of its level at the outer end. */
function drawTick(ctx, colours, x, outer, inner, level) {
  ctx.strokeStyle = colours[level] ?? colours.soft;
  ctx.beginPath();
  ctx.moveTo(x, outer);
  ctx.lineTo(x, inner);
  ctx.stroke();
  const shape = SHAPES[level];
  if (!shape) return;
  ctx.beginPath();
  for (const [a, b] of shape) ctx.lineTo(x + 3 * a, outer + 3 * b);
  ctx.stroke();
}

/** `ticks`: {reports, alarms}, each [{at, level}]; `first` and `last`: the times at both ends. */
export function drawTicks(canvas, { reports, alarms }, first, last) {
  const density = devicePixelRatio || 1, { clientWidth: width, clientHeight: height } = canvas;
  if (!width) return;
  Object.assign(canvas, { width: Math.round(width * density), height: Math.round(height * density) });
  const ctx = canvas.getContext("2d"), colours = themeColours(document.documentElement);
  ctx.scale(density, density);
  ctx.lineWidth = 2;
  const row = (all, outer, inner) => {
    let before = -Infinity;
    for (const { at, level } of [...all].sort((a, b) => a.at - b.at)) {
      const x = THUMB + ((at - first) / Math.max(1, last - first)) * (width - 2 * THUMB);
      if (at < first || at > last || (x - before < NEAR && level !== "ask")) continue;
      drawTick(ctx, colours, x, outer, inner, level);
      before = x;
    }
  };
  row(reports, 5, height / 2 - 6);
  row(alarms, height - 5, height / 2 + 6);
}
