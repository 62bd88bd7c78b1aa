// The spare box on the system page: a user puts the first box on standby, exports it, and lets the second one take over.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { axeFindsNothing } from "../axe.js";
import { until } from "../box.js";
import { launch, leave, visit } from "../stage.js";
import { begin, TOKENS } from "./box.js";

let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

async function box(t) {
  const made = await begin();
  t.after(() => made.end());
  return made;
}

/** The spare box's system page, for spares. */
async function spareOf(t, made) {
  const page = await visit(browser, `${made.url}system.html#spare`, { extraHTTPHeaders: { Authorization: `Bearer ${TOKENS.team}` }, acceptDownloads: true, bypassCSP: true });
  t.after(() => leave(page));
  await page.waitForSelector("#spare:not([hidden])");
  return { page, section: page.locator("#spare"), press: (name) => page.locator("#spare").getByRole("button", { name }).click() };
}

const yes = (page) => page.locator("#confirm button.main").click();
const no = (page) => page.locator("#confirm button").first().click();
const notes = (section, words) => section.locator(".note", { hasText: words }).waitFor();

test("one press puts the box on standby and downloads its export, with which the other box takes over", async (t) => {
  const [first, spare] = await Promise.all([box(t), box(t)]);
  await until(async () => (await first.run()).run_clock, "the run");
  const number = await first.compose("Drill", 3, 4, 5);
  await first.becomes(number, "answered");

  const here = await spareOf(t, first);
  await here.press("Start standby and export");
  await no(here.page);
  assert.equal((await first.ask("/adit/spare")).said.standby, false, "standby was requested without confirmation");
  const downloads = here.page.waitForEvent("download", { timeout: 90_000 });
  await here.press("Start standby and export");
  await yes(here.page);
  const file = await (await downloads).path();
  await notes(here.section, "This box is on standby");
  const code = await here.section.locator("dd").first().innerText();
  assert.match(code, /^(\d{4} ){3}\d{4}$/);
  await axeFindsNothing(here.page, "a box on standby");
  assert.equal((await first.run()).alarms[0].id, "standby");
  await first.killAditd();

  const there = await spareOf(t, spare);
  await there.press("Import the export");
  await there.section.locator(".outcome", { hasText: "Choose the export first" }).waitFor();
  await there.section.locator("input[type=file]").setInputFiles(file);
  await there.press("Import the export");
  await there.section.locator("input[name=code]").fill("1111 2222 3333 4444");
  await there.press("Open");
  await there.section.locator(".outcome", { hasText: "the code is not that of this export" }).waitFor();
  await there.section.locator("input[name=code]").fill(code);
  await there.press("Open");
  await there.section.locator("dd", { hasText: "1, 0 of them not finished" }).waitFor();
  await axeFindsNothing(there.page, "an export that is opened");
  await there.press("Take over");
  await no(there.page);
  assert.equal((await spare.ask("/adit/reports")).said.length, 0, "the spare box changed too early");
  await there.press("Take over");
  await yes(there.page);

  await there.section.getByRole("link", { name: `:${first.port}/` }).click();
  await notes(there.section, "A spare box can take over");
  spare.port = first.port;  // the spare has the first box's settings now
  const reports = await until(() => spare.ask("/adit/reports").then(({ said }) => said?.length && said, () => null), "the spare, where the first was");
  assert.deepEqual(reports.map(({ number, type, state }) => [number, type, state]), [[number, "Drill", "answered"]]);
});

test("standby ends if the spare did not take over", async (t) => {
  const made = await box(t);
  await made.ask("/adit/spare/standby", {});
  const { page, section, press } = await spareOf(t, made);
  await notes(section, "This box is on standby");
  await press("End standby");
  await yes(page);
  await notes(section, "A spare box can take over");
  await until(async () => (await made.run()).run_clock, "the run");
});
