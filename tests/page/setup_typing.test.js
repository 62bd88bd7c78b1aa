// Typing on the set-up page: checks while typing, and no loss of input.
import assert from "node:assert/strict";
import { test } from "node:test";
import { merged } from "../../firmware/doors/site/files/draft.js";
import { inShort, spoken } from "../../firmware/doors/site/files/names.js";
import { come, PASSWORD, until } from "./fresh_box.js";
import { complaints, COURSES, field, hears, openCards, ready, review, step, type } from "./setup_page.js";

const focusIsAt = (page, path) =>
  page.waitForFunction((path) => document.activeElement.closest("[data-path]")?.dataset.path === path, path);

test("checks robot names while they are typed, and shows errors after the field is left", async (t) => {
  const { ask, page } = await ready(t, "setup#robots");
  const add = page.getByRole("button", { name: "Add a robot" });
  for (const name of ["", "two words", "elevenchars", "ugv-1", "böse"]) {
    const checked = page.waitForResponse("**/adit/settings/check");
    await add.click();
    await page.keyboard.type(name);
    await (await checked).finished();
    await hears(page, "Your changes are not yet applied.");
    assert.equal(await page.locator("[data-path='robots[0].name'] .wrong").textContent(), "", "an error is shown while typing");
    await page.keyboard.press("Tab");
    await page.locator("[data-path='robots[0].name'] .wrong").filter({ hasText: "1 to 10 letters, digits and underscores" }).waitFor().catch((error) => {
      throw new Error(`${name}: ${error.message}`);
    });
    await page.getByRole("button", { name: "Remove: Robot 1" }).click();
  }
  for (const name of ["ugv1", "ugv1"]) {
    await add.click();
    await page.keyboard.type(name);
  }
  await page.keyboard.press("Tab");
  await page.locator("[data-path='robots[1].name'] .wrong", { hasText: "the same as “Robot 1: name”" }).waitFor();
  await page.getByRole("button", { name: "Apply changes" }).click();
  await focusIsAt(page, "robots[1].name");  // the error
  await type(page, "robots[1].name", "uav1");
  await type(page, "robots[1].alias", "ugv1");
  await page.locator("[data-path='robots[1].alias'] .wrong", { hasText: "an alias is another name" }).waitFor();
  await type(page, "robots[1].alias", "drone one");
  await page.locator("[data-path='robots[1].alias'] .wrong", { hasText: "visible ASCII" }).waitFor();
  await type(page, "robots[1].alias", "drone-1");
  await hears(page, /changes? not yet applied/);
  await page.getByRole("button", { name: "Apply changes" }).click();
  await review(page);
  await page.getByRole("button", { name: "Apply", exact: true }).click();
  await hears(page, /Applied\./);
  assert.deepEqual((await ask("/adit/settings")).said.settings.robots, [{ name: "ugv1", alias: "", clouds: "auto", precision: "exact", colour: "auto" }, { name: "uav1", alias: "drone-1", clouds: "auto", precision: "exact", colour: "auto" }]);
  await step(page, "Robots").getByText("2 named").waitFor();
  assert.deepEqual(complaints(page), []);
});

test("keeps every added row, named or not, if another operator saved meanwhile", () => {
  const row = (name) => ({ name, alias: "" });
  const both = merged([row("ugv1")], [row("ugv1"), row(""), row("")], [row("ugv1"), row("uav1")]);
  assert.deepEqual(both.map(({ name }) => name), ["ugv1", "uav1", "", ""]);
});

test("shows an added or removed list item in one row, with its non-default values", () => {
  const usual = (path) => ({ alias: "", precision: "exact" })[path.split(".").at(-1)];
  const robot = (name, from, to) => [[`robots[${name}].name`, from && name, to && name], [`robots[${name}].alias`, from, to], [`robots[${name}].precision`, from && "exact", to && "1mm"]];
  assert.deepEqual(inShort([["runs.length_seconds", 60, 90], ...robot("uav1", null, "x"), ["robots[ugv1].alias", "", "y"], ...robot("ugv2", "z", null)], usual), [
    ["runs.length_seconds", 60, 90],
    ["robots[uav1]", null, "in the list, alias x, precision 1mm"],
    ["robots[ugv1].alias", "", "y"],
    ["robots[ugv2]", "in the list, alias z", null],
  ]);
});

