// The link over the last ten minutes: rate, queue, throttling, and each endpoint's delay.
import { draw, list, make, mark, say } from "./dom.js";
import { Plot } from "./plot.js";
import { answeredWords, bytes, mbit, ms } from "./words.js";

const plots = document.getElementById("plots");
const known = new Map(); // a plot by its key
const counted = new Map(); // an endpoint's throttled, when last sampled

/** What is plotted: {key, label, value, text, least, most(value)}; a null value is not known, and
 *  undefined is one that the box could not tell. */
function quantities(view, lost) {
  const sum = view.endpoints.reduce((all, row) => all + row.throttled, 0);
  const before = counted.get("all") ?? sum;
  counted.set("all", sum);
  const known = (value) => (lost ? undefined : value);
  return [
    {
      key: "rate",
      label: "Sent",
      value: known(view.sent_mbit),
      text: mbit(view.sent_mbit),
      of: `of ${mbit(view.budget_mbit)} Mbit/s`,
      least: 1,
      unit: (n) => `${mbit(n)} Mbit/s`,
    },
    {
      key: "queue",
      label: "Queued",
      value: known(view.queued_bytes),
      text: view.queued_bytes ? bytes(view.queued_bytes) : "empty",
      least: 1e5,
      unit: bytes,
    },
    ...view.endpoints.map((row) => ({
      key: `delay ${row.name}`,
      label: `${row.name === "scoring" ? "Scoring" : "Mapping"} answers in`,
      value: known(row.connected ? row.answer_ms : null),
      text: ms(row.connected ? row.answer_ms : null),
      old: answeredWords(row),
      least: 1,
      unit: ms,
    })),
    {
      key: "throttled",
      label: "Asked to slow down",
      value: known(Math.max(0, sum - before)),
      text: `${sum}`,
      of: sum === 1 ? "time" : "times",
      least: 1,
      unit: (n) => `${n} a second`,
    },
  ];
}

function create(quantity) {
  const svg = draw("0 0 149 32", { preserveAspectRatio: "none" }, { class: "lost" }, { class: "area" }, { class: "line" });
  known.set(quantity.key, new Plot(svg, quantity.least));
  return make("li", make("span.label", quantity.label), make("p", make("strong"), make("span.unit")), svg, make("span.note"));
}

const KEPT = { rate: "sent_mbit", queue: "queued_bytes", "delay scoring": "scoring_ms", "delay mapping": "mapping_ms", throttled: "throttled" };

/** From before this page was opened, as the box has it: its History. */
export function fillLink(history, time) {
  const whens = history.at.map((at) => Math.round(time - at)); // seconds ago, the oldest first
  const spacing = Math.ceil(history.spacing);
  const sampleOf = new Map(); // by seconds ago: a sample stands for the time until the next
  whens.forEach((ago, i) => {
    for (let later = 0; later < spacing && ago - later >= 0; ++later) sampleOf.set(ago - later, { i, isFirst: later === 0 });
  });
  for (const [key, plot] of known) {
    const values = history[KEPT[key]];
    if (!values) continue;
    plot.fill((ago) => {
      const sample = sampleOf.get(ago);
      if (!sample) return null;
      return key === "throttled" && !sample.isFirst ? 0 : values[sample.i];
    });
  }
}

let sampled = 0; // the box's time of the last sample

/** Once a second, however often it is called: what is now goes into the history. */
export function sampleLink(view, time, lost) {
  if (Math.abs(time - sampled) > 5) sampled = time - 1;
  if (time < sampled + 1) return;
  ++sampled;
  const all = quantities(view, lost);
  list(plots, all, (quantity) => quantity.key, create, (node, quantity) => {
    const plot = known.get(quantity.key);
    plot.push(quantity.value);
    plot.draw();
    const [now, unit] = node.children[1].children;
    say(now, quantity.value == null ? "–" : quantity.text);
    const isOld = quantity.value != null && Boolean(quantity.old);
    mark(node, "old", String(isOld));
    say(unit, isOld ? ` ${quantity.old}` : quantity.of ? ` ${quantity.of}` : "");
    say(node.children[3], `peak ${quantity.unit(plot.most())}`);
  });
}
