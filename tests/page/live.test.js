// When a page is drawn: events may come four times per second, faster than a user reads.
import assert from "node:assert/strict";
import { test } from "node:test";
import { text, watch } from "./watch.js";

/** Replaces the event stream: the test sends events with `tell(type, data)`. */
function hearTheTest() {
  globalThis.EventSource = class extends EventTarget {
    readyState = 1;
    constructor() {
      super();
      globalThis.tell = (type, data) => this.dispatchEvent(new MessageEvent(type, { data: JSON.stringify(data) }));
      fetch("/adit/run").then((answer) => answer.json()).then((view) => globalThis.tell("message", view));
    }
    close() {}
  };
}

test("is drawn each second, and at once if a report or an alarm changed", async (t) => {
  const prepare = async (page) => {
    await page.clock.install();
    await page.addInitScript(hearTheTest);
  };
  const { page } = await watch(t, "calm", { prepare });
  const tell = (patch) => page.evaluate((patch) => globalThis.tell("patch", patch), patch);
  const score = () => text(page, "#score");
  await page.clock.pauseAt(await page.evaluate(() => Date.now() + 1000));
  const before = await score();
  for (const next of [711, 712]) await tell({ run: { score: next } });
  assert.equal(await score(), before, "the page is not drawn with each event");
  await page.clock.runFor(1000);
  assert.equal(await score(), "712");

  const alarm = { id: "x", severity: "bad", side: "box", what: "A new alarm", why: "", since: 1, acknowledged: false, hides: 0, action: { word: "", link: "" } };
  for (const [next, change] of [[713, { reports: { rows: { 0: { note: "new" } } } }], [714, { alarms: [alarm] }]]) {
    await tell({ run: { score: next }, ...change });
    assert.equal(await score(), String(next), Object.keys(change)[0]);
  }
});
