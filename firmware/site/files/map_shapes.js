// How markers look from above: each in its size in metres and its colours, but never too small to be seen. What is
// invisible (alpha 0) shows as an outline. Of those that are but dots from here, one stands for all at its place.

import { themeNow } from "./theme_now.js";

const LEAST = 3; // units from the middle
const [ARROW, CUBE, SPHERE, CYLINDER, LINE_STRIP, LINE_LIST, CUBE_LIST, SPHERE_LIST, POINTS, , MESH, TRIANGLES] = Array(12).keys();
const FINEST = 2; // pixels: a line's next point is not drawn where it is nearer

const two = (value) => Math.round(255 * Math.min(1, Math.max(0, value)));
/** A team's colour, as the theme has it: at night as light as it is, but red. */
export function css({ r, g, b, a }) {
  if (themeNow() !== "red") return `rgb(${two(r)} ${two(g)} ${two(b)} / ${a})`;
  const light = 0.3 * r + 0.6 * g + 0.1 * b;
  return `rgb(${two(0.35 + 0.65 * light)} ${two(0.08 + 0.34 * light)} ${two(0.06 + 0.28 * light)} / ${a})`;
}
const parts = /^#(..)(..)(..)(..)$/;
const ofHex = (colour) => {
  const [r, g, b, a] = parts.exec(colour).slice(1).map((part) => parseInt(part, 16) / 255);
  return css({ r, g, b, a });
};
const isSeen = (colour) => !/( 0\)|^#.{6}00)$/.test(colour);

/** A view to draw on; `unit` is in pixels, by the size of the page's letters. */
class Sheet {
  paint; colours; view; unit;
  constructor(paint, colours, view, unit) {
    Object.assign(this, { paint, colours, view, unit });
  }
  metres = (value) => Math.abs(value) * this.view.scale;
  half = (value) => Math.max(LEAST * this.unit, this.metres(value) / 2);
  place = ({ points }, i) => this.view.toPixel({ x: points[2 * i], y: points[2 * i + 1] });

