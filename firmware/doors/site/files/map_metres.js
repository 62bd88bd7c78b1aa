// The grid in metres: lines with the ground, their figures at the edges, the origin, and a line of a round length.
import { metres } from "./words.js";

const MIN_STEP = 84; // pixels between two lines
const TOOLS = 64; // pixels above, where the choice of a robot stands
const NAMES = 5; // of six letters or less: room that a figure takes, in letters

const minus = (n) => String(n).replace("-", "−");

/** 1, 2 or 5 times a power of ten: metres between two lines. */
export function stepOf(scale) {
  const least = MIN_STEP / scale, power = 10 ** Math.floor(Math.log10(least));
  return power * ([1, 2, 5].find((n) => n * power >= least) ?? 10);
}

/** The multiples of `step` in between. */
function* multiples(from, to, step) {
  for (let i = Math.ceil(from / step); i * step <= to; ++i) yield Number((i * step).toPrecision(12));
}

export function drawGridLines(ctx, colours, view) {
  const { left, right, bottom, top } = view.bounds(), step = stepOf(view.scale);
  ctx.beginPath();
  for (const x of multiples(left, right, step)) {
    const at = Math.round(view.toPixel({ x, y: 0 })[0]) + 0.5;
    ctx.moveTo(at, 0);
    ctx.lineTo(at, view.height);
  }
  for (const y of multiples(bottom, top, step)) {
    const at = Math.round(view.toPixel({ x: 0, y })[1]) + 0.5;
    ctx.moveTo(0, at);
    ctx.lineTo(view.width, at);
  }
  Object.assign(ctx, { lineWidth: 1, strokeStyle: colours.edge, globalAlpha: 0.22 });
  ctx.stroke();
  ctx.globalAlpha = 1;
}

/** Where x and y are 0: a ring, and the way of both axes. */
export function drawOrigin(ctx, colours, view, unit) {
  const [left, top] = view.toPixel({ x: 0, y: 0 });
  ctx.lineCap = "round";
  for (const [width, colour] of [[5, colours.ground], [2, colours.ink]]) {
    Object.assign(ctx, { lineWidth: width * unit, strokeStyle: colour });
    ctx.beginPath();
    ctx.arc(left, top, 5 * unit, 0, 2 * Math.PI);
    ctx.moveTo(left + 5 * unit, top);
    ctx.lineTo(left + 20 * unit, top);
    ctx.moveTo(left, top - 5 * unit);
    ctx.lineTo(left, top - 20 * unit);
    ctx.stroke();
  }
  ctx.lineCap = "butt";
}

/** How text is written that any map may lie below. */
const textStyle = (colours, weight, size, fillStyle) => ({
  font: `${weight} ${size}px system-ui, sans-serif`,
  textBaseline: "middle",
  lineJoin: "round",
  lineWidth: size / 3,
  strokeStyle: colours.ground,
  fillStyle,
});

function write(ctx, text, left, top, align) {
  ctx.textAlign = align;
  ctx.strokeText(text, left, top);
  ctx.fillText(text, left, top);
}

const fontOf = (size) => Math.max(11, size * 0.86);

/** The figures of the lines, below and at the left: [text, left, top, align]; those that would stand upon the scale are left out. */
function* gridLabelsOf(view, size) {
  const { left, right, bottom, top } = view.bounds(), step = stepOf(view.scale), small = fontOf(size);
  for (const x of multiples(left, right, step)) {
    const [at] = view.toPixel({ x, y: 0 });
    if (at > NAMES * small && at < view.width - 2 * small) yield [minus(x), at, view.height - small * 0.8, "center"];
  }
  for (const y of multiples(bottom, top, step)) {
    const at = view.toPixel({ x: 0, y })[1];
    if (at > TOOLS && at < view.height - 4.5 * small) yield [minus(y), small * 0.4, at, "left"];
  }
}

export function drawGridLabels(ctx, colours, view, size) {
  Object.assign(ctx, textStyle(colours, 500, fontOf(size), colours.soft));
  for (const [text, left, top, align] of gridLabelsOf(view, size)) write(ctx, text, left, top, align);
  ctx.textAlign = "left";
}

const scaleOf = (view, size) => ({ length: stepOf(view.scale), left: size * 0.5, top: view.height - size * 2.4 });

/** What figures and scale take: [left, top, right, bottom], pixels of the view. */
export function* gridLabelBoxes(view, size) {
  const small = fontOf(size), letter = small * 0.62;
  for (const [text, left, top, align] of gridLabelsOf(view, size)) {
    const from = align === "center" ? left - text.length * letter / 2 : left;
    yield [from, top - small * 0.6, from + text.length * letter, top + small * 0.6];
  }
  const { length, left, top } = scaleOf(view, size);
  yield [left, top - size * 0.7, left + length * view.scale + size * 4, top + size * 0.7];
}

/** A line of a round length in the corner, above the figures. */
export function drawScaleBar(ctx, colours, view, size) {
  const { length, left, top } = scaleOf(view, size), width = length * view.scale;
  for (const [line, colour] of [[6, colours.ground], [2.5, colours.ink]]) {
    Object.assign(ctx, { lineWidth: line, strokeStyle: colour });
    ctx.beginPath();
    ctx.moveTo(left, top);
    ctx.lineTo(left + width, top);
    ctx.stroke();
  }
  Object.assign(ctx, textStyle(colours, 600, size, colours.ink));
  write(ctx, `${length < 1 ? metres(length) : length} m`, left + width + size * 0.5, top, "left");
}
