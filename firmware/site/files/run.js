// How the run stands, in the strip's large figures; what needs the operator, and the lights as they are on the box.
import { badge, list, make, mark, say } from "./dom.js";
import { ago, clip, clock } from "./words.js";

const at = (id) => document.getElementById(id);
const FRESH = 15; // s: what the Command Post said longer ago is told with its time
const FEW = 5; // reports left

// A run clock that was heard to move goes on between two answers; one that stands still stays where it is.
let heard = null, ticking = false;

/** What the run's clock says at that time of the box. */
function runClock(view, now) {
  const { run_clock } = view.run;
  if (!heard || heard.at !== view.run_heard) {
    if (heard && run_clock !== heard.clock) ticking = run_clock > heard.clock;
    else if (heard && view.run_heard - heard.at > 1.5) ticking = false;
    heard = { at: view.run_heard, clock: run_clock };
  }
  return ticking ? run_clock + Math.max(0, now - view.run_heard) : run_clock;
}

/** `stale`: since when, or "". */
function figure(id, text, label, { stale = "", level = "" } = {}) {
  const node = at(id);
  if (!node) return; // the display has not all
  say(node, text);
  say(node.parentNode.querySelector("dt"), stale ? `${label} ${stale}` : label);
  mark(node.parentNode, "stale", String(Boolean(stale)));
  mark(node.parentNode, "level", level);
}

/** None left must not look like many: filled, and in words. */
function left(count) {
  if (count <= 0) return ["none left", "bad"];
  return ["reports left", count <= FEW ? "wait" : ""];
}

export function showRun(view, now, lost) {
  const { run } = view;
  const since = view.run_heard === null ? Infinity : now - view.run_heard;
  const isStale = !run || since > FRESH || lost;
  const stale = run && isStale ? clock(run.run_clock) : "";
  mark(at("run"), "stale", String(isStale));
  const seconds = run ? runClock(view, now) : 0, toGo = view.run_seconds - seconds;
  figure("clock", run ? clock(seconds) : "–", "run clock");
  figure("togo", run ? clock(Math.abs(toGo)) : "–", toGo < 0 ? "over time" : "to go");
  figure("score", run ? String(run.score) : "–", "score", { stale });
  const [label, level] = run ? left(run.remaining_reports) : ["reports left", ""];
  figure("remaining", run ? String(run.remaining_reports) : "–", label, { stale, level });
  const team = run?.current_team ? `${clip(run.current_team, 40)} · ` : "";
  if (!run) say(at("run-note"), "No answer from the Command Post yet");
  else say(at("run-note"), isStale ? `${team}last answer ${ago(since)}` : `${team}updated ${ago(since)}`);
}

/** `lost`: what to say of a box that does not answer, or "". */
export function showAttention(alarms, lost) {
  const all = lost ? [{ id: "lost", severity: "bad", what: lost }] : [];
  const create = () => make("p.alarm");
  list(at("attention"), [...all, ...alarms], ({ id }) => id, create, (node, { severity, what, why, acknowledged }) => {
    mark(node, "level", severity);
    mark(node, "acknowledged", String(Boolean(acknowledged)));
    badge(node, severity, clip(why ? `${what}: ${why}` : what));
  });
}

// On and off show by themselves, as filled and hollow: their words are for those who do not see them.
const PATTERNS = { off: "off", on: "on", slow: "blinks", fast: "blinks fast", twice: "flashes", flash: "glints", wink: "winks", rush: "blinks very fast", digits: "tells the address" };

export function showLights(lights) {
  const create = () => make("li", make("span.led"), make("span.name"), make("span.pattern"));
  list(at("lights"), lights, (light) => light.name, create, (node, light) => {
    mark(node, "pattern", light.pattern);
    const [, name, pattern] = node.children;
    say(name, clip(light.name, 20));
    say(pattern, clip(PATTERNS[light.pattern] ?? light.pattern, 20));
  });
}
