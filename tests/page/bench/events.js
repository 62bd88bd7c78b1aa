// Size and cost of an open page's events: a row of figures for a number of robots and 1,000 reports on record.
import { once } from "node:events";
import { readFileSync } from "node:fs";
import { get } from "node:http";
import { setTimeout as sleep } from "node:timers/promises";
import { until } from "../box.js";
import { begin, TOKENS } from "../box/box.js";

const REPORTS = Number(process.env.BENCH_REPORTS ?? 1000), SECONDS = Number(process.env.BENCH_SECONDS ?? 20), AT_ONCE = 20, ROUNDS = Number(process.env.BENCH_ROUNDS ?? 5);

export const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

/** CPU seconds of the loop's thread so far. The loop makes events; other threads pack maps. */
const cpu = ({ pid }) => Number(readFileSync(`/proc/${pid}/task/${pid}/schedstat`, "utf8").split(" ")[0]) / 1e9;

/** Per cent of a core, measured over `seconds`. */
export async function share(made, seconds = SECONDS) {
  const [before, began] = [cpu(made), performance.now()];
  await sleep(seconds * 1000);
  return (100 * (cpu(made) - before)) / ((performance.now() - began) / 1000);
}

/** Reads the event stream: counts bytes and events, and the bytes of the first event. */
export async function listen(made) {
  const request = get(`${made.url}adit/events`, { headers: { Authorization: `Bearer ${TOKENS.team}` } });
  const [answer] = await once(request, "response");
  const heard = { bytes: 0, events: 0, first: 0, end: () => request.destroy() };
  let before = "";
  answer.setEncoding("latin1").on("data", (piece) => {
    heard.bytes += piece.length;
    const ends = (before + piece).split("\n\n").length - 1;
    heard.first ||= ends ? heard.bytes : 0;
    heard.events += ends;
    before = piece.endsWith("\n\n") ? "" : piece.slice(-1);
  }).on("error", () => {});
  await until(() => heard.events, "the first event");
  return heard;
}

/** A box with that many active robots and 1,000 reports on record. */
export async function withReports(robots) {
  const made = await begin({ robots, post: ["--reports", String(2 * REPORTS), "--rate", "0"], settings: { command_post: { rates: { reports_hz: 1000, status_hz: 2 } } } });
  for (let i = 0; i < REPORTS; i += AT_ONCE) await Promise.all(Array.from({ length: AT_ONCE }, (_, j) => made.compose("Rope", 10 * (i + j), i)));
  await until(async () => (await made.run()).run.remaining_reports <= REPORTS, "the reports to be recorded", 600_000);
  return made;
}

/** {first, rate, events, share}: bytes of the first event; kB and events per second of the others; per cent of a core for a page. */
export async function eventsWith(robots) {
  const made = await withReports(robots);
  try {
    await sleep(10_000);
    const rounds = [];
    for (let i = 0; i < ROUNDS; ++i) {
      const without = await share(made), heard = await listen(made);
      const [bytes, events, began] = [heard.bytes, heard.events, performance.now()];
      const withOne = await share(made), seconds = (performance.now() - began) / 1000;
      heard.end();
      rounds.push({ first: heard.first, rate: (heard.bytes - bytes) / 1000 / seconds, events: (heard.events - events) / seconds, share: withOne - without });
    }
    return Object.fromEntries(Object.keys(rounds[0]).map((name) => [name, median(rounds.map((round) => round[name]))]));
  } finally {
    await made.end();
  }
}
