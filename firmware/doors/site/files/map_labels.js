// Names on the map that do not overlap: the first keeps its place, and a name without a free place is not written.

const OUTLINE = 1 / 3; // of a letter's height: sets it off from any map
const GAP = 1 / 2; // of a letter's height: so far are two names in a row, or they read as one
const MAX_WIDTHS = 4000;

const widths = new Map(); // of texts by their font

function widthOf(ctx, text) {
  const key = `${ctx.font} ${text}`;
  if (!widths.has(key)) {
    if (widths.size > MAX_WIDTHS) widths.clear();
    widths.set(key, ctx.measureText(text).width);
  }
  return widths.get(key);
}

export class Labels {
  ctx; colours; size;
  #taken = [];

  /** `margin`: pixels around what is seen in which a name may not end. */
  constructor(ctx, colours, size, { width, height, margin: [x, y] = [0, 0] }) {
    Object.assign(this, { ctx, colours, size });
    this.seen = [x, y, width - x, height - y];
  }

  /** Something is drawn at this place. */
  keepOff([left, top], size) {
    this.#taken.push([left - size, top - size, left + size, top + size]);
  }

  /** Something else is written there: [left, top, right, bottom]. */
  keepOffBox(box) {
    this.#taken.push(box);
  }

  #isFree = (box) => !this.#taken.some(([a, b, c, d]) => box[0] < c && box[2] > a && box[1] < d && box[3] > b);

  /** Right of the place, else left of it, above or below; what is in sight is not cut at the edge. `away`: pixels from the place;
   *  `rows`: so many lines farther above and below may it stand if there is no room, with a line to its place. Gives whether it is
   *  written. */
  write(text, left, top, { colour = this.colours.ink, rim = this.colours.ground, size = this.size, away = size, rows = 0 } = {}) {
    const { ctx } = this;
    ctx.font = `600 ${size}px system-ui, sans-serif`;
    const width = widthOf(ctx, text), half = size * 0.6, centred = left - width / 2;
    const near = [[left + away, top], [left - away - width, top], [centred, top - away - half], [centred, top + away + half]];
    const far = Array.from({ length: rows }, (_, row) => [-1, 1].flatMap((side) =>
      [left + away, left - away - width].map((from) => [from, top + side * (row + 1) * 2 * half]))).flat();
    const boxes = [...near, ...far].map(([from, middle]) => [from, middle - half, from + width, middle + half]);
    const chosen = boxes.findIndex((each) => !this.#isCut(each) && this.#isFree(each));
    if (chosen < 0) return false;
    const [from, above, to, below] = boxes[chosen];
    this.#taken.push([from - size * GAP, above, to + size * GAP, below]);
    if (chosen >= near.length) this.#drawLeader([left, top], [from > left ? from : to, above + half], { colour, rim, size });
    this.#paintText(text, from, above + half, { colour, rim, size });
    return true;
  }

  /** From a place to the name that stands apart from it. */
  #drawLeader(place, end, { colour, rim, size }) {
    const { ctx } = this;
    ctx.beginPath();
    ctx.moveTo(...place);
    ctx.lineTo(...end);
    ctx.globalCompositeOperation = "destination-over"; // it crosses out no other name
    for (const [width, strokeStyle] of [[size / 12, colour], [size / 4, rim]]) {
      Object.assign(ctx, { lineWidth: width, strokeStyle });
      ctx.stroke();
    }
    ctx.globalCompositeOperation = "source-over";
  }

  #isCut(box) {
    const [left, top, right, bottom] = this.seen;
    const isOut = box[2] < left || box[0] > right || box[3] < top || box[1] > bottom;
    return !isOut && (box[0] < left || box[2] > right || box[1] < top || box[3] > bottom);
  }

  #paintText(text, left, middle, { colour, rim, size }) {
    const { ctx } = this;
    Object.assign(ctx, { textBaseline: "middle", lineJoin: "round", lineWidth: size * OUTLINE, strokeStyle: rim, fillStyle: colour });
    ctx.strokeText(text, left, middle);
    ctx.fillText(text, left, middle);
  }
}