test("uses a setting's name in every sentence", () => {
  assert.equal(spoken("Needs command_post.arrange_clouds, under robots[].name or robots[2].name."), "Needs “Command Post: arrange clouds”, under “Robot: name” or “Robot 3: name”.");
});

/** Wrong values for each kind of setting. */
const WRONG = { whole: ["-1", "1.5", "many", "99999999999999999999", ""], real: ["0x", "-3", "many", ""], text: ["ß ß", "\u0007"] };

test("shows an error at every field, and keeps the input", async (t) => {
  const { page } = await ready(t, "setup", { robots: [{ name: "ugv1" }], courses: COURSES });
  const { keys } = await page.evaluate(async () => (await fetch("/adit/settings")).json());
  const kinds = new Map(keys.map(({ path, kind }) => [path, kind]));
  let checked = 0;
  for (const at of ["network", "post", "robots", "courses", "all"]) {
    await page.evaluate((at) => (location.hash = at), at);
    const here = page.locator(`#step-${at}`);
    await here.waitFor();
    await openCards(page);
    for (const button of await here.locator(".opens").all()) await button.click();
    const paths = await here.locator(".field[data-path]:not(form .field)").evaluateAll((all) => all.map((each) => each.dataset.path));
    const ofKind = (path) => WRONG[kinds.get(path.replace(/\[\d\]/g, "[]"))] ?? [];  // a choice and a flag cannot be wrong
    for (let i = 0; i < WRONG.whole.length; ++i) {
      const wrong = new Map(paths.flatMap((path) => (ofKind(path)[i] === undefined ? [] : [[path, ofKind(path)[i]]])));
      for (const [path, text] of wrong) await type(page, path, text);
      for (const [path, text] of wrong) {
        await field(page, path).locator("[aria-invalid=true]").waitFor().catch(() => assert.fail(`${path} takes ${JSON.stringify(text)}`));
        const control = field(page, path).locator("input");
        const said = await control.evaluate((node) => document.getElementById(node.getAttribute("aria-describedby").split(" ")[0]).textContent);
        assert.notEqual(said, "", path);
        assert.equal(await control.inputValue(), text, path);
        ++checked;
      }
    }
    await page.getByRole("button", { name: "Drop" }).click();
    await page.waitForFunction(() => !document.querySelector("[aria-invalid=true]"));
  }
  assert.ok(checked > 100, `${checked} wrong inputs`);
  assert.deepEqual(complaints(page), []);
});

test("lists the errors of other steps, with a link to each", async (t) => {
  const { page } = await ready(t, "setup#post");
  await type(page, "command_post.scoring.port", "0");
  await hears(page, "1 error to correct");
  await step(page, "Command Post").getByText("1 error").waitFor();
  await step(page, "Robots").click();
  await page.locator("#typed").getByRole("button", { name: /^Scoring port: expected/ }).click();
  await page.getByRole("heading", { name: "Command Post" }).waitFor();
  await focusIsAt(page, "command_post.scoring.port");
  await page.getByRole("button", { name: "Next" }).click();
  await focusIsAt(page, "command_post.scoring.port");
  assert.ok(await page.getByRole("heading", { name: "Command Post" }).isVisible(), "an error is mended before one goes on");
  await page.getByRole("button", { name: "Drop" }).click();
  assert.equal(await field(page, "command_post.scoring.port").locator("input").inputValue(), "1");
  assert.ok(await page.locator("#typed").isHidden());
});

