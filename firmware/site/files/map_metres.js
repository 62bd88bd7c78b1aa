// The grid in metres: lines with the ground, their figures at the edges, the origin, and a line of a round length.
import { metres } from "./words.js";

const LEAST_STEP = 84; // pixels between two lines
const TOOLS = 64; // pixels above, where the choice of a robot stands
const NAMES = 5; // of six letters or less: room that a figure takes, in letters

const minus = (n) => String(n).replace("-", "−");

/** 1, 2 or 5 times a power of ten: metres between two lines. */
export function stepOf(scale) {
  const least = LEAST_STEP / scale, power = 10 ** Math.floor(Math.log10(least));
  return power * ([1, 2, 5].find((n) => n * power >= least) ?? 10);
}

/** The multiples of `step` in between. */
function* multiples(from, to, step) {
  for (let i = Math.ceil(from / step); i * step <= to; ++i) yield Number((i * step).toPrecision(12));
}

export function drawLines(paint, colours, view) {
  const { left, right, bottom, top } = view.bounds(), step = stepOf(view.scale);
  paint.beginPath();
  for (const x of multiples(left, right, step)) {
    const at = Math.round(view.toPixel({ x, y: 0 })[0]) + 0.5;
    paint.moveTo(at, 0);
    paint.lineTo(at, view.height);
  }
  for (const y of multiples(bottom, top, step)) {
    const at = Math.round(view.toPixel({ x: 0, y })[1]) + 0.5;
    paint.moveTo(0, at);
    paint.lineTo(view.width, at);
  }
  Object.assign(paint, { lineWidth: 1, strokeStyle: colours.edge, globalAlpha: 0.22 });
  paint.stroke();
  paint.globalAlpha = 1;
}

/** Where x and y are 0: a ring, and the way of both axes. */
export function drawOrigin(paint, colours, view, unit) {
  const [left, top] = view.toPixel({ x: 0, y: 0 });
  paint.lineCap = "round";
  for (const [width, colour] of [[5, colours.ground], [2, colours.ink]]) {
    Object.assign(paint, { lineWidth: width * unit, strokeStyle: colour });
    paint.beginPath();
    paint.arc(left, top, 5 * unit, 0, 2 * Math.PI);
    paint.moveTo(left + 5 * unit, top);
    paint.lineTo(left + 20 * unit, top);
    paint.moveTo(left, top - 5 * unit);
    paint.lineTo(left, top - 20 * unit);
    paint.stroke();
  }
  paint.lineCap = "butt";
}

function write(paint, colours, text, left, top, align) {
  paint.textAlign = align;
  paint.strokeText(text, left, top);
  paint.fillText(text, left, top);
}

const fontOf = (size) => Math.max(11, size * 0.86);

/** The figures of the lines, below and at the left: [text, left, top, align]; those that would stand upon the scale are left out. */
function* figuresOf(view, size) {
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

export function drawFigures(paint, colours, view, size) {
  const small = fontOf(size);
  Object.assign(paint, { font: `500 ${small}px system-ui, sans-serif`, textBaseline: "middle", lineJoin: "round", lineWidth: small / 3, strokeStyle: colours.ground, fillStyle: colours.soft });
  for (const figure of figuresOf(view, size)) write(paint, colours, ...figure);
  paint.textAlign = "left";
}

const scaleOf = (view, size) => ({ length: stepOf(view.scale), left: size * 0.5, top: view.height - size * 2.4 });

/** What figures and scale take: [left, top, right, bottom], pixels of the view. */
export function* takenByMetres(view, size) {
  const small = fontOf(size), letter = small * 0.62;
  for (const [text, left, top, align] of figuresOf(view, size)) {
    const from = align === "center" ? left - text.length * letter / 2 : left;
    yield [from, top - small * 0.6, from + text.length * letter, top + small * 0.6];
  }
  const { length, left, top } = scaleOf(view, size);
  yield [left, top - size * 0.7, left + length * view.scale + size * 4, top + size * 0.7];
}

/** A line of a round length in the corner, above the figures. */
export function drawScale(paint, colours, view, size) {
  const { length, left, top } = scaleOf(view, size), width = length * view.scale;
  for (const [line, colour] of [[6, colours.ground], [2.5, colours.ink]]) {
    Object.assign(paint, { lineWidth: line, strokeStyle: colour });
    paint.beginPath();
    paint.moveTo(left, top);
    paint.lineTo(left + width, top);
    paint.stroke();
  }
  Object.assign(paint, { font: `600 ${size}px system-ui, sans-serif`, textBaseline: "middle", lineJoin: "round", lineWidth: size / 3, strokeStyle: colours.ground, fillStyle: colours.ink });
  write(paint, colours, `${length < 1 ? metres(length) : length} m`, left + width + size * 0.5, top, "left");
}
