// Markers from above, in metres and in their colours, lines in less light ones; none is too small to be seen. An invisible one (alpha 0) is an
// outline. Of markers that are only dots from here, one stands for all at its place.

import { themeNow } from "./theme_now.js";

const MIN_HALF = 3; // units from the middle
const [ARROW, CUBE, SPHERE, CYLINDER, LINE_STRIP, LINE_LIST, CUBE_LIST, SPHERE_LIST, POINTS, , MESH, TRIANGLES] = Array(12).keys();
const LINE = [2, 3]; // units: the least and the most of a line's width, so that it hides no map
const MIN_STEP = 2; // pixels: a line's next point is not drawn if it is nearer

const byte = (value) => Math.round(255 * Math.min(1, Math.max(0, value)));
/** A team's colour, as the theme has it: at night as light as it is, but red. */
export function css({ r, g, b, a }) {
  if (themeNow() !== "red") return `rgb(${byte(r)} ${byte(g)} ${byte(b)} / ${a})`;
  const light = 0.3 * r + 0.6 * g + 0.1 * b;
  return `rgb(${byte(0.35 + 0.65 * light)} ${byte(0.08 + 0.34 * light)} ${byte(0.06 + 0.28 * light)} / ${a})`;
}
const HEX_COLOUR = /^#(..)(..)(..)(..)$/;
function ofHex(colour) {
  const [r, g, b, a] = HEX_COLOUR.exec(colour).slice(1).map((part) => parseInt(part, 16) / 255);
  return { r, g, b, a };
}
const LIGHTNESS = 0.4; // of a line's colour: lines are many, and lie over the map
/** A line's colour: nearer to the ground's. */
function dimmed({ r, g, b, a }) {
  const part = themeNow() === "light" ? (value) => 1 - LIGHTNESS * (1 - value) : (value) => LIGHTNESS * value;
  return css({ r: part(r), g: part(g), b: part(b), a });
}
const isSeen = (colour) => !/( 0\)|^#.{6}00)$/.test(colour);

/** A view to draw on; `unit` is in pixels, by the size of the page's letters. */
class Brush {
  ctx; colours; view; unit;
  constructor(ctx, colours, view, unit) {
    Object.assign(this, { ctx, colours, view, unit });
  }
  metres = (value) => Math.abs(value) * this.view.scale;
  half = (value) => Math.max(MIN_HALF * this.unit, this.metres(value) / 2);
  place = ({ points }, i) => this.view.toPixel({ x: points[2 * i], y: points[2 * i + 1] });

  /** Draws the parts of a marker, those of one colour at a time: `trace(i)` adds a part to the path. `look`: of a colour, how it is drawn. */
  parts({ color, colors }, count, trace, finish, look = css) {
    const own = look(color), looks = new Map(); // of the colours that points have
    const colourOf = (i) => {
      const its = colors[i];
      if (its === undefined) return own;
      if (!looks.has(its)) looks.set(its, look(ofHex(its)));
      return looks.get(its);
    };
    for (let i = 0; i < count; ) {
      const colour = colourOf(i);
      this.ctx.beginPath();
      do trace(i++);
      while (i < count && colourOf(i) === colour);
      finish(colour);
    }
  }
  /** A line of about that width, in pixels, with a rim that sets it off from any map. */
  line(wanted) {
    const width = Math.min(LINE[1] * this.unit, Math.max(LINE[0] * this.unit, wanted));
    return (colour) => {
      const { ctx, colours, unit } = this;
      ctx.setLineDash(isSeen(colour) ? [] : [4 * unit, 3 * unit]);
      Object.assign(ctx, { lineWidth: width + 2 * unit, strokeStyle: colours.ground, globalAlpha: 0.5 });
      ctx.stroke();
      Object.assign(ctx, { lineWidth: width, strokeStyle: isSeen(colour) ? colour : colours.soft, globalAlpha: 1 });
      ctx.stroke();
      ctx.setLineDash([]);
    };
  }
  /** A filled shape with a rim. */
  solid = (colour) => {
    const { ctx, colours, unit } = this;
    Object.assign(ctx, { fillStyle: colour, lineWidth: unit, strokeStyle: isSeen(colour) ? colours.ground : colours.soft });
    ctx.fill();
    ctx.stroke();
  };
  polygon(corners) {
    this.ctx.moveTo(...corners[0]);
    for (const corner of corners.slice(1)) this.ctx.lineTo(...corner);
    this.ctx.closePath();
  }
  box([left, top], along, across, heading) {
    const cos = Math.cos(heading), sin = Math.sin(heading);
    const corner = ([a, b]) => [left + a * along * cos + b * across * sin, top - a * along * sin + b * across * cos];
    this.polygon([[-1, -1], [1, -1], [1, 1], [-1, 1]].map(corner));
  }
  round([left, top], along, across, heading) {
    this.ctx.moveTo(left + along * Math.cos(heading), top - along * Math.sin(heading));
    this.ctx.ellipse(left, top, along, across, -heading, 0, 2 * Math.PI);
  }
}

