// Names on the map, none upon another: who comes first has its place, who finds none is not written.

const RIM = 1 / 3; // of a letter's height: sets it off from any map
const APART = 1 / 2; // of a letter's height: so far are two names in a row, or they read as one
const MOST_KNOWN = 4000;

const widths = new Map(); // of texts by their font

function widthOf(paint, text) {
  const key = `${paint.font} ${text}`;
  if (!widths.has(key)) {
    if (widths.size > MOST_KNOWN) widths.clear();
    widths.set(key, paint.measureText(text).width);
  }
  return widths.get(key);
}

export class Labels {
  paint; colours; size;
  #taken = [];

  /** `rim`: pixels around what is seen in which a name may not end. */
  constructor(paint, colours, size, { width, height, rim = [0, 0] }) {
    Object.assign(this, { paint, colours, size });
    this.seen = [rim[0], rim[1], width - rim[0], height - rim[1]];
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

  /** Right of the place, else left of it, above or below; what is in sight is not cut at the edge. `away`: pixels from the place. Gives whether it is written. */
  write(text, left, top, { colour = this.colours.ink, rim = this.colours.ground, size = this.size, away = size } = {}) {
    const { paint } = this;
    paint.font = `600 ${size}px system-ui, sans-serif`;
    const wide = widthOf(paint, text), half = size * 0.6;
    const places = [[left + away, top], [left - away - wide, top], [left - wide / 2, top - away - half], [left - wide / 2, top + away + half]];
    const boxes = places.map(([from, middle]) => [from, middle - half, from + wide, middle + half]);
    const box = boxes.find((each) => !this.#isCut(each) && this.#isFree(each));
    if (!box) return false;
    const [from, above, to, below] = box;
    this.#taken.push([from - size * APART, above, to + size * APART, below]);
    this.#paintText(text, from, above + half, { colour, rim, size });
    return true;
  }

  #isCut(box) {
    const [left, top, right, bottom] = this.seen;
    const isOut = box[2] < left || box[0] > right || box[3] < top || box[1] > bottom;
    return !isOut && (box[0] < left || box[2] > right || box[1] < top || box[3] > bottom);
  }

  #paintText(text, left, middle, { colour, rim, size }) {
    const { paint } = this;
    Object.assign(paint, { textBaseline: "middle", lineJoin: "round", lineWidth: size * RIM, strokeStyle: rim, fillStyle: colour });
    paint.strokeText(text, left, middle);
    paint.fillText(text, left, middle);
  }
}
