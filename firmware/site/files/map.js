// The map: the picture of what was forwarded, and on it robots, their tracks, markers and reports. Drawn again only when something changed.
import { Covers } from "./map_covers.js";
import { listenTo } from "./map_input.js";
import { Labels } from "./map_labels.js";
import { drawLayers, fetchLayers } from "./map_layers.js";
import { Markers, writeMarkers } from "./map_markers.js";
import { drawFigures, drawLines, drawOrigin, drawScale, takenByMetres } from "./map_metres.js";
import { Picture } from "./map_picture.js";
import { drawCross, drawPairRings, drawReports, nameReports } from "./map_reports.js";
import { drawRobots, isStale, keepOffRobots, nameRobots, robotAt } from "./map_robots.js";
import { Ruler } from "./map_ruler.js";
import { drawShapes } from "./map_shapes.js";
import { coloursOf, looksOf } from "./map_theme.js";
import { Tiles } from "./map_tiles.js";
import { drawTracks, Tracks } from "./map_tracks.js";
import { MapView } from "./map_view.js";
import { Steps } from "./steps.js";
import { whenThemeChanges } from "./theme_now.js";

const PAIR_RIM = 4; // metres around two reports that are compared
const FADES_EVERY = 2; // s: so often are tracks drawn again

export class MapOfRun {
  #canvas;
  #picture;
  #covers;
  #view = new MapView();
  #tiles = new Tiles(() => this.redraw());
  #markers = new Markers(() => this.redraw());
  #tracks = new Tracks(() => this.redraw());
  #steps = new Steps();
  #ruler = new Ruler();
  #run = null;
  #ill = new Set(); // robots whose map does not come
  #at = null; // the time that is shown; null: now
  #asked = false;
  #isFit = true; // until somebody moves it, all is shown
  #isExact = true; // and at the next look so that it just fits; else only what leaves the view moves that
  #version = -1;
  /** @type {Record<string, string>} */
  #colours = {};
  #picked = null;
  #followed = null;
  #onTap = null;
  #pair = null; // [report, report] that are compared
  #byRobot = false; // how clouds are coloured
  #shown = { grid: true, cloud: true, robots: true, tracks: true, markers: true, reports: true };
  #hidden = new Set(); // robots whose maps are not shown
  #drawn = "";
  #base = ""; // of a run that is kept
  #places = { reports: [], robots: [], markers: [] };
  onLayers = () => {};
  onTool = () => {};