function dot(brush, place, colour) {
  brush.ctx.beginPath();
  brush.box(place, MIN_HALF * brush.unit, MIN_HALF * brush.unit, Math.PI / 4);
  brush.solid(colour);
}

function strip(brush, marker) {
  const { ctx } = brush, count = marker.points.length / 2 - 1;
  if (!count) return dot(brush, brush.place(marker, 0), css(marker.colors[0] ? ofHex(marker.colors[0]) : marker.color));
  const finish = brush.line(brush.metres(marker.scale.x));
  let last = brush.place(marker, 0), begun = true;
  brush.parts(marker, count, (i) => {
    if (begun) ctx.moveTo(...last);
    begun = false;
    const next = brush.place(marker, i + 1);
    if (Math.hypot(next[0] - last[0], next[1] - last[1]) < MIN_STEP && i + 1 < count) return;
    ctx.lineTo(...(last = next));
  }, (colour) => {
    finish(colour);
    begun = true;
  }, dimmed);
}

const lines = (brush, marker) =>
  brush.parts(marker, marker.points.length / 4, (i) => {
    brush.ctx.moveTo(...brush.place(marker, 2 * i));
    brush.ctx.lineTo(...brush.place(marker, 2 * i + 1));
  }, brush.line(brush.metres(marker.scale.x)), dimmed);

const triangles = (brush, marker) =>
  brush.parts(marker, marker.points.length / 6, (i) => brush.polygon([0, 1, 2].map((corner) => brush.place(marker, 3 * i + corner))),
    brush.line(0), dimmed);

/** A shape at each point: `turned` where the pose turns it. */
const atEachPoint = (shape, turned) => (brush, marker) => {
  const { x, y } = marker.scale, least = 1.5 * brush.unit;
  const along = Math.max(least, brush.metres(x) / 2), across = Math.max(least, brush.metres(y || x) / 2);
  const heading = turned ? marker.heading : 0;
  const trace = (i) => brush[shape](brush.place(marker, i), along, across, heading);
  brush.parts(marker, marker.points.length / 2, trace, brush.solid);
};

const atPose = (shape) => (brush, { position, heading, scale, color }) => {
  brush.ctx.beginPath();
  brush[shape](brush.view.toPixel(position), brush.half(scale.x), brush.half(scale.y || scale.x), heading);
  brush.solid(css(color));
};

/** From `tail` to `tip`, in pixels; half as wide as `shaft` and `head` on either side. */
function drawArrow(brush, [left, top], [right, bottom], shaft, head, headLength, colour) {
  const length = Math.hypot(right - left, bottom - top) || 1, along = [(right - left) / length, (bottom - top) / length];
  const neck = Math.max(0, length - headLength);
  const at = (far, aside) => [left + along[0] * far - along[1] * aside, top + along[1] * far + along[0] * aside];
  brush.ctx.beginPath();
  brush.polygon([at(0, -shaft), at(neck, -shaft), at(neck, -head), at(length, 0), at(neck, head), at(neck, shaft), at(0, shaft)]);
  brush.solid(colour);
}

