// A colour for each robot, the same on every page and after every reload: it follows from the name alone. The hue tells the
// kind (driving, walking, flying) and is never that of a level; the number in the name moves it and sets the lightness. At
// night there is one hue, and lightness alone tells.
import { themeNow, whenThemeChanges } from "./theme_now.js";

// Degrees of OKLCH, from and to, and how many numbers these are spread over.
const HUES = { ground: [195, 262, 8], legged: [308, 348, 6], flying: [108, 138, 6] };
const LIGHTNESS = [0.84, 0.72, 0.78];
/** @type {[string, RegExp][]} */
const KINDS = [
  ["flying", /^(uav|uas|mav|drone|quad|copter|heli|fly|air|dji|x500|scout_?air|bee|hawk|falcon|blimp)/i],
  ["legged", /^(spot|anymal|legged|dog|ghost|vision60|mule|hexa|daisy|alien|go[12]|b1|cheetah|walk)/i],
];
const GOLDEN = 0.618034;

/** "ground", "legged" or "flying", by how teams call their robots; what says neither drives. */
export const kindOf = (name) => KINDS.find(([, pattern]) => pattern.test(name))?.[0] ?? "ground";

const numberIn = (name) => {
  const digits = /(\d{1,6})\D*$/.exec(name)?.[1];
  if (digits) return Math.max(0, Number(digits) - 1);
  return [...name].reduce((sum, letter) => (sum * 31 + letter.codePointAt(0)) % 997, 7);
};

/** {hue, lightness} of OKLCH on a dark ground. */
export function toneOf(name) {
  const [from, to, count] = HUES[kindOf(name)], number = numberIn(name);
  const share = number < count ? number / (count - 1) : (number * GOLDEN) % 1; // past those: in the gaps between
  return { hue: from + share * (to - from), lightness: LIGHTNESS[number % LIGHTNESS.length] };
}

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

/** [red, green, blue] of a robot in that theme. */
export const robotRgb = (name, theme) => THEMES[theme](toneOf(name));

/** The same for a style: "rgb(…)". */
export const robotColour = (name, theme = themeNow()) => `rgb(${robotRgb(name, theme).join(" ")})`;

/** Gives `node` the robot's colour as `--robot`, now and in every theme that comes. */
export function tint(node, name) {
  if (node.dataset.tint === name) return;
  if (!watched) whenThemeChanges(() => document.querySelectorAll("[data-tint]").forEach(paintOf));
  watched = true;
  node.dataset.tint = name;
  paintOf(node);
}
const paintOf = (node) => node.style.setProperty("--robot", robotColour(node.dataset.tint));
let watched = false;
