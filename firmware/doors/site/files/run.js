// How the run stands, in the strip's large figures; the alarms for the operator, and the lights of the box.
import { badge, list, make, mark, say } from "./dom.js";
import { ago, clip, clock } from "./words.js";

const at = (id) => document.getElementById(id);
const FEW = 5; // reports left
const LABELS = { clock: "run clock", togo: "to go", score: "score", remaining: "reports left" };

function figure(id, text, label, { isStale = false, level = "" } = {}) {
  const node = at(id);
  if (!node) return; // the display has not all
  say(node, text);
  say(node.parentNode.querySelector("dt"), label);
  mark(node.parentNode, "stale", String(isStale));
  mark(node.parentNode, "level", level);
}

/** None left must not look like many: filled, and in words. */
function left(count) {
  if (count <= 0) return ["none left", "bad"];
  return [LABELS.remaining, count <= FEW ? "wait" : ""];
}

export function showRun(view, now, lost) {
  const { run } = view;
  if (!run) {
    for (const [id, label] of Object.entries(LABELS)) figure(id, "–", label);
    return say(at("run-note"), "No answer from the Command Post yet");
  }
  const { runs, old, ...then } = view.run_clock, since = now - view.now, isStale = old || Boolean(lost);
  const seconds = then.seconds + (runs ? since : 0), toGo = view.run_seconds - seconds;
  const told = (time) => (isStale && runs ? `≈${clock(time)}` : clock(time));
  const stale = isStale ? clock(run.run_clock) : "";
  figure("clock", told(seconds), LABELS.clock, { isStale });
  figure("togo", told(Math.abs(toGo)), toGo < 0 ? "over time" : LABELS.togo, { isStale });
  figure("score", String(run.score), stale ? `score ${stale}` : "score", { isStale });
  const [label, level] = left(run.remaining_reports);
  figure("remaining", String(run.remaining_reports), stale ? `${label} ${stale}` : label, { isStale, level });
  const team = run.current_team ? `${clip(run.current_team, 40)} · ` : "";
  say(at("run-note"), `${team}${isStale ? "last answer" : "updated"} ${ago(then.age + since)}`);
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
