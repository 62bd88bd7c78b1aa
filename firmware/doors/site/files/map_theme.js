// The map's colours in each theme: of the drawing on it, and of the tiles, which the box colours on request.
import { lookOf, robotRgb } from "./robot_colour.js";
import { themeNow } from "./theme_now.js";

const NAMES = ["ground", "panel", "edge", "ink", "soft", "good", "wait", "bad", "quiet", "ask", "lamp", "free", "wall"];

/** The page's colours, which differ by theme. */
export function themeColours(node) {
  const style = getComputedStyle(node);
  return Object.fromEntries(NAMES.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
}

const hex = (parts) => parts.map((part) => Math.round(part).toString(16).padStart(2, "0")).join("");

/** "#26e" or "#2266ee" as the box wants it: "2266ee". */
const bare = (colour) => (colour.length === 4 ? [...colour.slice(1)].map((digit) => digit + digit).join("") : colour.slice(1));

/** {grid: [free, occupied], cloud: [lowest, highest] or null (the box's own, from violet to yellow), robot(name): the same of a
 *  cloud by its robot, heights: the legend's colours if they are not the box's own}.
 *  @param {Record<string, string>} colours */
export function looksOf({ free, wall }) {
  const theme = themeNow();
  const red = theme === "red" ? ["46100a", "ff8a78"] : null;
  const robot = (name) => {
    const colour = robotRgb(lookOf(name).colour, theme), dim = theme === "light" ? 1.75 : 0.4; // the lowest is nearer to the ground's colour
    const low = colour.map((part) => (theme === "light" ? 255 - (255 - part) / dim : part * dim));
    return [hex(low), hex(colour)];
  };
  return { grid: [bare(free), bare(wall)], cloud: red, robot, heights: red?.map((colour) => `#${colour}`) };
}
