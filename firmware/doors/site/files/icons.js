// Icons of the buttons, as lines of 24 x 24 units.
import { drawLines } from "./dom.js";

const DRAWN = {
  run: "M4 19V9M10 19V5M16 19v-7M21 19H3",
  map: "M9 4 3 6.5V20l6-2.5 6 2.5 6-2.5V4l-6 2.5zM9 4v13.5M15 6.5V20",
  reports: "M6 3h9l4 4v14H6zM9 11h7M9 15h7",
  loud: "M4 9.5v5h3.5l4.5 4v-13l-4.5 4zM15.5 9a4 4 0 0 1 0 6M18 6.5a8 8 0 0 1 0 11",
  mute: "M4 9.5v5h3.5l4.5 4v-13l-4.5 4zM16 9l5 6M21 9l-5 6",
  ruler: "M3 16 16 3l5 5L8 21zM7 12l2 2M10 9l3 3M13 6l2 2",
  play: "M7 4.5v15l12-7.5z",
  pause: "M8 5v14M16 5v14",
  robots: "M5 9h14v10H5zM12 9V5M9 14h.01M15 14h.01",
};

/** Its picture as a node, in the colour of the text. */
export const drawn = (name) => drawLines(DRAWN[name]);
