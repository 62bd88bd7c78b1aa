// A made-up history of the box from before the page was opened.

/** The box's history: `seconds` of it up to now, one sample per two seconds. */
export function kept(now, seconds, alarms = []) {
  const at = Array.from({ length: seconds / 2 }, (_, i) => now - seconds + 2 * i);
  const all = (value) => at.map(() => value);
  return {
    spacing: 2, at, sent_mbit: at.map((_, i) => i % 50), queued_bytes: all(5e5), scoring_ms: all(7), mapping_ms: at.map((_, i) => (i % 2 ? 9 : null)), throttled: all(0),
    robots: [{ robot: "ANYmal1", ages: at.map((_, i) => i % 30) }], attention: alarms.map((ago) => ({ at: now - ago, came: true, sentence: "r3 is silent" })),
  };
}
/** Answers the page's requests with that history. The requests are in `page.historyAsked`. */
export const withHistory = (make) => (page) => page.route("**/adit/history*", (route) => {
  page.historyAsked = [...(page.historyAsked ?? []), new URL(route.request().url()).searchParams.get("since")];
  return route.fulfill({ json: make(Date.now() / 1000) });
});

/** The horizontal extent of each path. */
export const spans = (page, selector) => page.$$eval(selector, (paths) => paths.map((path) => {
  const xs = [...(path.getAttribute("d") ?? "").matchAll(/[ML]([\d.]+) /g)].map(([, x]) => Number(x));
  return xs.length ? Math.max(...xs) - Math.min(...xs) : 0;
}));
