// Where each robot was. The box keeps about a pose a second (README.md: GET /adit/tracks); they are fetched once,
// and what comes after is taken from the run's own events.

const SPACING = 1; // s
const SILENCE = 5; // s without an event: some were missed
const GAP = 60; // s without a pose: where it went in between is not known
const LEAST_STEP = 2; // pixels: a line need not be finer

export class Tracks {
  #all = new Map(); // robot to [[at, x, y, z, heading]], oldest first
  #run = null;
  #heard = 0; // the box's time of the last event
  #fetched = false;
  #asked = false;
  #changed;

  /** `changed` is called when there is something new to draw. */
  constructor(changed) {
    this.#changed = changed;
  }

  follow({ now, run_number, robots }) {
    if (now - this.#heard > SILENCE) this.#fetched = false; // what came meanwhile was missed
    this.#heard = now;
    if (run_number !== this.#run) {
      this.#all.clear();
      this.#fetched = false;
      this.#run = run_number;
    }
    if (!this.#fetched) this.#fetch();
    for (const { name, at, position: { x, y, z }, heading } of robots) {
      const track = this.#of(name), last = track.at(-1);
      if (!last || (at >= last[0] + SPACING && (x !== last[1] || y !== last[2] || heading !== last[4] || at > last[0] + 10))) {
        track.push([at, x, y, z, heading]);
      }
    }
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
      const answer = await fetch("/adit/tracks");
      if (!answer.ok || run !== this.#run) return;
      for (const { robot, poses } of (await answer.json()).tracks) {
        const last = poses.at(-1)[0];
        this.#all.set(robot, [...poses, ...this.#of(robot).filter(([at]) => at > last + 0.01)]);
      }
      this.#fetched = true;
      this.#changed();
    } catch {
      // asked for again with the next event
    } finally {
      this.#asked = false;
    }
  }

  /** [{name, position, heading, at}] as they were at that time. */
  robotsAt(time) {
    const robots = [];
    for (const [name, track] of this.#all) {
      const pose = track.findLast(([at]) => at <= time);
      if (pose) robots.push({ name, at: pose[0], position: { x: pose[1], y: pose[2], z: pose[3] }, heading: pose[4] });
    }
    return robots;
  }

  /** Each robot's poses up to that time. */
  until = (time) => [...this.#all.values()].map((track) => track.filter(([at]) => at <= time));
}

/** `unit`: pixels, by the size of the page's letters. */
export function drawTracks(paint, colours, view, tracks, unit) {
  paint.save();
  paint.lineJoin = "round";
  for (const [width, colour, alpha] of [[4, colours.ground, 0.5], [1.75, colours.lamp, 0.8]]) {
    Object.assign(paint, { lineWidth: width * unit, strokeStyle: colour, globalAlpha: alpha });
    for (const track of tracks) drawTrack(paint, view, track);
  }
  paint.restore();
}

function drawTrack(paint, view, track) {
  let last = null, lastAt = -Infinity;
  paint.beginPath();
  track.forEach(([at, x, y], i) => {
    const [left, top] = view.toPixel({ x, y });
    const step = last ? Math.hypot(left - last[0], top - last[1]) : Infinity;
    const isGap = at - lastAt > GAP;
    lastAt = at;
    if (step < LEAST_STEP && !isGap && i < track.length - 1) return;
    if (isGap) paint.moveTo(left, top);
    else paint.lineTo(left, top);
    last = [left, top];
  });
  paint.stroke();
}
