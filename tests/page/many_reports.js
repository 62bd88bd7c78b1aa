// A box with more reports than an event has.

import { retell } from "./retold.js";

export const COUNT = 450;
/** The page of a box that has that many reports, of which an event has the newest 200. */
export async function withMany(page) {
  const one = { type: "Rope", sender: "ugv1", received: 1e9, changed: 1e9, state: "answered", status: 201, report_status: "scored", score_change: 1, note: "", asking: false, reconciled: false, same_as: 0 };
  await retell(page, (one, count) => (view) => {
    const reports = Array.from({ length: 200 }, (_, i) => ({ ...one, number: count - i, run: view.run_number, position: { x: 10 * (count - i), y: 0, z: 0 } }));
    return { ...view, reports };
  }, one, COUNT);
  await page.route("**/adit/reports", async (route) => {
    const { run_number: run } = await (await fetch(new URL("run", route.request().url()), { headers: { Authorization: "Bearer team-1" } })).json();
    await route.fulfill({ json: Array.from({ length: COUNT }, (_, i) => ({ ...one, number: i + 1, run, position: { x: 10 * (i + 1), y: 0, z: 0 } })) });
  });
}