test("shows two operators each other's changes, and lets one continue from the newer settings", async (t) => {
  const { box, ask, page } = await ready(t, "setup#post", { robots: [{ name: "ugv1" }, { name: "ugv2" }] });
  const other = await come(t, box, "setup#post", PASSWORD);
  await type(page, "command_post.scoring.port", "8001");
  await type(other, "command_post.scoring.port", "8002");
  await type(other, "command_post.mapping.port", "8003");
  for (const [each, port] of [[other, "8002"]]) {
    await each.getByRole("button", { name: "Apply changes" }).click();
    assert.match(JSON.stringify(await review(each)), new RegExp(port));
    await each.getByRole("button", { name: "Apply", exact: true }).click();
    await hears(each, /Applied\./);
  }
  await page.getByRole("button", { name: "Apply changes" }).click();
  await page.getByRole("heading", { name: "Another operator has saved settings" }).waitFor();
  assert.deepEqual(await review(page), [["Scoring port", "1", "8002", "8001"], ["Mapping port", "2", "8003", "2"]]);
  await page.getByRole("button", { name: "Keep mine on top of theirs" }).click();
  await page.getByRole("heading", { name: "Apply these changes?" }).waitFor();
  assert.deepEqual(await review(page), [["Scoring port", "8002", "8001"]]);
  await page.getByRole("button", { name: "Apply", exact: true }).click();
  await hears(page, /Applied\./);
  const { command_post: post } = (await ask("/adit/settings")).said.settings;
  assert.deepEqual([post.scoring.port, post.mapping.port], [8001, 8003]);

  // The dialog has both changes when the first one is applied. The box rejects the second.
  await type(other, "command_post.mapping.port", "8004");
  await hears(other, /change/);
  await page.evaluate(() => (location.hash = "robots"));
  await page.getByRole("button", { name: "Remove: Robot 2" }).click();
  await page.getByRole("button", { name: "Apply changes" }).click();
  await review(page);
  const saved = await ask("/adit/settings/check", { settings: {} });
  assert.equal(saved.status, 200);
  const { settings, tag } = (await ask("/adit/settings")).said;
  settings.robots.push({ name: "uav1", alias: "" });
  assert.equal((await ask("/adit/settings", { settings, base: tag })).status, 200);
  await until(async () => (await ask("/adit/settings").catch(() => ({}))).said?.tag !== tag, "the box to run with it");
  await page.getByRole("button", { name: "Apply", exact: true }).click();
  await page.getByRole("heading", { name: "Another operator has saved settings" }).waitFor();
  await page.getByRole("button", { name: "Keep mine on top of theirs" }).click();
  await page.getByRole("button", { name: "Apply changes" }).click();
  assert.deepEqual((await review(page)).map(([path]) => path.replace(/:.*/, "")), ["Robot ugv2"]);
  await page.getByRole("button", { name: "Apply", exact: true }).click();
  await hears(page, /Applied\./);
  assert.deepEqual((await ask("/adit/settings")).said.settings.robots.map(({ name }) => name), ["ugv1", "uav1"]);

  await other.getByRole("button", { name: "Apply changes" }).click();
  await other.getByRole("button", { name: "Drop mine" }).click();
  await other.waitForFunction(() => document.querySelector("#typed").hidden);
  assert.equal(await field(other, "command_post.mapping.port").locator("input").inputValue(), "8003");
});

