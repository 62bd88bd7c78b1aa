// Page, display and `adit status` show one run in the same words at the same time.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { until } from "../box.js";
import { BIN } from "../stage.js";
import { TOKENS } from "./box.js";
import { box, look } from "./visits.js";

const seconds = (clock) => clock.split(":").reduce((sum, part) => 60 * sum + Number(part), 0);

/** The output of `adit status`; its exit status does not matter here. */
function status(made) {
  const file = join(made.folder, "team.token");
  writeFileSync(file, TOKENS.team, { mode: 0o600 });
  const words = ["status", "--at", `127.0.0.1:${made.port}`, "--token-file", file];
  return new Promise((done) => execFile(join(BIN, "adit"), words, (error, out) => done(out)));
}

test("counts down from the run length in the settings", async (t) => {
  const made = await box(t, { settings: { runs: { length_seconds: 1800 } } });
  const pages = [await look(t, made), await look(t, made, "display")];
  for (const page of pages) {
    await page.waitForFunction(() => /^\d\d:\d\d$/.test(document.getElementById("togo").textContent));
    const [gone, left] = await page.evaluate(() => ["clock", "togo"].map((id) => document.getElementById(id).textContent));
    assert.ok(Math.abs(seconds(gone) + seconds(left) - 1800) <= 1, `${gone} and ${left}`);
  }
  const [, gone, left] = /Run +(\S+) +(\S+) to go/.exec(await until(async () => /to go/.test(await status(made)) && status(made), "the run"));
  assert.ok(Math.abs(seconds(gone) + seconds(left) - 1800) <= 1, `${gone} and ${left}`);
});

test("continues the run clock as an estimate, and says so, if the Command Post falls silent", async (t) => {
  const made = await box(t);
  await until(async () => (await made.run()).run_clock, "the run");
  await made.misbehave({ status: ["answer-after=60,for=600"] });
  const pages = [await look(t, made), await look(t, made, "display")];  // each page gets only one answer
  await until(async () => (await made.run()).run_clock.old, "an old answer", 60_000);
  for (const page of pages) {
    const shown = () => page.$eval("#clock", (node) => (node.parentNode.dataset.stale === "true" && node.textContent.startsWith("≈") ? node.textContent.slice(1) : ""));
    const first = await until(shown, "an estimate");
    await until(async () => seconds(await shown()) >= seconds(first) + 2, "an estimate that goes on");
    const { seconds: now } = (await made.run()).run_clock;
    assert.ok(Math.abs(seconds(await shown()) - now) <= 2, `${await shown()} and ${now}`);
  }
  assert.match(await status(made), /^Run +about \d+:\d\d +about \d+:\d\d to go .*\(heard \d+ s ago\)$/m);
});

