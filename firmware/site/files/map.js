// The map: the picture of what was forwarded, and on it robots, their tracks, markers and reports. Drawn again only when something changed.
import { listenTo } from "./map_input.js";
import { coloursOf, drawCross, drawPairRings, drawReports, drawRobots, drawScale, isStale, keepOffRobots, labelsOn } from "./map_marks.js";
import { Markers, writeMarkers } from "./map_markers.js";
import { Shapes } from "./map_shapes.js";
import { drawLayer, Tiles } from "./map_tiles.js";
import { drawTracks, Tracks } from "./map_tracks.js";
import { MapView } from "./map_view.js";
import { whenThemeChanges } from "./theme_now.js";

const PAIR_RIM = 4; // metres around two reports that are compared

export class MapOfRun {
  #canvas;
  #paint;
  #view = new MapView();
  #tiles = new Tiles(() => this.redraw());
  #markers = new Markers(() => this.redraw());
  #shapes = new Shapes();
  #tracks = new Tracks(() => this.redraw());
  #run = null;
  #at = null; // the time that is shown; null: now
  #asked = false;
  #isFit = true; // until somebody moves it, all is shown
  #version = -1;
  #colours = {};
  #picked = null;
  #onTap = null;
  #pair = null; // [report, report] that are compared
  #shown = { grid: true, cloud: true, robots: true, tracks: true, markers: true, reports: true };
  #hidden = new Set(); // robots whose maps are not shown
  onLayers = () => {};