function arrow(brush, marker) {
  const { scale, color, position, heading, points } = marker, { unit } = brush;
  if (points.length) { // the scale is the shaft's and the head's width, and the head's length
    const [tail, tip] = [0, 1].map((i) => brush.place(marker, i)), length = Math.hypot(tip[0] - tail[0], tip[1] - tail[1]);
    const head = Math.max(MIN_HALF * unit, brush.metres(scale.y) / 2);
    const headLength = Math.max(2 * MIN_HALF * unit, scale.z ? brush.metres(scale.z) : length / 4);
    return drawArrow(brush, tail, tip, Math.max(unit, brush.metres(scale.x) / 2), head, headLength, css(color));
  }
  const tail = brush.view.toPixel(position), long = 2 * brush.half(scale.x), wide = brush.half(scale.y || scale.x);
  drawArrow(brush, tail, [tail[0] + long * Math.cos(heading), tail[1] - long * Math.sin(heading)], wide / 3, wide, long * 0.35, css(color));
}

/** A box seen from a corner; what it stands for is written beside it. */
function mesh(brush, { position, color }) {
  const [left, top] = brush.view.toPixel(position), size = 7 * brush.unit;
  const corner = (i) => [left + size * Math.sin((i * Math.PI) / 3), top - size * Math.cos((i * Math.PI) / 3)];
  brush.ctx.beginPath();
  brush.polygon([0, 1, 2, 3, 4, 5].map(corner));
  brush.solid(css(color));
  brush.ctx.beginPath();
  for (const i of [1, 3, 5]) {
    brush.ctx.moveTo(left, top);
    brush.ctx.lineTo(...corner(i));
  }
  brush.ctx.stroke();
}

const SHAPES = {
  [ARROW]: arrow,
  [CUBE]: atPose("box"),
  [SPHERE]: atPose("round"),
  [CYLINDER]: atPose("round"),
  [LINE_STRIP]: strip,
  [LINE_LIST]: lines,
  [CUBE_LIST]: atEachPoint("box", true),
  [SPHERE_LIST]: atEachPoint("round", true),
  [POINTS]: atEachPoint("box", false),
  [MESH]: mesh,
  [TRIANGLES]: triangles,
};
/** Made of points, and has none: a dot where it is. */
const dotAtPose = (brush, { position, color }) => dot(brush, brush.view.toPixel(position), css(color));

const isNear = (seen, { left, right, bottom, top }, rim) =>
  left < seen.right + rim && right > seen.left - rim && bottom < seen.top + rim && top > seen.bottom - rim;

/** Of markers that are but dots from here, the newest of those that fall on one place: {markers that are drawn}, in their order. */
function thinned(markers, view, side) {
  const taken = new Set();
  const isKept = ({ bounds: { left, right, bottom, top } }) => {
    if (Math.max(right - left, top - bottom) * view.scale > side) return true;
    const [x, y] = view.toPixel({ x: (left + right) / 2, y: (bottom + top) / 2 });
    const place = `${Math.floor(x / side)} ${Math.floor(y / side)}`;
    if (taken.has(place)) return false;
    taken.add(place);
    return true;
  };
  return [...markers].reverse().filter(isKept).reverse();
}

/** `unit`: pixels, by the size of the page's letters. */
export function drawShapes(ctx, colours, view, markers, unit) {
  const seen = view.bounds(), rim = (24 * unit) / view.scale;
  ctx.lineJoin = "round";
  const brush = new Brush(ctx, colours, view, unit);
  const near = markers.filter(({ bounds }) => isNear(seen, bounds, rim));
  for (const marker of thinned(near, view, 2 * MIN_HALF * unit)) {
    const draw = marker.needsPoints ? dotAtPose : SHAPES[marker.type];
    draw?.(brush, marker);
  }
}