test("says from the first answer on that one of three robots is silent, over a kill of the service and a new run", async (t) => {
  const made = await box(t, { robots: 2, settings: { alarms: { silent_for_ms: 5000, silent_times: 2 } } });
  for (let x = 0; x < 6; ++x) {
    const header = { stamp: Date.now() / 1000, frame_id: "darpa" }, pose = { position: { x, y: 2, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
    const grid = { header, info: { resolution: 0.2, width: 2, height: 2, origin: pose }, data: Buffer.from([0, 100, 0, 100]).toString("base64") };
    assert.equal((await made.ask("/map/update", { type: "OccupancyGrid", name: "r9", msg: grid })).status, 200);
    assert.equal((await made.ask("/state/update", { header, poses: [{ name: "r9", ...pose }] })).status, 200);
    await new Promise((done) => setTimeout(done, 1100));
  }
  const posted = Date.now() / 1000 - 1.1;
  const isSilent = ({ alarms }) => alarms.some(({ id }) => id === "robot_silent:r9");
  const rows = ({ activities }) => activities.filter(({ robot }) => robot === "r9");
  const light = ({ lights }) => lights.find(({ name }) => name === "attention").pattern;
  await until(async () => isSilent(await made.run()) && light(await made.run()) !== "off", "its silence");
  const check = async (when) => {
    const view = await made.run(); // the first answer
    assert.ok(isSilent(view), `${when}: ${view.alarms.map(({ id }) => id)}`);
    assert.deepEqual([...rows(view), view.standings.find(({ name }) => name === "r9")].map(({ level, word }) => `${level} ${word}`), Array(3).fill("bad silent"), when);
    for (const { heard } of rows(view)) assert.ok(Math.abs(view.now - posted - heard) < 2, `${when}: ${heard} of ${view.now - posted} s`);
    const isPlaced = ({ now, robots }) => robots.some(({ name, age }) => name === "r9" && Math.abs(now - posted - age) < 2);
    await until(async () => isPlaced(await made.run()), `${when}: its place, which is read from the disk`);
    assert.equal(view.verdict.level, "wait", `${when}: ${view.verdict.what}`);
    assert.notEqual(light(view), "off", when);
    assert.match(await status(made), /^ +r9 +grid +silent .*\n(.*\n)* +r9 +state +silent .* [\d.]+ s /m, when);
    const metrics = await (await fetch(`${made.url}metrics`, { headers: { Authorization: `Bearer ${TOKENS.team}` } })).text();
    for (const sample of [/^adit_alarm\{id="robot_silent:r9"/m, /^adit_updates_arrive\{kind="grid",robot="r9",arrival="silent"\} 1$/m]) assert.match(metrics, sample, when);
    for (const page of [await look(t, made), await look(t, made, "display")]) {
      await page.waitForSelector('#robots [data-key="r9"]');
      const row = await page.$eval('#robots [data-key="r9"]', (node) => `${node.dataset.level} ${node.querySelector(".glyph").dataset.level} ${node.title}\n${node.textContent}`);
      assert.match(row, /^bad bad r9: silent\n(.*\n)+r9 silent/, `${when}: ${row}`);
    }
  };
  await check("before");
  await made.killAditd();
  await made.startAditd();
  await check("after a kill");
  await made.ask("/adit/runs", "{}");
  await check("in a new run");
});

const CASES = [
  { is: "command_post_refusing", word: "rejected", fault: "401,for=600" },
  { is: "command_post_silent", word: "silent", fault: "answer-after=60,for=600" },
  { is: "command_post_unreachable", word: "unreachable" },
];
for (const { is, word, fault } of CASES) {
  test(`blames no robot for a Command Post that is ${word}, on any face`, async (t) => {
    const made = await box(t, { robots: 3 });
    const mapsTaken = ({ activities }) => activities.filter(({ kind, forwarded }) => kind === "grid" && forwarded > 0).length >= 3;
    await until(async () => mapsTaken(await made.run()), "a map of each robot to be taken");
    const pages = [await look(t, made), await look(t, made, "display")];
    for (const page of pages) await page.waitForSelector("#maps[data-away=false]");
    await (fault ? made.misbehave({ mapping: [fault] }) : made.endPost());
    await until(async () => (await made.run()).alarms.some(({ id, subject }) => id === is && (!subject || subject === "mapping")), is, 60_000);
    for (const page of pages) {
      await page.waitForSelector("#maps[data-away=true]");
      await page.waitForFunction((word) => document.querySelector('.strip .ends [data-key="mapping"] dd').textContent === word, word);
    }
    // If the Command Post is silent, it looks healthy for a moment after each try that timed out. So the check runs while the alarm is
    // on.
    const blamesNobody = ({ alarms, activities }) => alarms.some(({ id }) => id === is) && activities.some(({ arrival }) => arrival === "not arriving") && !activities.some(({ level }) => level === "bad" || level === "wait");
    await until(async () => blamesNobody(await made.run()), "what waits to be nobody's fault");
    for (const page of pages) await page.waitForFunction(() => document.querySelector("#maps[data-away=true]") && !document.querySelector("#robots li:is([data-level=bad], [data-level=wait])"));
    const same = new RegExp(`^Maps +No map arrives: for \\d+:\\d\\d; the box keeps all maps$[^]*^ +mapping +\\S+ +${word} `, "m");
    await until(async () => same.test(await status(made)), "the same of `adit status`");
    if (!fault) return;  // it was killed
    await made.behave();
    const blamed = [];
    await until(async () => {
      const { alarms, activities } = await made.run(), maps = activities.filter(({ kind }) => kind === "grid" || kind === "cloud");
      if (alarms.some(({ id }) => id === is)) return false;
      blamed.push(...maps.filter(({ level }) => level === "bad").map(({ kind, robot, arrival }) => `${robot} ${kind}: ${arrival}`), ...alarms.filter(({ id }) => /^maps?_behind/.test(id)).map(({ what }) => what));
      return maps.every(({ last_status: status }) => status === 200);
    }, "all to be taken again", 120_000);
    assert.deepEqual(blamed, [], "no robot may be blamed while the Command Post recovers");
  });
}
