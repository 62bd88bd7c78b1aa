// What each artifact looks like, drawn in lines on 24 x 24 units: in the page's lists, and on the map's canvas.
import { drawLines } from "./dom.js";

const DRAWN = {
  "Survivor": "M12 2.8a3.2 3.2 0 1 1 0 6.4 3.2 3.2 0 1 1 0-6.4M5 21.2v-2.4a7 6.4 0 0 1 14 0v2.4",
  "Cell Phone": "M8.6 2.5h6.8A1.6 1.6 0 0 1 17 4.1v15.8a1.6 1.6 0 0 1-1.6 1.6H8.6A1.6 1.6 0 0 1 7 19.9V4.1a1.6 1.6 0 0 1 1.6-1.6zM10.8 18.2h2.4",
  "Backpack": "M5.5 11.5a6.5 6 0 0 1 13 0v9.7h-13zM9.5 5.6V4a1.4 1.4 0 0 1 1.4-1.4h2.2A1.4 1.4 0 0 1 14.5 4v1.6M9 21v-6h6v6M9.8 10.4h4.4",
  "Drill": "M2.8 5h11.4v6.4H2.8zM14.2 6.4h3v3.6h-3M17.2 8.2h4.2M6 11.4L4.6 20.8h5.2l1.2-9.4",
  "Fire Extinguisher": "M7.6 11.4a4.4 4.4 0 0 1 8.8 0v9.8H7.6zM12 7V4.4M8.6 3.4h6M14.6 3.4q4.4.4 4.6 5.2M7.6 14.6h8.8",
  "Gas": "M2.6 7q3.1-3.4 6.2 0t6.2 0 6.2 0M2.6 12.3q3.1-3.4 6.2 0t6.2 0 6.2 0M2.6 17.6q3.1-3.4 6.2 0t6.2 0 6.2 0",
  "Vent": "M4 3.6h16v16.8H4zM7.4 8h9.2M7.4 12h9.2M7.4 16h9.2",
  "Helmet": "M4.4 15.4a7.6 7.8 0 0 1 15.2 0M2.4 15.4h19.2v3.4H2.4zM9.8 11V6.2a1.4 1.4 0 0 1 1.4-1.4h1.6a1.4 1.4 0 0 1 1.4 1.4V11",
  "Rope": "M4 6.6a8 3.4 0 1 0 16 0 8 3.4 0 1 0-16 0v5.2a8 3.4 0 0 0 16 0V6.6M4 11.8V17a8 3.4 0 0 0 16 0v-5.2",
  "Cube": "M12 2.6l8.2 4.7v9.4L12 21.4l-8.2-4.7V7.3zM3.8 7.3L12 12l8.2-4.7M12 12v9.4",
};
const OTHER = "M12 3a9 9 0 1 1 0 18 9 9 0 1 1 0-18M9.4 9.6a2.6 2.6 0 1 1 2.6 2.9v1.4M12 16.8v.4"; // a question: no type of the ICD

/** The lines of that type, as an SVG path has them; the ICD does not mind capitals. */
export const linesOf = (type) => DRAWN[Object.keys(DRAWN).find((name) => name.toLowerCase() === String(type).toLowerCase())] ?? OTHER;

/** Its picture as a node, in the colour of the text; whoever shows it writes the type beside it. Its size is the style's. */
export const icon = (type) => drawLines(linesOf(type));

const paths = new Map();
/** The same for a canvas: a Path2D of 24 x 24 units, made once. */
export function iconPath(type) {
  const lines = linesOf(type);
  if (!paths.has(lines)) paths.set(lines, new Path2D(lines));
  return paths.get(lines);
}
