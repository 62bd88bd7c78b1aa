// A real aditd's self-description: metrics that the Grafana dashboard shows, and a support bundle without secrets.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { gunzipSync } from "node:zlib";
import { launch, visit } from "./stage.js";
import { OPERATOR, TOKENS, VIEWER, box, play, until } from "./box.js";

const dashboard = JSON.parse(readFileSync(new URL("../../services/grafana/adit.json", import.meta.url), "utf8"));
const expressions = dashboard.panels.flatMap(({ targets }) => (targets ?? []).map(({ expr }) => expr));

const scrape = async (ask) => (await ask("GET", "/metrics")).text();

test("every metric of the dashboard exists in a real scrape, with the dashboard's labels", async (t) => {
  const { ask } = await box(t);
  await play(ask);
  const metrics = await until(async () => {
    const text = await scrape(ask);
    return /^adit_run_score /m.test(text) && /^adit_updates_heard_seconds\{kind="grid"/m.test(text) && text;
  }, "a run that is known");
  assert.ok(expressions.length > 25);
  const names = new Set(expressions.flatMap((expression) => expression.match(/adit_\w+/g)));
  const missing = [...names].filter((name) => !new RegExp(`^${name}[{ ]`, "m").test(metrics));
  assert.deepEqual(missing, []);
  for (const { targets = [] } of dashboard.panels) {
    for (const { expr, legendFormat } of targets) {
      const [name] = /adit_\w+/.exec(expr);
      const [sample] = new RegExp(`^${name}.*`, "m").exec(metrics);
      for (const [, label] of legendFormat.matchAll(/\{\{(\w+)\}\}/g)) assert.match(sample, new RegExp(`[{,]${label}="`), expr);
    }
  }
});

test("the support bundle has all logs and settings, and no token, password, code or cookie", async (t) => {
  const { ask, code, logIn } = await box(t);
  await play(ask);
  const mine = await logIn(OPERATOR);
  await ask("POST", "/adit/login", { role: "nobody", body: { password: "an untrue password" } });
  await ask("POST", "/state/update", { role: "nobody", headers: { Authorization: "Bearer a-wrong-token" }, body: {} });
  await ask("POST", "/adit/reports", { body: { type: "Drill", x: 1, y: 2, z: 3 } });
  const answer = await ask("GET", "/adit/bundle");
  assert.equal(answer.status, 200);
  const bytes = Buffer.from(await answer.arrayBuffer());
  const folder = mkdtempSync(join(tmpdir(), "adit-bundle-"));
  t.after(() => rmSync(folder, { recursive: true, maxRetries: 20, retryDelay: 50 }));
  writeFileSync(join(folder, "bundle.tar.gz"), bytes);
  execFileSync("tar", ["-xzf", "bundle.tar.gz"], { cwd: folder });
  const [inside] = readdirSync(folder).filter((name) => name.startsWith("adit-support-"));
  const read = (name) => readFileSync(join(folder, inside, name), "utf8");
  assert.equal(JSON.parse(read("reports.json"))[0].type, "Drill");
  assert.equal(JSON.parse(read("settings.json")).version, 1);
  assert.ok(JSON.parse(read("run.json")).endpoints.length === 2);
  assert.ok(JSON.parse(read("network.json")).interfaces.some(({ addresses }) => addresses.includes("127.0.0.1/8")));
  assert.ok(JSON.parse(read("about.json")).parts.length >= 9);
  assert.match(read("log.txt"), /login rejected: wrong password/);
  assert.match(read("metrics.txt"), /^adit_build_info/m);
  const all = gunzipSync(bytes).toString("latin1") + (await (await ask("GET", "/adit/log.txt")).text()) + (await (await ask("GET", "/adit/log")).text());
  const secrets = [...Object.values(TOKENS), OPERATOR, VIEWER, "an untrue password", "a-wrong-token", code, mine["Adit-CSRF"], mine.Cookie.split("=")[1], "$y$"];
  for (const secret of secrets) {
    assert.ok(secret.length > 2);
    const at = all.indexOf(secret);
    assert.equal(at, -1, `${secret} in: ${all.slice(Math.max(0, at - 200), at + 200)}`);
  }
});

test("a reset from the page returns the box to its first start and keeps the reports", async (t) => {
  const { ask, url, restarted } = await box(t);
  await ask("POST", "/adit/reports", { body: { type: "Drill", x: 1, y: 2, z: 3 } });
  const browser = await launch();
  t.after(() => browser.close());
  const page = await visit(browser, `${url}/system`);
  await page.locator("#login").getByLabel("Password").fill(OPERATOR);
  await page.keyboard.press("Enter");
  const open = page.locator("#reset").getByRole("button", { name: "Reset the box" }), dialog = page.locator("#wipe");
  await page.locator("#reset summary").click();
  await open.click();
  await dialog.getByRole("button", { name: "Cancel" }).click();
  await open.click();
  await dialog.getByLabel("present password").fill("wrong horse");
  await page.keyboard.press("Enter");
  await dialog.getByRole("alert").filter({ hasText: "not the operator's present password" }).waitFor();
  assert.equal((await (await ask("GET", "/adit/session")).json()).first_start, false);
  await dialog.getByLabel("present password").fill(OPERATOR);
  await page.keyboard.press("Enter");
  await page.getByLabel("Code").waitFor();
  await restarted();
  assert.equal((await (await ask("GET", "/adit/session")).json()).first_start, true);
  assert.equal((await (await ask("GET", "/adit/reports")).json()).length, 1);
  const log = await (await ask("GET", "/adit/log.txt")).text();
  assert.equal(log.match(/asks for this code\n/g)?.length, 1, "the code is for the console alone");
});
