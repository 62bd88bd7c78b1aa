// Messages that the Command Post rejected: the operator sends them again or discards them. If a message is rejected again, it stays.
// Touch: presses.test.js.
import assert from "node:assert/strict";
import { test } from "node:test";
import { until } from "../box.js";
import { pickyPost } from "./picky_post.js";
import { box, canBeDeaf, look, openMore } from "./visits.js";

/** Presses by keyboard, because each press then moves the focus. */
async function press(button) {
  await button.page().waitForSelector("[data-given]", { state: "detached" });  // a second press might be one too many
  await button.press("Enter");
}
const REFUSED = { robot_1: 422, robot_2: 400, robot_3: 413, robot_4: 422 };

const pose = { position: { x: 0, y: 0, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
const gridOf = (name, cells) => ({ type: "OccupancyGrid", name, msg: { header: { stamp: Date.now() / 1000, frame_id: "darpa" },
  info: { resolution: 1, width: 2, height: 2, origin: pose }, data: Buffer.from(cells).toString("base64") } });

async function send(made, name, cells = [0, 100, 0, 100]) {
  const { status, said } = await made.ask("/map/update", gridOf(name, cells));
  assert.equal(status, 200, said);
}
const rejectedOf = async (made) => (await made.run()).rejected;

const QUICK = { map_hz: 20 };

/** A page with one row for each rejected robot. */
async function withRefused(t, options) {
  const post = await pickyPost(t);
  const made = await box(t, { settings: { command_post: { rates: QUICK, mapping: { address: "127.0.0.1", port: post.port } } }, post: ["--rate", "0"] });
  post.behind = made.mapping;
  for (const [name, status] of Object.entries(REFUSED)) post.refuses.set(name, status);
  for (const name of Object.keys(REFUSED)) {
    await send(made, name);
    await until(async () => (await rejectedOf(made)).some(({ robot }) => robot === name), `${name} to be rejected`);
  }
  const page = await look(t, made, "", options);
  await openMore(page);
  await page.locator("#rejected li").nth(3).waitFor();
  return { page, made, post };
}

const row = (page, name) => page.locator("#rejected li", { hasText: name });
const button = (page, name, word) => row(page, name).getByRole("button", { name: word });
const focusIs = (page, selector) => page.waitForFunction((selector) => document.activeElement.matches(selector), selector);
const counted = (page, count) => page.locator("#rejected .count", { hasText: new RegExp(`^${count}$`) }).waitFor();
const numberOf = (page, name) => row(page, name).getAttribute("data-key");

test("a rejected message is sent again or discarded, and the focus moves to the next one", async (t) => {
  const { page, made, post } = await withRefused(t);
  for (const [name, status] of Object.entries(REFUSED)) assert.match(await row(page, name).innerText(), new RegExp(`${status}: .*not to my taste`));
  await counted(page, 4);
  const [first, second] = await Promise.all(Object.keys(REFUSED).map((name) => numberOf(page, name)));

  post.refuses.clear();
  await press(button(page, "robot_3", "Send again"));
  await until(() => post.taken.includes("robot_3"), "it to arrive at the Command Post");
  await row(page, "robot_3").waitFor({ state: "detached" });
  await counted(page, 3);
  await focusIs(page, `#rejected li[data-key="${second}"] .send`);  // the newest is the first
  await page.locator("#rejected .said", { hasText: "is queued again" }).waitFor();

  await press(button(page, "robot_2", "Discard"));
  await row(page, "robot_2").waitFor({ state: "detached" });
  await counted(page, 2);
  await focusIs(page, `#rejected li[data-key="${first}"] .discard`);

  await press(button(page, "robot_1", "Discard"));
  await row(page, "robot_1").waitFor({ state: "detached" });
  await focusIs(page, "#rejected li:only-child .discard");
  await press(button(page, "robot_4", "Discard"));
  await row(page, "robot_4").waitFor({ state: "detached" });
  await focusIs(page, "#post-title");
  assert.deepEqual(await rejectedOf(made), []);
  assert.deepEqual(post.taken, ["robot_3"]);
  assert.deepEqual(page.complaints, []);
});

test("a message that a newer one contains stays if it is sent again, with the box's sentence", async (t) => {
  const { page, made, post } = await withRefused(t, { prepare: canBeDeaf });
  await page.evaluate(() => (globalThis.deaf = true));
  post.refuses.clear();
  await send(made, "robot_2", [100, 0, 100, 0]);
  await until(async () => (await rejectedOf(made)).some(({ robot, replaced }) => robot === "robot_2" && replaced), "it to be replaced");
  const number = await numberOf(page, "robot_2");
  const refused = page.waitForResponse((answer) => answer.url().endsWith(`/adit/rejected/${number}/send`));
  await press(button(page, "robot_2", "Send again"));
  await page.locator("#rejected .said", { hasText: await (await refused).json() }).waitFor();
  await focusIs(page, `#rejected li[data-key="${number}"] .send`);
  await page.evaluate(() => (globalThis.deaf = false));
  await row(page, "robot_2").getByText("A newer message that contains it was sent.").waitFor();
  await counted(page, 3);
  await focusIs(page, `#rejected li[data-key="${number}"] .discard`);
  assert.ok(await button(page, "robot_2", "Send again").isDisabled());
  await press(button(page, "robot_2", "Discard"));
  await row(page, "robot_2").waitFor({ state: "detached" });
  assert.deepEqual(post.taken, ["robot_2"]);
});

test("a message that alone gets a 500 is listed, and arrives once it is sent again", async (t) => {
  const made = await box(t, { settings: { command_post: { rates: QUICK } }, post: ["--rate", "0"] });
  await made.misbehave({ mapping: ["500,robot=robot_2,for=300"] });
  await send(made, "robot_2");
  const page = await look(t, made);
  let turn = 0;
  await until(async () => {
    await send(made, "robot_1", [turn++ % 100, 0, 0, 0]);  // other messages succeed meanwhile
    return (await rejectedOf(made)).length;
  }, "it to be rejected");
  await openMore(page);
  await row(page, "robot_2").getByText(/^500: /).waitFor();
  await counted(page, 1);
  await made.behave();
  await button(page, "robot_2", "Send again").press("Enter");
  await row(page, "robot_2").waitFor({ state: "detached" });
  await focusIs(page, "#post-title");
  await until(async () => (await made.run()).activities.some(({ kind, robot, forwarded }) => kind === "grid" && robot === "robot_2" && forwarded === 1), "it to arrive");
});
