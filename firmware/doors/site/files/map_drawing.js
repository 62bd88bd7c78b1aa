// How the map is drawn: four layers, each with a key that differs if the layer has to be drawn again, and what lies over them.
import { Covers } from "./map_covers.js";
import { groupReports } from "./map_groups.js";
import { Labels } from "./map_labels.js";
import { drawLayers, fetchLayers } from "./map_layers.js";
import { writeMarkers } from "./map_markers.js";
import { drawGridLabels, drawGridLines, drawOrigin, drawScaleBar, gridLabelBoxes } from "./map_metres.js";
import { Picture } from "./map_picture.js";
import { drawCross, drawPairRings, drawReports, groupMetres, nameReports } from "./map_reports.js";
import { drawRobots, keepOffRobots, nameRobots } from "./map_robots.js";
import { drawShapes } from "./map_shapes.js";
import { looksOf, themeColours } from "./map_theme.js";
import { drawTracks } from "./map_tracks.js";
import { whenThemeChanges } from "./theme_now.js";

const FADE_SECONDS = 20; // the time between two drawings of all tracks; the signs' layer has the newer poses
const BASE_SIZE = 14; // pixels: the size of the page's letters for which widths are given

export class MapDrawing {
  picture;
  /** @type {Record<string, string>} */
  colours = {};
  isByRobot = false; // clouds are coloured by robot, or by height
  #canvas;
  #view;
  #scene;
  #marks;
  #ruler;
  #covers;
  #tracked = Infinity; // the time up to which tracks are drawn

  /** `marks`: {followed, pair, cross, isTapped}; `prepare()` is called before each frame. */
  constructor(canvas, { view, scene, marks, ruler, prepare }) {
    this.#canvas = canvas;
    this.#view = view;
    this.#scene = scene;
    this.#marks = marks;
    this.#ruler = ruler;
    this.picture = new Picture(canvas, view, {
      ground: () => this.colours.ground,
      over: (ctx, view) => this.#drawOver(ctx, view),
      layers: [
        { key: this.#mapKey, draw: this.#drawMaps, pieces: () => this.#scene.tiles.pieces() },
        { key: this.#markersKey, draw: this.#drawMarkers },
        { key: this.#tracksKey, draw: this.#drawTracks },
        { key: this.#signsKey, draw: this.#drawSigns, isOfView: true },
      ],
    });
    this.picture.before = prepare;
    this.#covers = new Covers(canvas, () => this.picture.redraw());
    whenThemeChanges(() => this.recolour());
    this.recolour();
  }

  /** Takes the theme's colours. */
  recolour() {
    this.colours = themeColours(document.documentElement);
    this.#scene.tiles.setLooks(looksOf(this.colours), this.isByRobot);
    this.picture.redraw();
  }

  /** Asks for the images of the maps that are seen. */
  fetchMaps() {
    fetchLayers(this.#view, this.#scene.tiles, this.#scene.layers(), this.#scene.time, this.picture.density());
  }

  #unit = () => this.picture.fontSize / BASE_SIZE;
  #themeKey = () => `${this.picture.fontSize} ${this.colours.ground} ${this.colours.ink}`;

  #mapKey = () => {
    const { base, tiles, time, shown, hidden } = this.#scene;
    return [base, tiles.changes, time, shown.grid, shown.cloud, [...hidden], this.#themeKey()].join();
  };
  #drawMaps = (ctx, view, piece) => {
    const { tiles, time } = this.#scene;
    drawLayers(ctx, view, tiles, this.#scene.layers(), time, this.picture.density(), piece);
    drawGridLines(ctx, this.colours, view);
    drawOrigin(ctx, this.colours, view, this.#unit());
  };

  #tracksKey = () => {
    const { base, shown, tracks, time } = this.#scene;
    return [base, shown.tracks, tracks.changes, time ?? Math.floor(this.#scene.now() / FADE_SECONDS), this.#themeKey()].join();
  };
  #drawTracks = (ctx, view) => {
    this.#traceRobots(ctx, view);
    this.#tracked = this.#scene.now();
  };
  #traceRobots(ctx, view, since = -Infinity) {
    const { shown, tracks } = this.#scene;
    if (shown.tracks) drawTracks(ctx, this.colours, view, tracks.until(this.#scene.until()), this.#scene.now(), this.#unit(), since);
  }

  #markersKey = () => {
    const { markers } = this.#scene.places;
    const hash = markers.reduce((sum, { mark }) => (Math.imul(sum, 31) + mark) | 0, markers.length);
    return [hash, this.#themeKey()].join();
  };
  #drawMarkers = (ctx, view) => drawShapes(ctx, this.colours, view, this.#scene.places.markers, this.#unit());

  #signsKey = () => {
    const { key, time, tracks, shown } = this.#scene, { followed, pair, isTapped } = this.#marks;
    const seen = [key, time, tracks.changes, shown.robots, shown.tracks, shown.reports, shown.pointless, this.#markersKey()];
    const numbers = pair?.map(({ number }) => number);
    return [...seen, followed, numbers, isTapped, this.#covers.boxes(), this.picture.hasNames].join();
  };
  #drawSigns = (ctx, view) => {
    const { places: { reports, robots, markers }, run, lateRobots, silentRobots } = this.#scene, { followed, pair } = this.#marks;
    const { colours, picture: { fontSize, hasNames } } = this;
    const reportSize = fontSize / 2, robotSize = fontSize / 1.8;
    this.#traceRobots(ctx, view, this.#tracked);
    const labels = this.#labels(ctx, view);
    keepOffRobots(labels, view, robots, robotSize);
    if (pair) drawPairRings(ctx, colours, labels, view, pair, fontSize);
    const { singles, groups } = groupReports(reports, groupMetres(view, reportSize), ({ number }) => pair?.some((its) => its.number === number));
    drawReports(ctx, colours, labels, view, run, singles, groups, reportSize);
    drawRobots(ctx, colours, view, robots, robotSize, followed);
    if (!hasNames) return;
    const none = new Set(), isLive = this.#scene.isLive();
    nameRobots(labels, view, robots, robotSize, isLive ? lateRobots : none, isLive ? silentRobots : none);
    nameReports(labels, view, singles, reportSize, pair ?? []);
    writeMarkers(labels, view, markers);
  };

  /** Labels that leave the tools, the legend and the grid's figures free. `view` is larger than what is seen by a margin. */
  #labels(ctx, view) {
    const { fontSize } = this.picture;
    const [x, y] = [(view.width - this.#view.width) / 2, (view.height - this.#view.height) / 2];
    const labels = new Labels(ctx, this.colours, fontSize, { width: view.width, height: view.height, margin: [x, y] });
    for (const [left, top, right, bottom] of [...gridLabelBoxes(this.#view, fontSize), ...this.#covers.boxes()]) {
      labels.keepOffBox([left + x, top + y, right + x, bottom + y]);
    }
    return labels;
  }

  #drawOver(ctx, view) {
    const { fontSize } = this.picture, { cross, isTapped } = this.#marks;
    drawGridLabels(ctx, this.colours, view, fontSize);
    drawScaleBar(ctx, this.colours, view, fontSize);
    this.#ruler.draw(ctx, this.colours, view, fontSize);
    const isAimed = (isTapped || this.#ruler.isOn) && this.#canvas.matches(":focus-visible");
    if (isAimed) drawCross(ctx, { ...this.colours, ask: this.colours.soft }, view.toPixel(view.centre), fontSize / 2);
    if (cross) drawCross(ctx, this.colours, view.toPixel(cross), fontSize / 2);
  }
}
