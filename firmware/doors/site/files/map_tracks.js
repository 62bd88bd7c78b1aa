// The track of each robot. The box keeps about a pose a second (README.md: GET /adit/tracks). The page fetches them once
// and takes later poses from the run's events.
import { chooseColours, dashesOf, lookOf, orderRobots, robotColour } from "./robot_colour.js";
import { fetchSoon } from "./session.js";

const SPACING = 1, SAME_SPACING = 10; // s; the second while a robot stands
const SILENCE = 5; // s without an event: some were missed
const LONGEST = 10; // s: the box leaves out poses only between two that are no farther apart
const GAP = 60; // s without a pose: the way in between is unknown
const MIN_STEP = 2; // pixels: a line need not be finer
// From the newest: up to how many seconds ago, how wide, how strong.
const AGES = [[60, 2.25, 0.95], [300, 1.75, 0.6], [Infinity, 1.5, 0.35]];
const PATTERNED = 2; // of these ages, a robot's pattern: dashes of whole tracks cost too much

/** What the box left out of poses, [[at, x, y, z, heading]], because it is a straight way: a pose each second (README.md: GET
 *  /adit/tracks). */
export function filled(poses) {
  return poses.flatMap((pose, i) => {
    const next = poses[i + 1], steps = next ? Math.round((next[0] - pose[0]) / SPACING) : 1;
    if (steps > LONGEST || !next?.some((value, j) => j > 0 && Math.abs(value - pose[j]) > 0.1)) return [pose];
    const by = pose.map((value, j) => (j === 4 ? Math.atan2(Math.sin(next[j] - value), Math.cos(next[j] - value)) : next[j] - value));
    return Array.from({ length: Math.max(1, steps) }, (_, step) => pose.map((value, j) => value + (step / steps) * by[j]));
  });
}

export class Tracks {
  changes = 0; // counts what there is new to draw
  #all = new Map(); // robot to [[at, x, y, z, heading]], oldest first
  #run = null;
  #heard = 0; // the box's time of the last event
  isLoaded = false; // of this run, with no pose missed
  #asked = false;
  #changed;
  #base;

  /** `changed` is called when there is something new to draw. `base`: what the box's paths begin with. */
  constructor(changed, base = "/adit") {
    this.#changed = changed;
    this.#base = base;
  }

  follow({ now, run_number, robots, colours }) {
    if (chooseColours(colours)) ++this.changes;
    if (now - this.#heard > SILENCE) this.isLoaded = false; // poses may be missing
    this.#heard = now;
    if (run_number !== this.#run) {
      this.forget();
      this.#run = run_number;
    }
    if (!this.isLoaded) this.#fetch();
    for (const { name, at, position: { x, y, z }, heading } of robots) {
      const track = this.#of(name), last = track.at(-1), pose = [at, x, y, z, heading];
      const isSame = last && pose.every((value, i) => i === 0 || value === last[i]);
      if (!last || at >= last[0] + (isSame ? SAME_SPACING : SPACING)) track.push(pose);
    }
  }

  /** All are asked for again. */
  forget() {
    this.#all.clear();
    orderRobots([]);
    this.isLoaded = false;
    ++this.changes;
  }

  #of(name) {
    if (!this.#all.has(name)) this.#all.set(name, []);
    return this.#all.get(name);
  }

  async #fetch() {
    if (this.#asked) return;
    this.#asked = true;
    const run = this.#run;
    try {
      const answer = await fetchSoon(`${this.#base}/tracks`);
      if (!answer.ok || run !== this.#run) return;
      for (const { robot, poses } of (await answer.json()).tracks) {
        const last = poses.at(-1)[0];
        this.#all.set(robot, [...filled(poses), ...this.#of(robot).filter(([at]) => at > last + 0.01)]);
      }
      const first = (name) => this.#all.get(name)[0][0];
      orderRobots([...this.#all.keys()].sort().sort((a, b) => first(a) - first(b)));
      this.isLoaded = true;
      ++this.changes;
      this.#changed();
    } catch {
      // asked for again with the next event
    } finally {
      this.#asked = false;
    }
  }

  /** [{name, position, heading, age}] as they were at that time. */
  robotsAt(time) {
    const robots = [];
    for (const [name, track] of this.#all) {
      const pose = track.findLast(([at]) => at <= time);
      if (pose) robots.push({ name, age: time - pose[0], position: { x: pose[1], y: pose[2], z: pose[3] }, heading: pose[4] });
    }
    return robots;
  }

  /** Each robot's poses up to that time: [{name, poses}]. */
  until(time) {
    const cut = (poses) => (poses.at(-1)?.[0] <= time ? poses : poses.slice(0, poses.findLastIndex(([at]) => at <= time) + 1));
    return [...this.#all].map(([name, poses]) => ({ name, poses: cut(poses) }));
  }
}

/** In each robot's colour and pattern; older poses are fainter. `unit`: pixels, by the size of the page's letters. `since`: draws only
 *  later poses. */
export function drawTracks(ctx, colours, view, tracks, now, unit, since = -Infinity) {
  ctx.lineJoin = "round";
  for (let age = AGES.length - 1; age >= 0; --age) {
    const [oldest, width, alpha] = AGES[age], newest = AGES[age - 1]?.[0] ?? -Infinity;
    for (const { name, poses } of tracks) {
      if (!trace(ctx, view, poses, Math.max(since, now - oldest), now - newest)) continue;
      if (age === 0) {
        Object.assign(ctx, { lineWidth: (width + 2) * unit, strokeStyle: colours.ground, globalAlpha: 0.5 });
        ctx.stroke();
      }
      Object.assign(ctx, { lineWidth: width * unit, strokeStyle: robotColour(name), globalAlpha: alpha });
      if (age < PATTERNED) ctx.setLineDash(dashesOf(lookOf(name).pattern).map((length) => length * unit));
      ctx.stroke();
      ctx.setLineDash([]);
    }
  }
  ctx.globalAlpha = 1;
}

/** The index of the first pose after `time`. */
function firstAfter(poses, time) {
  let low = 0, high = poses.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (poses[middle][0] > time) high = middle;
    else low = middle + 1;
  }
  return low;
}

/** The way after `from` up to `to`, from the pose before it on. Gives whether there is one. */
function trace(ctx, view, poses, from, to) {
  const begin = Math.max(0, firstAfter(poses, from) - 1), end = firstAfter(poses, to);
  if (end - begin < 2) return false;
  const step = MIN_STEP / view.scale;
  let lastX = 0, lastY = 0, lastAt = -Infinity;
  ctx.beginPath();
  for (let i = begin; i < end; ++i) {
    const { 0: at, 1: x, 2: y } = poses[i], isGap = at - lastAt > GAP;
    lastAt = at;
    if (!isGap && i < end - 1 && Math.hypot(x - lastX, y - lastY) < step) continue;
    if (isGap) ctx.moveTo(...view.toPixel({ x, y }));
    else ctx.lineTo(...view.toPixel({ x, y }));
    [lastX, lastY] = [x, y];
  }
  return true;
}
