// A box with many reports on record.
import { until } from "../box.js";
import { box } from "./visits.js";

const AT_ONCE = 20;

/** Ropes, 10 m from each other, all of them recorded by the Command Post, which has as many left. */
export async function withReports(t, count) {
  const made = await box(t, { post: ["--reports", String(2 * count), "--rate", "0"], settings: { command_post: { rates: { reports_hz: 1000, status_hz: 20 } } } });
  for (let i = 0; i < count; i += AT_ONCE) await Promise.all(Array.from({ length: AT_ONCE }, (_, j) => made.compose("Rope", 10 * (i + j), 5)));
  const left = async () => (await made.run()).run.remaining_reports;
  await until(async () => (await left()) === count, "the reports to be recorded", 300_000);
  return made;
}
