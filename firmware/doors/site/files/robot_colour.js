// A colour and a pattern for each robot: those that the settings choose, else by the order of first poses. Every page and the run's report
// thus show the same (archive/run_report.cpp). Robots of neighbouring hues differ in lightness and pattern. At night there is one hue.
import { themeNow, whenThemeChanges } from "./theme_now.js";

const HUES = [[37, 63], [87, 146], [170, 265], [289, 373]]; // degrees of OKLCH, away from those of the levels
const ROBOTS = 20, STEP = 7; // hues; how many lie between those of two robots in a row
const LIGHTNESS = [0.84, 0.73];
const PATTERNS = ["solid", "dashed", "dotted", "dash-dot"];
const DASHES = { "solid": [], "dashed": [8, 4], "dotted": [2, 3], "dash-dot": [9, 3, 2, 3] }; // units of length
/** @type {[string, RegExp][]} */
const KINDS = [
  ["flying", /^(uav|uas|mav|drone|quad|copter|heli|fly|air|dji|x500|scout_?air|bee|hawk|falcon|blimp)/i],
  ["legged", /^(spot|anymal|legged|dog|ghost|vision60|mule|hexa|daisy|alien|go[12]|b1|cheetah|walk)/i],
];

/** "ground", "legged" or "flying", by how teams call their robots; what says neither drives. */
export const kindOf = (name) => KINDS.find(([, pattern]) => pattern.test(name))?.[0] ?? "ground";

/** {colour, pattern} of each name, both from 0. `chosen`: name to colour. Robots of one chosen colour have different patterns; the others
 *  have the colours that no robot chose, in the order of `names`. */
export function robotLooks(names, chosen) {
  const isChosen = new Set(chosen.values()), robots = new Map(); // of each chosen colour
  let next = 0;
  return new Map(names.map((name) => {
    const own = chosen.get(name);
    if (own === undefined) {
      while (isChosen.has(next)) ++next;
      return [name, { colour: next, pattern: next++ }];
    }
    robots.set(own, (robots.get(own) ?? -1) + 1);
    return [name, { colour: own, pattern: own + robots.get(own) }];
  }));
}

let order = [], chosen = new Map(), looks = new Map();

function look(names, colours) {
  const before = JSON.stringify([...looks]);
  [order, chosen, looks] = [names, colours, robotLooks(names, colours)];
  const isNew = JSON.stringify([...looks]) !== before;
  if (isNew) repaint();
  return isNew;
}

/** {colour, pattern} of a robot; a new one is the next in the order. */
export function lookOf(name) {
  if (!looks.has(name)) look([...order, name], chosen);
  return looks.get(name);
}

/** Sets the order to `names`; robots that are not among them follow by name. */
export const orderRobots = (names) => look([...names, ...order.filter((name) => !names.includes(name)).sort()], chosen);

/** Sets the colours of the settings, `colours` of /adit/run. Gives whether a robot now looks different. */
export const chooseColours = (rows) => look(order, new Map(rows.map(({ name, colour }) => [name, colour - 1])));

/** {hue, lightness} of OKLCH on a dark ground. */
export function toneOf(colour) {
  let left = (((colour * STEP) % ROBOTS + Math.floor(colour / ROBOTS) / 2) / ROBOTS) % 1 * HUES.reduce((sum, [from, to]) => sum + to - from, 0);
  const [from] = HUES.find(([from, to]) => left < to - from || ((left -= to - from), false));
  return { hue: (from + left) % 360, lightness: LIGHTNESS[colour % LIGHTNESS.length] };
}

const nameOfPattern = (pattern) => PATTERNS[pattern % PATTERNS.length];
/** A pattern as lengths of lines and gaps. */
export const dashesOf = (pattern) => DASHES[nameOfPattern(pattern)];

/** OKLCH to red, green and blue (0 to 255), after Björn Ottosson's "A perceptual color space for image processing"; what no
 *  screen shows is made greyer until one does. */
export function rgbOf(lightness, chroma, hue) {
  const angle = (hue * Math.PI) / 180, a = chroma * Math.cos(angle), b = chroma * Math.sin(angle);
  const [l, m, s] = [
    lightness + 0.3963377774 * a + 0.2158037573 * b,
    lightness - 0.1055613458 * a - 0.0638541728 * b,
    lightness - 0.0894841775 * a - 1.291485548 * b,
  ].map((value) => value ** 3);
  const linear = [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
  if (chroma > 0.005 && linear.some((value) => value < -0.001 || value > 1.001)) return rgbOf(lightness, chroma * 0.94, hue);
  return linear.map((value) => {
    const v = Math.min(1, Math.max(0, value));
    return Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055));
  });
}

const THEMES = {
  dark: ({ hue, lightness }) => rgbOf(lightness, 0.11, hue),
  light: ({ hue, lightness }) => rgbOf(lightness - 0.33, 0.12, hue),
  red: ({ lightness }) => rgbOf(1.25 * lightness - 0.3, 0.17, 28),
};

/** [red, green, blue] of a colour in that theme. */
export const robotRgb = (colour, theme) => THEMES[theme](toneOf(colour));

/** The same for a style: "rgb(…)". */
export const styleOf = (colour, theme = themeNow()) => `rgb(${robotRgb(colour, theme).join(" ")})`;
export const robotColour = (name) => styleOf(lookOf(name).colour);

/** Gives `node` the robot's colour as `--robot` and its pattern as data-pattern, now and after each change of theme or order. */
export function tint(node, name) {
  if (node.dataset.tint === name) return;
  if (!watched) whenThemeChanges(repaint);
  watched = true;
  node.dataset.tint = name;
  paint(node);
}
function paint(node) {
  node.style.setProperty("--robot", robotColour(node.dataset.tint));
  node.dataset.pattern = nameOfPattern(lookOf(node.dataset.tint).pattern);
}
const repaint = () => watched && document.querySelectorAll("[data-tint]").forEach(paint);
let watched = false;
