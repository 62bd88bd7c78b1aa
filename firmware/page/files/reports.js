// Artifact reports, newest first, each with where it is in its life and what the Command Post said.
import { badge, list, make, mark, say } from "./dom.js";
import { life } from "./verdict.js";
import { ago, clip, metres } from "./words.js";

const section = document.getElementById("reports");

function create() {
  return make("li", make("span.badge"), make("span.what"), make("span.where"), make("span.since"), make("span.more"));
}

/** How the operator decides; until the page can, by the shell. */
function choice(report) {
  if (life(report).level !== "ask") return "";
  return `adit reports send ${report.number}, or ${report.state === "in doubt" ? "done" : "withdraw"} ${report.number}`;
}

/** What else there is to know: the Command Post's words, or why it is where it is. */
function more(report) {
  const said = report.report_status && report.report_status !== "scored" ? report.report_status : "";
  const found = report.reconciled ? "found out from the run’s status" : "";
  return [said, found, report.note, report.status >= 400 ? `status ${report.status}` : "", choice(report)].filter(Boolean).join(" · ");
}

export function showReports({ reports, run_number }, now) {
  const open = reports.filter((report) => ["received", "waiting", "sending", "in doubt"].includes(report.state)).length;
  say(section.querySelector(".count"), !reports.length ? "" : open ? `${reports.length}, ${open} open` : `${reports.length}`);
  section.querySelector(".rows").hidden = reports.length === 0;
  section.querySelector(".empty").hidden = reports.length > 0;
  list(section.querySelector(".rows"), reports, (report) => report.number, create, (node, report) => {
    const { level, word } = life(report);
    const [verdict, what, where, since, rest] = node.children;
    mark(node, "level", level);
    badge(verdict, level, clip(word, 40));
    say(what, clip(report.type, 40));
    const { x, y, z } = report.position;
    say(where, `${metres(x)}, ${metres(y)}, ${metres(z)} m`);
    const earlier = report.run === run_number ? "" : ` · run ${report.run}`;
    say(since, `#${report.number} · ${ago(now - report.received)}${earlier}`);
    say(rest, clip(more(report)));
  });
}
