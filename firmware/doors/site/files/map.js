// The map of a run on a canvas: its view, and the actions of the page and its operator on it. map_scene.js has the content of
// the map, map_drawing.js draws it.
import { MapDrawing } from "./map_drawing.js";
import { listenTo } from "./map_input.js";
import { robotAt } from "./map_robots.js";
import { Ruler } from "./map_ruler.js";
import { MapScene } from "./map_scene.js";
import { looksOf } from "./map_theme.js";
import { MapView } from "./map_view.js";

const PAIR_MARGIN = 4; // metres around two reports that are compared
const SCALE_ROOM = 4; // letters: the scale and a report above it

export class MapOfRun {
  #canvas;
  #view = new MapView();
  #ruler = new Ruler();
  #scene = new MapScene({ changed: () => this.#drawing.picture.changed(), fetched: () => this.#fetched() });
  #marks = { followed: null, pair: null, cross: null, isTapped: false }; // isTapped: taps are the page's own
  #drawing;
  #tapped = null;
  #isFit = true; // until somebody moves it, all is shown
  #isExact = true; // and at the next look so that it just fits; else only what leaves the view moves that
  #fittedSize = "";
  onLayers = () => {};
  onTool = () => {};

  /** `canvas` is in the page and has its size by CSS. */
  constructor(canvas) {
    this.#canvas = canvas;
    const prepare = () => this.#prepare();
    this.#drawing = new MapDrawing(canvas, { view: this.#view, scene: this.#scene, marks: this.#marks, ruler: this.#ruler, prepare });
    this.#drawing.picture.resize();
  }

  redraw = () => this.#drawing.picture.redraw();
  markers = () => this.#scene.markers;
  robots = () => this.#scene.robotNames();
  kinds = () => this.#scene.kinds();
  followed = () => this.#marks.followed;
  ruler = () => this.#ruler;
  /** When the first map came; null where there is none yet. */
  first = () => this.#scene.tiles.first();
  /** [{name, poses: [[at, x, y, z, heading]]}] of this run until now; null: not loaded yet. */
  tracks = () => (this.#scene.tracks.isLoaded ? this.#scene.tracks.until(Infinity) : null);

  /** What a legend needs: {heights: colours, the lowest first, spread: {low, high} in metres}; null while clouds are coloured by robot. */
  legend() {
    const { tiles } = this.#scene, { colours, isByRobot } = this.#drawing;
    return isByRobot ? null : { heights: looksOf(colours).heights ?? tiles.colours?.heights, spread: tiles.heights };
  }

  show(run) {
    const { picture } = this.#drawing, isUrgent = run.reports !== this.#scene.run?.reports;
    if (this.#scene.show(run)) picture.changed();
    picture.update(isUrgent);
  }

  /** Shows a run that is kept: see MapScene.replay(). */
  lookAgain(base, run) {
    this.follow(null);
    this.measure(false);
    this.#scene.replay(base, run);
    this.#drawing.recolour();
    this.fit();
  }

  #fetched() {
    this.#drawing.fetchMaps();
    this.onLayers();
  }

  /** Lets it be moved by hand. */
  takeInput() {
    listenTo(this.#canvas, this.#view, {
      moved: () => {
        this.follow(null);
        this.#movedByHand();
      },
      held: (isHeld) => this.#drawing.picture.hold(isHeld),
      tapped: (place) => this.#tap(place),
      fit: () => this.fit(),
    });
  }

  #movedByHand() {
    this.#isFit = false;
    this.#drawing.picture.moved();
  }

  #tap(place) {
    if (this.#tapped) return this.#tapped(place);
    if (!this.#ruler.isOn) return this.follow(robotAt(this.#view, this.#scene.places.robots, place)?.name ?? null);
    this.#ruler.put(place);
    this.onTool();
    this.redraw();
  }

  zoom(factor) {
    this.#view.zoom(factor);
    this.#movedByHand();
  }

  /** Shows all there is. */
  fit() {
    this.follow(null);
    this.#isFit = true;
    this.#isExact = true;
    this.redraw();
  }

  #set(change) {
    change();
    this.#isExact = true;
    this.redraw();
  }
  setTime = (time) => this.#set(() => (this.#scene.time = time));
  setShown = (what, isShown) => this.#set(() => (this.#scene.shown[what] = isShown));
  setRobot = (robot, isShown) => this.#set(() => this.#scene.hidden[isShown ? "delete" : "add"](robot));
  /** A cross at {x, y}; null: none. */
  setCross = (place) => this.#set(() => (this.#marks.cross = place));

  /** `tapped({x, y})` is called for each tap; null: a tap follows a robot or measures. */
  setTap(tapped) {
    if (tapped) this.measure(false);
    this.#tapped = tapped;
    this.#set(() => (this.#marks.isTapped = tapped !== null));
  }

  colourBy(what) {
    this.#drawing.isByRobot = what === "robot";
    this.#drawing.recolour();
    this.onLayers();
  }

  /** Keeps that robot in the middle; null: none. */
  follow(name) {
    if (name === this.#marks.followed) return;
    this.#marks.followed = name;
    if (name) this.#isFit = false;
    this.onTool();
    this.redraw();
  }

  /** How far it is with images of the maps that are being fetched: Tiles.progress(). */
  progress = () => this.#scene.tiles.progress();

  measure(isOn) {
    if (isOn === this.#ruler.isOn) return;
    this.#ruler.set(isOn);
    this.onTool();
    this.redraw();
  }

  /** Looks at two reports and rings them; null: at none. */
  showPair(pair) {
    this.follow(null);
    this.#marks.pair = pair;
    if (pair) this.#fitPair(pair.map(({ position }) => position));
    this.redraw();
  }

  #fitPair([one, other]) {
    const margin = PAIR_MARGIN + Math.max(Math.abs(one.x - other.x), Math.abs(one.y - other.y)) / 2;
    this.#isFit = false;
    this.#view.fit({
      left: Math.min(one.x, other.x) - margin,
      right: Math.max(one.x, other.x) + margin,
      bottom: Math.min(one.y, other.y) - margin,
      top: Math.max(one.y, other.y) + margin,
    });
    this.#view.pan(0, this.#view.height / 6); // below their label
  }

  /** Before each frame: what is where, and where one looks. */
  #prepare() {
    this.#scene.updatePlaces();
    const followed = this.#scene.places.robots.find(({ name }) => name === this.#marks.followed);
    if (followed) this.#view.lookAt(followed.position.x, followed.position.y);
    if (this.#isFit) this.#fitAll();
  }

  #fitAll() {
    const area = this.#scene.bounds(), size = `${this.#view.width} ${this.#view.height}`;
    if (!area || (!this.#isExact && size === this.#fittedSize && this.#view.holds(area))) return;
    const isPhone = matchMedia("(max-width: 900px)").matches; // as map.css: the legend has a row of its own
    this.#view.fit(area, isPhone ? SCALE_ROOM * this.#drawing.picture.fontSize : 0);
    this.#fittedSize = size;
    this.#isExact = false;
  }
}