  /** `canvas` is in the page and has its size by CSS. */
  constructor(canvas) {
    this.#canvas = canvas;
    this.#paint = canvas.getContext("2d");
    const recolour = () => {
      this.#colours = coloursOf(document.documentElement);
      this.redraw();
    };
    whenThemeChanges(recolour);
    new ResizeObserver(() => this.#resize()).observe(canvas);
    recolour();
    this.#resize();
  }

  /** Lets it be moved by hand. */
  takeInput() {
    listenTo(this.#canvas, this.#view, { moved: () => this.#movedByHand(), tapped: (place) => this.#onTap?.(place), fit: () => this.fit() });
  }

  #movedByHand() {
    this.#isFit = false;
    this.redraw();
  }

  zoom(factor) {
    this.#view.zoom(factor);
    this.#movedByHand();
  }

  fit() {
    this.#isFit = true;
    this.redraw();
  }

  show(run) {
    this.#run = run;
    if (run.map_version !== this.#version && !this.#asked) this.#refresh(run.map_version);
    this.#markers.follow(run.marker_version);
    this.#tracks.follow(run);
    const places = JSON.stringify([run.reports.map(({ number, state, asking }) => [number, state, asking]), run.near_metres,
      run.robots.map((robot) => [robot.name, robot.position, robot.heading, isStale(robot, run.now)]), this.#markers.at(run.now).length]);
    if (places === this.#drawn) return;
    this.#drawn = places;
    this.redraw();
  }
  #drawn = "";

  async #refresh(version) {
    this.#asked = true;
    try {
      await this.#tiles.refresh();
      this.#version = version;
      this.onLayers();
    } catch {
      // asked for again with the next event
    } finally {
      this.#asked = false;
    }
  }

  /** Of the maps: null where there is none yet. */
  first = () => this.#tiles.first();
  colours = () => ({ ...this.#tiles.colours, spread: this.#tiles.heights });
  robots = () => [...new Set([...this.#tiles.layers.values()].map((layer) => layer.robot))].sort();
  kinds = () => new Set([...this.#tiles.layers.values()].map((layer) => layer.kind));
  isLive = () => this.#at === null;

  setTime(at) {
    this.#at = at;
    this.redraw();
  }
  setShown(what, isShown) {
    this.#shown[what] = isShown;
    this.redraw();
  }
  setRobot(robot, isShown) {
    if (isShown) this.#hidden.delete(robot);
    else this.#hidden.add(robot);
    this.redraw();
  }
  /** A cross at {x, y}; null: none. */
  setCross(place) {
    this.#picked = place;
    this.redraw();
  }
  setTap(tapped) {
    this.#onTap = tapped;
    this.redraw();
  }
  lookAt({ x, y }) {
    this.#isFit = false;
    this.#view.lookAt(x, y);
    if (this.#view.scale < 6) this.#view.scale = 6;
    this.redraw();
  }
  /** Looks at two reports and rings them; null: at none. */
  showPair(pair) {
    this.#pair = pair;
    if (pair) {
      this.#isFit = false;
      const [xs, ys] = ["x", "y"].map((axis) => pair.map(({ position }) => position[axis]));
      const rim = PAIR_RIM + Math.max(Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys)) / 2;
      this.#view.fit({ left: Math.min(...xs) - rim, right: Math.max(...xs) + rim, bottom: Math.min(...ys) - rim, top: Math.max(...ys) + rim });
      this.#view.pan(0, this.#view.height / 6); // below what is said of them
    }
    this.redraw();
  }
  markers = () => this.#markers;
  centre = () => this.#view.centre;

  #resize() {
    const density = devicePixelRatio || 1;
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    if (!width || !height) return;
    Object.assign(this.#view, { width, height });
    Object.assign(this.#canvas, { width: Math.round(width * density), height: Math.round(height * density) });
    this.#draw(); // at once: a canvas of a new size is blank
  }

  #waiting = false;
  redraw() {
    if (this.#waiting) return;
    this.#waiting = true;
    requestAnimationFrame(() => {
      this.#waiting = false;
      this.#draw();
    });
  }

  #isSeen = (layer) => this.#shown[layer.kind] && !this.#hidden.has(layer.robot);

  #places() {
    const { reports = [], robots = [], run_number } = this.#run ?? {};
    const until = this.#at ?? Infinity;
    return {
      reports: this.#shown.reports ? reports.filter((report) => report.position && report.run === run_number && report.received <= until) : [],
      robots: !this.#shown.robots ? [] : this.isLive() ? robots : this.#tracks.robotsAt(until),
      tracks: this.#shown.tracks ? this.#tracks.until(until) : [],
      markers: this.#shown.markers ? this.#markers.at(this.#at ?? this.#run?.now ?? 0) : [],
    };
  }

  #fitAll({ reports, robots }) {
    const area = this.#tiles.bounds(this.#isSeen) ?? { left: Infinity, bottom: Infinity, right: -Infinity, top: -Infinity };
    const all = { ...area };
    for (const { position: { x, y } } of [...reports, ...robots]) {
      if (Math.abs(x) > 8192 || Math.abs(y) > 8192) continue;
      Object.assign(all, { left: Math.min(all.left, x), right: Math.max(all.right, x), bottom: Math.min(all.bottom, y), top: Math.max(all.top, y) });
    }
    if (all.left <= all.right) this.#view.fit(all);
  }

  #draw() {
    const paint = this.#paint, view = this.#view, density = devicePixelRatio || 1;
    const places = this.#places();
    if (this.#isFit) this.#fitAll(places);
    paint.setTransform(density, 0, 0, density, 0, 0);
    paint.clearRect(0, 0, view.width, view.height);
    const layers = [...this.#tiles.layers.values()].filter(this.#isSeen);
    // The merged map lies below those of robots, and clouds lie upon grids.
    layers.sort((a, b) => (a.kind === "cloud") - (b.kind === "cloud") || (a.robot !== "") - (b.robot !== "") || a.robot.localeCompare(b.robot));
    for (const layer of layers) drawLayer(paint, view, this.#tiles, layer, this.#at);
    const size = parseFloat(getComputedStyle(this.#canvas).fontSize);
    const labels = labelsOn(paint, this.#colours, size, view.width);
    const unit = size / 14;
    drawTracks(paint, this.#colours, view, places.tracks, unit);
    this.#shapes.draw(paint, this.#colours, view, places.markers, unit);
    drawScale(paint, this.#colours, labels, view, size);
    keepOffRobots(labels, view, places.robots, size / 1.8);
    if (this.#pair) drawPairRings(paint, this.#colours, labels, view, this.#pair, size);
    drawReports(paint, this.#colours, labels, view, this.#run, places.reports, size / 2, this.#pair ?? []);
    drawRobots(paint, this.#colours, labels, view, places.robots, size / 1.8, this.#at ?? this.#run?.now);
    writeMarkers(labels, view, places.markers);
    if (this.#onTap && this.#canvas.matches(":focus-visible")) drawCross(paint, { ...this.#colours, ask: this.#colours.soft }, view.toPixel(view.centre), size / 2);
    if (this.#picked) drawCross(paint, this.#colours, view.toPixel(this.#picked), size / 2);
  }
}