test("keeps input while the box applies a change, and drops input that is based on another operator's older settings", async (t) => {
  const { ask, page } = await ready(t, "setup#robots", { robots: [{ name: "ugv1" }] });
  const apply = async () => {
    await page.getByRole("button", { name: "Apply changes" }).click();
    await review(page);
    await page.getByRole("button", { name: "Apply", exact: true }).click();
  };
  const robots = async () => (await ask("/adit/settings")).said.settings.robots.map(({ name, alias }) => `${name} ${alias}`);
  let answer;
  const typed = new Promise((resolve) => (answer = resolve));
  await type(page, "robots[0].name", "ugv2");
  await page.route("**/adit/settings", async (route) => {
    if (route.request().method() === "GET") await typed;
    return route.continue();
  });
  await apply();
  await hears(page, "The box applies the changes.");
  await field(page, "robots[0].alias").locator("input").focus();
  await page.keyboard.type("on");
  answer();
  await hears(page, /Applied\. 1 change not yet applied/);
  await page.keyboard.type("e");
  await apply();
  await hears(page, /Applied\./);
  assert.deepEqual(await robots(), ["ugv2 one"]);
  await page.unrouteAll();

  await type(page, "robots[0].alias", "two");
  const { settings, tag } = (await ask("/adit/settings")).said;
  settings.command_post.scoring.port = 8001;
  assert.equal((await ask("/adit/settings", { settings, base: tag })).status, 200);
  await page.getByRole("button", { name: "Apply changes" }).click();
  await page.getByRole("button", { name: "Keep mine on top of theirs" }).click();
  await page.getByRole("button", { name: "Cancel" }).click();
  await page.evaluate(() => (location.hash = "post"));
  await type(page, "command_post.mapping.port", "8002");
  await page.getByRole("button", { name: "Drop" }).click();
  assert.equal(await field(page, "command_post.mapping.port").locator("input").inputValue(), "2");
});

test("recognises its own save, even if the answer was lost, and after a reload", async (t) => {
  const { ask, page } = await ready(t, "setup#post");
  let answersLost = 1;
  await page.route("**/adit/settings", async (route) => {
    if (route.request().method() !== "POST" || answersLost-- <= 0) return route.continue();
    await route.fetch();
    return route.abort("connectionreset");
  });
  const apply = async (port) => {
    await type(page, "command_post.scoring.port", port);
    await page.getByRole("button", { name: "Apply changes" }).click();
    await page.getByRole("button", { name: "Apply", exact: true }).click();
    await until(async () => (await ask("/adit/settings").catch(() => ({}))).said?.settings.command_post.scoring.port === Number(port), "the box to save");
  };
  const isOwn = async () => {
    await hears(page, "Saved. The box's answer was lost.");
    assert.ok(await page.locator("#review").isHidden());
    assert.ok(await page.getByRole("button", { name: "Apply changes" }).isHidden());
  };
  await apply("8001");
  await isOwn();
  answersLost = 100;
  await apply("8002");
  await page.reload();
  await page.unrouteAll({ behavior: "ignoreErrors" });
  await isOwn();
});

test("keeps all input if the box is lost while typing", async (t) => {
  const { box, ask, page } = await ready(t, "setup#robots");
  await page.getByRole("button", { name: "Add a robot" }).click();
  await page.keyboard.type("ug");
  await box.end("aditd", "SIGKILL");
  await page.keyboard.type("v1");
  await hears(page, "Box lost");
  await hears(page, "Your changes are kept");
  await page.getByRole("button", { name: "Apply changes" }).click();
  assert.equal(await field(page, "robots[0].name").locator("input").inputValue(), "ugv1");
  await box.startAditd();
  await hears(page, "Live");
  await hears(page, /[1-9] changes?/);
  await page.reload();
  await hears(page, /[1-9] changes?/);
  assert.equal(await field(page, "robots[0].name").locator("input").inputValue(), "ugv1", "the input is lost after a reload");
  await page.getByRole("button", { name: "Apply changes" }).click();
  await review(page);
  await box.end("aditd", "SIGKILL");
  const isPost = (request) => request.method() === "POST" && request.url().endsWith("/adit/settings");
  const unanswered = page.waitForEvent("requestfailed", isPost);
  await Promise.all([unanswered, page.getByRole("button", { name: "Apply", exact: true }).click()]);
  await box.startAditd();
  await hears(page, /Applied\./);
  assert.equal((await ask("/adit/settings")).said.settings.robots[0].name, "ugv1");
});

test("opens at the setting that a rejection names", async (t) => {
  const { page } = await ready(t, "setup?setting=rules.rewrite_frame_id#all");
  await focusIsAt(page, "rules.rewrite_frame_id");
  await page.keyboard.press("Space");
  await page.getByRole("button", { name: "Apply changes" }).click();
  assert.deepEqual(await review(page), [["Rules: rewrite frame id", "false", "true"]]);
});
