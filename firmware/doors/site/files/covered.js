// How much the grids at the Command Post show as known: README.md of the API, GET /adit/covered. It is asked for if the map has changed.
import { get, isFault } from "./session.js";

const EVERY = 10_000; // ms: at least, between two questions
const [WHOLE, TENTHS] = [0, 1].map((digits) => new Intl.NumberFormat("en", { minimumFractionDigits: digits, maximumFractionDigits: digits }));

let last = null, run = null, asked = -Infinity, isAsking = false;

async function ask(number) {
  [isAsking, asked] = [true, performance.now()];
  try {
    const answer = await get("/adit/covered");
    last = { ...answer, of: new Map(answer.robots.map(({ robot, square_metres }) => [robot, square_metres])) };
    run = number;
  } catch (error) {
    isFault(error);
    last = null;
  }
  isAsking = false;
}

/** {square_metres, whole, of: square metres by robot} of this run as last counted; null: unknown. */
export function coveredIn(view) {
  if (!isAsking && last?.version !== view.map_version && performance.now() - asked >= EVERY) ask(view.run_number);
  return run === view.run_number ? last : null;
}

/** "4,213 m²", with a sign if it is more: the box could not draw all of a grid. */
export function area(squareMetres, isWhole) {
  return `${isWhole ? "" : "≥ "}${(squareMetres < 100 ? TENTHS : WHOLE).format(squareMetres)} m²`;
}
