// When a page assumes a step of the box's clock, without a browser.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Steps } from "../../firmware/doors/site/files/steps.js";

const YEARS = 3e8;

function told(t) {
  const page = { now: 1000 };
  t.mock.method(performance, "now", () => page.now * 1000);
  return { page, steps: new Steps() };
}

test("a running clock, late events and a lost connection are not a step", (t) => {
  const { page, steps } = told(t);
  let box = 1.8e9;
  assert.equal(steps.seen(box), false, "the first time is not a step");
  for (const pass of [1, 1.5, 0.5, 300]) {
    page.now += pass;
    box += pass;
    assert.equal(steps.seen(box - 1.5 * (pass === 1.5)), false, `${pass} s`);
  }
  for (let i = 0; i < 60; ++i) {
    page.now += 1;
    assert.equal(steps.seen(box), false, "a repeated event is not a step");
  }
  assert.equal(steps.seen(box + 60), false, "the connection is back, which is not a step");
});

test("a step forward or back is reported once", (t) => {
  const { page, steps } = told(t);
  steps.seen(1.8e9);
  for (const [passed, box] of [[1, 1.8e9 + YEARS], [1, 1.8e9 - YEARS], [1, 1.8e9 - YEARS + 30]]) {
    page.now += passed;
    assert.equal(steps.seen(box), true);
    page.now += passed;
    assert.equal(steps.seen(box + passed), false);
  }
});
