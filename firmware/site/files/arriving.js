// What the figures mean: for each thing a level (its shape and colour), a word, and a sentence where one helps.
//   good: as it should be   wait: late, or about to be decided   bad: it does not work   quiet: nothing to tell
//   ask: it waits for the operator's word
import { age, signed } from "./words.js";

// Seconds that the Command Post may be behind, or that nothing was sent.
const FAILING = 10, LATE = 5, STUCK = 90, QUIET = 60;

const KINDS = { grid: "grid", cloud: "cloud", state: "pose", markers: "markers" };
export const kindOf = (row) => KINDS[row.kind] ?? row.kind;
export const robotOf = (row) => row.robot || "Merged map";

/** Whether what a robot sends of one kind reaches the Command Post, and how far that is behind. */
export function arrival(row, now) {
  const behind = row.behind_since === null ? 0 : now - row.behind_since;
  const throttled = row.last_status === 429;
  if (row.last_status >= 400 && row.last_status < 500 && !throttled) return { level: "bad", word: "refused" };
  if (behind > STUCK) return { level: "bad", word: "not arriving" };
  if (throttled) return { level: "wait", word: "throttled" };
  if (row.last_sentence) return behind > FAILING ? { level: "bad", word: "not arriving" } : { level: "wait", word: "failing" };
  if (behind > LATE) return { level: "wait", word: `${age(behind)} behind` };
  if (row.last_forwarded === null) return { level: "wait", word: "waiting" };
  if (behind) return { level: "good", word: "arriving" };
  return now - row.last_forwarded > QUIET ? { level: "quiet", word: "quiet" } : { level: "good", word: "up to date" };
}

const RANK = ["quiet", "good", "wait", "bad"];
const worst = (arrivals) =>
  arrivals.reduce((a, b) => (RANK.indexOf(b.level) > RANK.indexOf(a.level) ? b : a), { level: "quiet" });

const since = ({ row }) => row.behind_since ?? Infinity;

/** One sentence over all maps, those first that are longest behind: is my map arriving? */
export function overall(activities, now) {
  const maps = activities.filter((row) => row.kind === "grid" || row.kind === "cloud");
  if (maps.length === 0) return { level: "quiet", word: "No robot has sent a map yet" };
  const arrivals = maps.map((row) => ({ ...arrival(row, now), row }));
  const { level } = worst(arrivals);
  const those = arrivals.filter((arrival) => arrival.level === level).sort((a, b) => since(a) - since(b));
  const names = those.map(({ row, word }) => `${robotOf(row)} ${kindOf(row)} ${word}`);
  const who = names.length > 3 ? `${names.slice(0, 2).join(", ")} and ${names.length - 2} more` : names.join(", ");
  if (level === "bad") return { level, word: `No: ${who}` };
  if (level === "wait") return { level, word: `Not all: ${who}` };
  if (level === "good") return { level, word: "Yes, every map arrives" };
  const last = Math.min(...maps.map((row) => now - (row.last_forwarded ?? -Infinity)));
  return { level, word: `All arrived; nothing new for ${age(last)}` };
}

function gained({ score_change, report_status }) {
  if (score_change === null) return { level: "quiet", word: report_status || "answered" };
  if (score_change > 0) return { level: "good", word: `scored ${signed(score_change)}` };
  return { level: "quiet", word: score_change === 0 ? "no points" : `scored ${signed(score_change)}` };
}

/** Where a report is in its life. */
export function life(report) {
  switch (report.state) {
    case "received": return { level: "ask", word: "held" };
    case "waiting": return { level: "wait", word: "waiting" };
    case "sending": return { level: "wait", word: "sending" };
    case "in doubt": return report.asking ? { level: "wait", word: "in doubt, asking" } : { level: "ask", word: "in doubt" };
    case "refused": return { level: "bad", word: "refused" };
    case "answered": return gained(report);
    case "settled": return report.reconciled ? gained(report) : { level: "quiet", word: "called done" };
    case "withdrawn": return { level: "quiet", word: report.same_as ? `same as #${report.same_as}` : "withdrawn" };
    default: return { level: "quiet", word: report.state };
  }
}

export function endpoint(row) {
  if (row.trouble) return { level: "bad", word: row.connected ? "failing" : "not connected" };
  if (!row.connected) return { level: "wait", word: "not connected" };
  return row.last_status >= 400 ? { level: "wait", word: "connected" } : { level: "good", word: "connected" };
}
