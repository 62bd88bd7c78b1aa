// When a page takes it that somebody set the box's clock, without a browser.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Steps } from "../../firmware/doors/site/files/steps.js";

const YEARS = 3e8;

function told(t) {
  const page = { now: 1000 };
  t.mock.method(performance, "now", () => page.now * 1000);
  return { page, steps: new Steps() };
}

test("a clock that runs, late events and a lost connection are no step", (t) => {
  const { page, steps } = told(t);
  let box = 1.8e9;
  assert.equal(steps.seen(box), false, "the first is compared with nothing");
  for (const pass of [1, 1.5, 0.5, 300]) {
    page.now += pass;
    box += pass;
    assert.equal(steps.seen(box - 1.5 * (pass === 1.5)), false, `${pass} s`);
  }
  for (let i = 0; i < 60; ++i) {
    page.now += 1;
    assert.equal(steps.seen(box), false, "what was told last is shown again");
  }
  assert.equal(steps.seen(box + 60), false, "and it is back");
});

test("a step is one, either way, and told once", (t) => {
  const { page, steps } = told(t);
  steps.seen(1.8e9);
  for (const [passed, box] of [[1, 1.8e9 + YEARS], [1, 1.8e9 - YEARS], [1, 1.8e9 - YEARS + 30]]) {
    page.now += passed;
    assert.equal(steps.seen(box), true);
    page.now += passed;
    assert.equal(steps.seen(box + passed), false);
  }
});
