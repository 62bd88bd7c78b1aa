// What the map shows of a run: its maps, tracks, markers, robots and reports at one time, without those that are hidden.
import { Markers } from "./map_markers.js";
import { isStale, lastSeen } from "./map_robots.js";
import { Tiles } from "./map_tiles.js";
import { Tracks } from "./map_tracks.js";
import { Steps } from "./steps.js";
import { byName } from "./words.js";

const INTERVAL = 5000; // ms: maps are asked for no more often
const MAX_METRES = 8192; // from the origin: farther data is not fitted into the view

export class MapScene {
  tiles;
  tracks;
  markers;
  /** What is shown at `time`. */
  places = { reports: [], robots: [], markers: [] };
  run = null;
  base = ""; // of a run that is kept: what its paths begin with
  key = ""; // differs if robots or reports do
  time = null; // null: now
  shown = { grid: true, cloud: true, robots: true, tracks: true, markers: true, reports: true, pointless: true };
  hidden = new Set(); // robots whose maps are not shown
  lateRobots = new Set(); // robots whose map does not come
  silentRobots = new Set(); // those of lateRobots that are silent
  #steps = new Steps();
  #reportChanges = 0;
  #version = -1;
  #isAsking = false;
  #due = -Infinity;
  #changed;
  #fetched;

  /** `changed()` is called if there is something new to draw, `fetched()` each time that the box has told of its maps. */
  constructor({ changed, fetched }) {
    this.#changed = changed;
    this.#fetched = fetched;
    this.tiles = new Tiles(changed);
    this.tracks = new Tracks(changed);
    this.markers = new Markers(changed);
  }

  /** Gives whether robots or reports differ from those of the view before. */
  show(run) {
    if (run.reports !== this.run?.reports) ++this.#reportChanges;
    this.run = run;
    if (this.#steps.seen(run.now)) this.#forget();
    if (run.map_version !== this.#version && !this.#isAsking && performance.now() >= this.#due) this.#refresh(run.map_version);
    this.markers.follow(run.marker_version);
    this.tracks.follow(run);
    this.lateRobots = new Set(run.standings.filter(({ level }) => level === "bad").map(({ name }) => name));
    this.silentRobots = new Set(run.standings.filter(({ silent }) => silent).map(({ name }) => name));
    const robots = run.robots.map((robot) => [lastSeen(robot, this.silentRobots), robot.position, robot.heading, isStale(robot)]);
    const key = JSON.stringify([this.#reportChanges, run.near_metres, robots, run.colours, this.markers.at(run.now).length, [...this.lateRobots]]);
    if (key === this.key) return false;
    this.key = key;
    return true;
  }

  /** A run that is kept: what the box has below `base`; it has no markers. `run`: {reports, the newest first, run_number, now: its end}. */
  replay(base, run) {
    this.tiles = new Tiles(this.#changed, base);
    this.tracks = new Tracks(this.#changed, base);
    this.run = { ...run, robots: [] };
    this.key = base;
    this.base = base;
    this.hidden.clear();
    this.tracks.follow(this.run);
    this.#refresh(-1);
  }

  /** The box's clock was set: all data has another time. */
  #forget() {
    this.#version = -1;
    for (const each of [this.tiles, this.markers, this.tracks]) each.forget();
  }

  async #refresh(version) {
    this.#isAsking = true;
    this.#due = performance.now() + INTERVAL;
    try {
      await this.tiles.refresh();
      this.#version = version;
      this.#fetched();
    } catch {
      // asked for again with the next event
    } finally {
      this.#isAsking = false;
    }
  }

  isLive = () => this.time === null;
  now = () => this.time ?? this.run?.now ?? 0;
  until = () => this.time ?? Infinity;
  robotNames = () => [...new Set([...this.tiles.layers.values()].map((layer) => layer.robot))].sort(byName);
  kinds = () => new Set([...this.tiles.layers.values()].map((layer) => layer.kind));
  #isShown = (layer) => this.shown[layer.kind] && !this.hidden.has(layer.robot);

  /** The layers of the maps that are shown, the lowest first: the merged map lies below those of robots. */
  layers() {
    const rank = ({ kind, robot }) => 2 * Number(kind === "cloud") + Number(robot !== "");
    const layers = [...this.tiles.layers.values()].filter(this.#isShown);
    return layers.sort((a, b) => rank(a) - rank(b) || byName(a.robot, b.robot));
  }

  #robots() {
    if (!this.shown.robots) return [];
    return this.isLive() ? this.run?.robots ?? [] : this.tracks.robotsAt(this.time);
  }

  /** Finds what is where at the time that is shown. */
  updatePlaces() {
    const { reports = [], run_number } = this.run ?? {};
    const isShown = (report) => report.position && report.run === run_number && report.received <= this.until() &&
      (this.shown.pointless || report.score_change !== 0);
    this.places = {
      reports: this.shown.reports ? reports.filter(isShown) : [],
      robots: this.#robots(),
      markers: this.shown.markers ? this.markers.at(this.now()) : [],
    };
  }

  /** The area of all maps, robots and reports that are shown, in metres; null if there are none. */
  bounds() {
    const all = { left: Infinity, bottom: Infinity, right: -Infinity, top: -Infinity, ...this.tiles.bounds(this.#isShown) };
    for (const { position: { x, y } } of [...this.places.reports, ...this.places.robots]) {
      if (Math.abs(x) > MAX_METRES || Math.abs(y) > MAX_METRES) continue;
      all.left = Math.min(all.left, x);
      all.right = Math.max(all.right, x);
      all.bottom = Math.min(all.bottom, y);
      all.top = Math.max(all.top, y);
    }
    return all.left > all.right ? null : all;
  }
}