  /** Draws the parts of a marker, those of one colour at a time: `trace(i)` adds a part to the path. */
  parts({ color, colors }, count, trace, finish) {
    const own = css(color), isNight = themeNow() === "red";
    const colourOf = (i) => (colors[i] === undefined ? own : isNight ? ofHex(colors[i]) : colors[i]);
    for (let i = 0; i < count; ) {
      const colour = colourOf(i);
      this.paint.beginPath();
      do trace(i++);
      while (i < count && colourOf(i) === colour);
      finish(colour);
    }
  }
  /** A line with a rim that sets it off from any map. */
  line(width) {
    return (colour) => {
      const { paint, colours, unit } = this;
      paint.setLineDash(isSeen(colour) ? [] : [4 * unit, 3 * unit]);
      for (const [lineWidth, strokeStyle, globalAlpha] of [[width + 2 * unit, colours.ground, 0.5], [width, isSeen(colour) ? colour : colours.soft, 1]]) {
        Object.assign(paint, { lineWidth, strokeStyle, globalAlpha });
        paint.stroke();
      }
      paint.setLineDash([]);
    };
  }
  /** A filled shape with a rim. */
  solid = (colour) => {
    const { paint, colours, unit } = this;
    Object.assign(paint, { fillStyle: colour, lineWidth: unit, strokeStyle: isSeen(colour) ? colours.ground : colours.soft });
    paint.fill();
    paint.stroke();
  };
  polygon(corners) {
    corners.forEach(([x, y], i) => (i ? this.paint.lineTo(x, y) : this.paint.moveTo(x, y)));
    this.paint.closePath();
  }
  box([left, top], along, across, heading) {
    const c = Math.cos(heading), s = Math.sin(heading);
    this.polygon([[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => [left + a * along * c + b * across * s, top - a * along * s + b * across * c]));
  }
  round([left, top], along, across, heading) {
    this.paint.moveTo(left + along * Math.cos(heading), top - along * Math.sin(heading));
    this.paint.ellipse(left, top, along, across, -heading, 0, 2 * Math.PI);
  }
}

function dot(sheet, place, colour) {
  sheet.paint.beginPath();
  sheet.box(place, LEAST * sheet.unit, LEAST * sheet.unit, Math.PI / 4);
  sheet.solid(colour);
}

function strip(sheet, marker) {
  const { paint } = sheet, count = marker.points.length / 2 - 1;
  if (!count) return dot(sheet, sheet.place(marker, 0), marker.colors[0] ? ofHex(marker.colors[0]) : css(marker.color)); // it has but begun
  const finish = sheet.line(Math.max(1.75 * sheet.unit, sheet.metres(marker.scale.x)));
  let last = sheet.place(marker, 0), begun = true;
  sheet.parts(marker, count, (i) => {
    if (begun) paint.moveTo(...last);
    begun = false;
    const next = sheet.place(marker, i + 1);
    if (Math.hypot(next[0] - last[0], next[1] - last[1]) < FINEST && i + 1 < count) return;
    paint.lineTo(...(last = next));
  }, (colour) => {
    finish(colour);
    begun = true;
  });
}

const lines = (sheet, marker) =>
  sheet.parts(marker, marker.points.length / 4, (i) => {
    sheet.paint.moveTo(...sheet.place(marker, 2 * i));
    sheet.paint.lineTo(...sheet.place(marker, 2 * i + 1));
  }, sheet.line(Math.max(1.75 * sheet.unit, sheet.metres(marker.scale.x))));

const triangles = (sheet, marker) =>
  sheet.parts(marker, marker.points.length / 6, (i) => sheet.polygon([0, 1, 2].map((corner) => sheet.place(marker, 3 * i + corner))),
    sheet.line(1.75 * sheet.unit));

/** Many of one shape: `turned` where the pose turns it. */
const many = (shape, turned) => (sheet, marker) => {
  const { x, y } = marker.scale, least = 1.5 * sheet.unit;
  const along = Math.max(least, sheet.metres(x) / 2), across = Math.max(least, sheet.metres(y || x) / 2);
  sheet.parts(marker, marker.points.length / 2, (i) => sheet[shape](sheet.place(marker, i), along, across, turned ? marker.heading : 0), sheet.solid);
};

const one = (shape) => (sheet, { position, heading, scale, color }) => {
  sheet.paint.beginPath();
  sheet[shape](sheet.view.toPixel(position), sheet.half(scale.x), sheet.half(scale.y || scale.x), heading);
  sheet.solid(css(color));
};

/** From `tail` to `tip`, in pixels; half as wide as `shaft` and `head` on either side. */
function drawArrow(sheet, [left, top], [right, bottom], shaft, head, headLength, colour) {
  const length = Math.hypot(right - left, bottom - top) || 1, along = [(right - left) / length, (bottom - top) / length];
  const neck = Math.max(0, length - headLength);
  const at = (far, aside) => [left + along[0] * far - along[1] * aside, top + along[1] * far + along[0] * aside];
  sheet.paint.beginPath();
  sheet.polygon([at(0, -shaft), at(neck, -shaft), at(neck, -head), at(length, 0), at(neck, head), at(neck, shaft), at(0, shaft)]);
  sheet.solid(colour);
}

function arrow(sheet, marker) {
  const { scale, color, position, heading, points } = marker, { unit } = sheet;
  if (points.length) { // the scale is the shaft's and the head's width, and the head's length
    const [tail, tip] = [0, 1].map((i) => sheet.place(marker, i)), length = Math.hypot(tip[0] - tail[0], tip[1] - tail[1]);
    const head = Math.max(LEAST * unit, sheet.metres(scale.y) / 2);
    const headLength = Math.max(2 * LEAST * unit, scale.z ? sheet.metres(scale.z) : length / 4);
    return drawArrow(sheet, tail, tip, Math.max(unit, sheet.metres(scale.x) / 2), head, headLength, css(color));
  }
  const tail = sheet.view.toPixel(position), long = 2 * sheet.half(scale.x), wide = sheet.half(scale.y || scale.x);
  drawArrow(sheet, tail, [tail[0] + long * Math.cos(heading), tail[1] - long * Math.sin(heading)], wide / 3, wide, long * 0.35, css(color));
}

/** A box seen from a corner; what it stands for is written beside it. */
function mesh(sheet, { position, color }) {
  const [left, top] = sheet.view.toPixel(position), size = 7 * sheet.unit;
  const corner = (i) => [left + size * Math.sin((i * Math.PI) / 3), top - size * Math.cos((i * Math.PI) / 3)];
  sheet.paint.beginPath();
  sheet.polygon([0, 1, 2, 3, 4, 5].map(corner));
  sheet.solid(css(color));
  sheet.paint.beginPath();
  for (const i of [1, 3, 5]) {
    sheet.paint.moveTo(left, top);
    sheet.paint.lineTo(...corner(i));
  }
  sheet.paint.stroke();
}

const SHAPES = {
  [ARROW]: arrow, [CUBE]: one("box"), [SPHERE]: one("round"), [CYLINDER]: one("round"), [LINE_STRIP]: strip, [LINE_LIST]: lines,
  [CUBE_LIST]: many("box", true), [SPHERE_LIST]: many("round", true), [POINTS]: many("box", false), [MESH]: mesh, [TRIANGLES]: triangles,
};
/** Made of points, and has none: a dot where it is. */
const bare = (sheet, { position, color }) => dot(sheet, sheet.view.toPixel(position), css(color));

const isNear = (seen, { left, right, bottom, top }, rim) =>
  left < seen.right + rim && right > seen.left - rim && bottom < seen.top + rim && top > seen.bottom - rim;

/** Of markers that are but dots from here, the newest of those that fall on one place: {markers that are drawn}, in their order. */
function thinned(markers, view, side) {
  const taken = new Set();
  const isKept = ({ bounds: { left, right, bottom, top } }) => {
    if (Math.max(right - left, top - bottom) * view.scale > side) return true;
    const [x, y] = view.toPixel({ x: (left + right) / 2, y: (bottom + top) / 2 }), place = `${Math.floor(x / side)} ${Math.floor(y / side)}`;
    return !taken.has(place) && taken.add(place);
  };
  return [...markers].reverse().filter(isKept).reverse();
}

/** `unit`: pixels, by the size of the page's letters. */
export function drawShapes(paint, colours, view, markers, unit) {
  const seen = view.bounds(), rim = (24 * unit) / view.scale;
  paint.lineJoin = "round";
  const sheet = new Sheet(paint, colours, view, unit);
  const near = markers.filter(({ bounds }) => isNear(seen, bounds, rim));
  for (const marker of thinned(near, view, 2 * LEAST * unit)) (marker.needsPoints ? bare : SHAPES[marker.type])?.(sheet, marker);
}
