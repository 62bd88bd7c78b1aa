// A colour and a pattern for each robot by its place in the run: the robot whose first pose is the oldest has the first place. Every page
// and the run's report thus show the same (archive/run_report_drawn.cpp). Robots of neighbouring hues differ in lightness and pattern. At
// night there is one hue.
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

let order = []; // names

/** The place of a robot, from 0; a new one has the next. */
export function placeInRun(name) {
  if (!order.includes(name)) order.push(name);
  return order.indexOf(name);
}

/** Sets the order to `names`; robots that are not among them follow by name. */
export function orderRobots(names) {
  const before = order.join();
  order = [...names, ...order.filter((name) => !names.includes(name)).sort()];
  if (order.join() !== before) repaint();
}

/** {hue, lightness} of OKLCH on a dark ground. */
export function toneOf(place) {
  let left = (((place * STEP) % ROBOTS + Math.floor(place / ROBOTS) / 2) / ROBOTS) % 1 * HUES.reduce((sum, [from, to]) => sum + to - from, 0);
  const [from] = HUES.find(([from, to]) => left < to - from || ((left -= to - from), false));
  return { hue: (from + left) % 360, lightness: LIGHTNESS[place % LIGHTNESS.length] };
}

const patternOf = (place) => PATTERNS[place % PATTERNS.length];
/** The same as lengths of lines and gaps. */
export const dashesOf = (place) => DASHES[patternOf(place)];

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

/** [red, green, blue] of a robot's place in that theme. */
export const robotRgb = (place, theme) => THEMES[theme](toneOf(place));

/** The same of a robot for a style: "rgb(…)". */
export const robotColour = (name, theme = themeNow()) => `rgb(${robotRgb(placeInRun(name), theme).join(" ")})`;

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
  node.dataset.pattern = patternOf(placeInRun(node.dataset.tint));
}
const repaint = () => watched && document.querySelectorAll("[data-tint]").forEach(paint);
let watched = false;