  /** `canvas` is in the page and has its size by CSS. */
  constructor(canvas) {
    this.#canvas = canvas;
    this.#picture = new Picture(canvas, this.#view, {
      ground: () => this.#colours.ground,
      over: (paint, view) => this.#drawOver(paint, view),
      layers: [
        { key: this.#mapKey, draw: this.#drawMaps, pieces: () => this.#tiles.pieces() },
        { key: this.#tracksKey, draw: this.#drawTracks },
        { key: this.#markersKey, draw: this.#drawMarkers },
        { key: this.#signsKey, draw: this.#drawSigns },
      ],
    });
    this.#picture.before = () => this.#prepare();
    this.#covers = new Covers(canvas, () => this.redraw());
    const recolour = () => {
      this.#colours = coloursOf(document.documentElement);
      this.#recolourMaps();
    };
    whenThemeChanges(recolour);
    recolour();
    this.#picture.resize();
  }

  /** Lets it be moved by hand. */
  takeInput() {
    const moved = () => {
      this.follow(null);
      this.#movedByHand();
    };
    listenTo(this.#canvas, this.#view, { moved, held: (isHeld) => this.#picture.hold(isHeld), tapped: (place) => this.#tapped(place), fit: () => this.fit() });
  }

  #movedByHand() {
    this.#isFit = false;
    this.#picture.moved();
  }

  #tapped(place) {
    if (this.#onTap) return this.#onTap(place);
    if (!this.#ruler.isOn) return this.follow(robotAt(this.#view, this.#places.robots, place)?.name ?? null);
    this.#ruler.put(place);
    this.onTool();
    this.redraw();
  }

  zoom(factor) {
    this.#view.zoom(factor);
    this.#movedByHand();
  }

  fit() {
    this.follow(null);
    this.#isFit = this.#isExact = true;
    this.redraw();
  }

  show(run) {
    this.#run = run;
    if (this.#steps.seen(run.now)) this.#askAgain();
    if (run.map_version !== this.#version && !this.#asked) this.#refresh(run.map_version);
    this.#markers.follow(run.marker_version);
    this.#tracks.follow(run);
    this.#ill = new Set(run.standings.filter(({ level }) => level === "bad").map(({ name }) => name));
    const places = JSON.stringify([run.reports.map(({ number, state, asking }) => [number, state, asking]), run.near_metres,
      run.robots.map((robot) => [robot.name, robot.position, robot.heading, isStale(robot)]), this.#markers.at(run.now).length, [...this.#ill]]);
    if (places === this.#drawn) return;
    this.#drawn = places;
    if (this.#followed) this.#picture.moved();
    else this.redraw();
  }

  /** A run that is kept: what the box has below `base`; it has no markers. `run`: {reports, the newest first, run_number, now: its end}. */
  lookAgain(base, run) {
    this.follow(null);
    this.measure(false);
    this.#tiles = new Tiles(() => this.redraw(), base);
    this.#tracks = new Tracks(() => this.redraw(), base);
    this.#run = { ...run, robots: [] };
    this.#drawn = this.#base = base;
    this.#hidden.clear();
    this.#isFit = this.#isExact = true;
    this.#recolourMaps();
    this.#tracks.follow(this.#run);
    this.#refresh(-1);
  }

  /** Somebody set the box's clock: all of it has another time. */
  #askAgain() {
    this.#version = -1;
    for (const kept of [this.#tiles, this.#markers, this.#tracks]) kept.forget();
  }

  async #refresh(version) {
    this.#asked = true;
    try {
      await this.#tiles.refresh();
      fetchLayers(this.#view, this.#tiles, this.#layers(), this.#at, this.#picture.density());
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
  /** What a legend needs: {heights: colours, the lowest first, spread: {low, high} in metres}; null while clouds are coloured by robot. */
  legend = () => (this.#byRobot ? null : { heights: looksOf(this.#colours).heights ?? this.#tiles.colours?.heights, spread: this.#tiles.heights });
  robots = () => [...new Set([...this.#tiles.layers.values()].map((layer) => layer.robot))].sort();
  kinds = () => new Set([...this.#tiles.layers.values()].map((layer) => layer.kind));
  isLive = () => this.#at === null;
  markers = () => this.#markers;
  /** [{name, poses: [[at, x, y, z, heading]]}] of this run until now; null: not loaded yet. */
  tracks = () => (this.#tracks.isLoaded ? this.#tracks.until(Infinity) : null);
  centre = () => this.#view.centre;
  redraw = () => this.#picture.redraw();

  #set(change) {
    change();
    this.#isExact = true;
    this.redraw();
  }
  setTime = (at) => this.#set(() => (this.#at = at));
  setShown = (what, isShown) => this.#set(() => (this.#shown[what] = isShown));
  setRobot = (robot, isShown) => this.#set(() => this.#hidden[isShown ? "delete" : "add"](robot));
  /** A cross at {x, y}; null: none. */
  setCross = (place) => this.#set(() => (this.#picked = place));
  /** Who is told of taps; null: nobody, then a tap follows a robot or measures. */
  setTap(tapped) {
    if (tapped) this.measure(false);
    this.#set(() => (this.#onTap = tapped));
  }
  colourBy(what) {
    this.#byRobot = what === "robot";
    this.#recolourMaps();
    this.onLayers();
  }
  #recolourMaps() {
    this.#tiles.setLooks(looksOf(this.#colours), this.#byRobot);
    this.redraw();
  }

  /** Keeps that robot in the middle; null: none. */
  follow(name) {
    if (name === this.#followed) return;
    this.#followed = name;
    if (name) this.#isFit = false;
    this.onTool();
    this.redraw();
  }
  followed = () => this.#followed;

  measure(isOn) {
    if (isOn === this.#ruler.isOn) return;
    this.#ruler.set(isOn);
    this.onTool();
    this.redraw();
  }
  ruler = () => this.#ruler;

  lookAt({ x, y }) {
    this.follow(null);
    this.#isFit = false;
    this.#view.lookAt(x, y);
    if (this.#view.scale < 6) this.#view.scale = 6;
    this.redraw();
  }
  /** Looks at two reports and rings them; null: at none. */
  showPair(pair) {
    this.follow(null);
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

  #isSeen = (layer) => this.#shown[layer.kind] && !this.#hidden.has(layer.robot);
  #now = () => this.#at ?? this.#run?.now ?? 0;

  /** Before each frame: what is where, and where one looks. */
  #prepare() {
    const { reports = [], robots = [], run_number } = this.#run ?? {};
    const until = this.#at ?? Infinity;
    this.#places = {
      reports: this.#shown.reports ? reports.filter((report) => report.position && report.run === run_number && report.received <= until) : [],
      robots: !this.#shown.robots ? [] : this.isLive() ? robots : this.#tracks.robotsAt(until),
      markers: this.#shown.markers ? this.#markers.at(this.#now()) : [],
    };
    const followed = this.#places.robots.find(({ name }) => name === this.#followed);
    if (followed) this.#view.lookAt(followed.position.x, followed.position.y);
    if (this.#isFit) this.#fitAll(this.#places);
  }

  #fitAll({ reports, robots }) {
    const area = this.#tiles.bounds(this.#isSeen) ?? { left: Infinity, bottom: Infinity, right: -Infinity, top: -Infinity };
    const all = { ...area };
    for (const { position: { x, y } } of [...reports, ...robots]) {
      if (Math.abs(x) > 8192 || Math.abs(y) > 8192) continue;
      Object.assign(all, { left: Math.min(all.left, x), right: Math.max(all.right, x), bottom: Math.min(all.bottom, y), top: Math.max(all.top, y) });
    }
    const size = `${this.#view.width} ${this.#view.height}`;
    if (all.left > all.right || (!this.#isExact && size === this.#fitted && this.#view.holds(all))) return;
    this.#view.fit(all);
    this.#fitted = size;
    this.#isExact = false;
  }
  #fitted = "";

  #look = () => `${this.#picture.fontSize} ${this.#colours.ground} ${this.#colours.ink}`;

  #mapKey = () => [this.#base, this.#tiles.changes, this.#at, this.#shown.grid, this.#shown.cloud, [...this.#hidden], this.#look()].join();
  #layers() {
    // The merged map lies below those of robots, and clouds lie upon grids.
    const rank = ({ kind, robot }) => 2 * Number(kind === "cloud") + Number(robot !== "");
    const layers = [...this.#tiles.layers.values()].filter(this.#isSeen);
    return layers.sort((a, b) => rank(a) - rank(b) || a.robot.localeCompare(b.robot));
  }
  #drawMaps = (paint, view, piece) => {
    drawLayers(paint, view, this.#tiles, this.#layers(), this.#at, this.#picture.density(), piece);
    drawLines(paint, this.#colours, view);
    drawOrigin(paint, this.#colours, view, this.#picture.fontSize / 14);
  };

  #tracksKey = () => [this.#base, this.#shown.tracks, this.#tracks.changes, this.#at ?? Math.floor(this.#now() / FADES_EVERY), this.#look()].join();
  #drawTracks = (paint, view) => {
    if (this.#shown.tracks) drawTracks(paint, this.#colours, view, this.#tracks.until(this.#at ?? Infinity), this.#now(), this.#picture.fontSize / 14);
  };

  #markersKey = () => [this.#places.markers.reduce((sum, { mark }) => (Math.imul(sum, 31) + mark) | 0, this.#places.markers.length), this.#look()].join();
  #drawMarkers = (paint, view) => drawShapes(paint, this.#colours, view, this.#places.markers, this.#picture.fontSize / 14);

  #signsKey = () => [this.#drawn, this.#at, this.isLive() ? 0 : this.#tracks.changes, this.#shown.robots, this.#shown.reports, this.#markersKey(), this.#followed,
    this.#pair?.map(({ number }) => number), this.#onTap !== null, this.#covers.boxes(), this.#picture.hasNames].join();
  #drawSigns = (paint, view) => {
    const { reports, robots, markers } = this.#places, size = this.#picture.fontSize, colours = this.#colours;
    const rim = [(view.width - this.#view.width) / 2, (view.height - this.#view.height) / 2];
    const labels = new Labels(paint, colours, size, { width: view.width, height: view.height, rim });
    for (const [left, top, right, bottom] of [...takenByMetres(this.#view, size), ...this.#covers.boxes()]) labels.keepOffBox([left + rim[0], top + rim[1], right + rim[0], bottom + rim[1]]);
    const robotSize = size / 1.8;
    keepOffRobots(labels, view, robots, robotSize);
    if (this.#pair) drawPairRings(paint, colours, labels, view, this.#pair, size);
    drawReports(paint, colours, labels, view, this.#run, reports, size / 2);
    drawRobots(paint, colours, view, robots, robotSize, this.#followed);
    if (!this.#picture.hasNames) return;
    nameRobots(labels, view, robots, robotSize, this.isLive() ? this.#ill : new Set());
    nameReports(labels, view, reports, size / 2, this.#pair ?? []);
    writeMarkers(labels, view, markers);
  };

  #drawOver(paint, view) {
    const size = this.#picture.fontSize;
    drawFigures(paint, this.#colours, view, size);
    drawScale(paint, this.#colours, view, size);
    this.#ruler.draw(paint, this.#colours, view, size);
    const isAimed = (this.#onTap || this.#ruler.isOn) && this.#canvas.matches(":focus-visible");
    if (isAimed) drawCross(paint, { ...this.#colours, ask: this.#colours.soft }, view.toPixel(view.centre), size / 2);
    if (this.#picked) drawCross(paint, this.#colours, view.toPixel(this.#picked), size / 2);
  }
}
