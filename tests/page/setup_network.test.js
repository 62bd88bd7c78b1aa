import assert from "node:assert/strict";
import { afterEach, test } from "node:test";
import { PASSWORD, until } from "./fresh_box.js";
import { NetworkedBox } from "./networked_box.js";
import { hears, review } from "./setup_page.js";
import { leave } from "./stage.js";

const OLD = "http://192.168.7.11:8000/", NEW = "http://192.168.8.11:8000/";
const SOON = 28_000, LATE = 300_000;  // ms until the box reverts a change: SOON for tests that wait for it

let box;
afterEach(() => box?.close());

const team = (page, label) => page.locator("[data-side=team]").getByLabel(label);
const post = (page, label) => page.locator("[data-side=command_post]").getByLabel(label);
const sign = (page) => page.locator("header").getByRole("link", { name: /Network change/ });

/** A box for one test, and the first step of its set-up page. */
async function begin(t, takesBackWithin) {
  box = await new NetworkedBox().begin(takesBackWithin);
  return come(t, OLD);
}

/** The set-up page's first step at `url`, logged in; also works at the first start. */
async function come(t, url) {
  const page = await box.visit(`${url}setup#network`);
  t.after(() => leave(page));
  await page.waitForSelector("form:not([hidden])");
  if (await page.locator("#first").isVisible()) {
    await page.getByLabel("Code").fill(box.code());
    await page.getByLabel("New password").fill(PASSWORD);
    await page.getByLabel("Repeat the password").fill(PASSWORD);
  } else {
    await page.locator("#login").getByLabel("Password").fill(PASSWORD);
  }
  await page.keyboard.press("Enter");
  await page.waitForURL(/setup/);
  await hears(page, "Live");
  return page;
}

/** Changes the team's address, unconfirmed. */
async function change(page, address) {
  await team(page, "Address").fill(`${address}/24`);
  await page.getByRole("button", { name: "Change the addresses" }).click();
  await review(page);
  await page.getByRole("button", { name: "Change for now" }).click();
  await until(() => box.address() === `${address}/24`, `team0 to have ${address}`);
}

test("checks addresses as they are typed, and says what a change would do", async (t) => {
  const page = await begin(t, LATE);
  assert.equal(await team(page, "Mode").inputValue(), "static");
  assert.equal(await team(page, "Address").inputValue(), "192.168.7.11/24");
  assert.equal(await post(page, "Addresses").inputValue(), "10.100.1.10/24");
  const wrong = [
    [team(page, "Address"), ["300.1.1.1/24", "", "here", "192.168.7.255/24", "127.0.0.1/8", "192.168.7.11", "192.168.7.11/33",
      "192.168.7.11/0", "192.168.7.11/wide", "169.254.1.1/16"]],
    [post(page, "Addresses"), ["10.100.1/24", "0.0.0.0/8", "10.100.1.10/7", "10.100.1.10/31", "10.100.1.10/-1", "10.100.1.10/24,",
      "10.100.1.10/24, 10.100.1.10/24"]],
    [post(page, "Gateway"), ["10.100.2.1", "there", "10.100.1.10"]],
  ];
  for (const [input, texts] of wrong) {
    const was = await input.inputValue();
    for (const text of texts) {
      await input.fill(text);
      await input.blur();
      await page.locator("#addresses [aria-invalid=true]").first().waitFor().catch(() => assert.fail(`${text} is taken`));
      assert.equal(await input.inputValue(), text);
      await page.getByRole("button", { name: "Change the addresses" }).click();
      assert.ok(await page.locator("#review").isHidden());
    }
    await input.fill(was);
    await page.waitForFunction(() => !document.querySelector("#addresses [aria-invalid=true]"));
  }
  await team(page, "Address").fill("10.100.1.77/24");
  await page.locator("#addresses .wrong", { hasText: "10.100.1.0/24 overlaps 10.100.0.0/16" }).waitFor();
  const said = await page.locator("#addresses .wrong").filter({ hasText: "overlaps" }).innerText();
  assert.equal(said, "Address: 10.100.1.0/24 overlaps 10.100.0.0/16 on the Command Post's side: choose another subnet, or allow it by “Allow the team’s subnet to overlap the Command Post’s”");
  await page.getByLabel("Allow the team’s subnet to overlap").check();
  await page.getByRole("button", { name: "Apply changes" }).click();
  await review(page);
  await page.getByRole("button", { name: "Apply", exact: true }).click();
  await hears(page, /Applied\./);
  await team(page, "Address").fill("10.100.1.78/24");
  await page.locator("#addresses .warnings", { hasText: "allowed, but a robot cannot reach both" }).waitFor();
  await page.locator("#addresses .warnings", { hasText: "this cuts you off" }).waitFor();
  await team(page, "Mode").selectOption("dhcp");
  assert.ok(await team(page, "Address").isHidden());
  await page.locator("#addresses .warnings", { hasText: /open http:\/\/[\w-]+\.local:8000/ }).waitFor();
  await team(page, "Mode").selectOption("static");
  await team(page, "Address").fill("192.168.7.11/24");
  await post(page, "Addresses").fill("10.100.1.10/24, 10.100.2.10/16");
  await page.getByRole("button", { name: "Change the addresses" }).click();
  assert.deepEqual(await review(page), [["Command Post’s side: addresses", "10.100.1.10/24", "10.100.1.10/24, 10.100.2.10/16"]]);
  await page.locator("#review").getByRole("button", { name: "Cancel" }).click();
  await post(page, "Addresses").fill("10.100.1.10/24");
  await page.getByRole("button", { name: "Change the addresses" }).click();
  await page.getByText("The box already has these addresses.").waitFor();
});

test("reverts an unconfirmed change, and says so", async (t) => {
  const page = await begin(t, SOON);
  await team(page, "Address").fill("192.168.8.11/24");
  await page.getByRole("button", { name: "Change the addresses" }).click();
  assert.deepEqual(await review(page), [["Team’s side: address", "192.168.7.11", "192.168.8.11"]]);
  await page.locator("#review .warnings", { hasText: "this cuts you off: your address 192.168.7.2 is not in 192.168.8.0/24" }).waitFor();
  await page.locator("#review").getByRole("button", { name: "Cancel" }).click();
  assert.equal(box.address(), "192.168.7.11/24");
  await change(page, "192.168.8.11");
  await sign(page).filter({ hasText: /\d+ s left/ }).waitFor();
  await page.locator("#pending a", { hasText: `${NEW}setup#network` }).waitFor();
  await hears(page, "Box lost");
  await until(() => box.address() === "192.168.7.11/24", "the address before", 120_000);
  await hears(page, "Live");
  await page.getByText(/The last change was reverted: the change was not confirmed/).waitFor();
  await sign(page).waitFor({ state: "detached" });
});

test("keeps a change that is confirmed from the new address", async (t) => {
  const page = await begin(t, LATE);
  await change(page, "192.168.8.11");
  const there = await come(t, NEW);
  await there.goto(NEW);
  await sign(there).filter({ hasText: /\d+ s left/ }).waitFor();  // also on the run page
  await there.goto(`${NEW}system`);
  await sign(there).click();
  await there.getByText("You are at the new address. Confirm to keep it.").waitFor();
  await there.getByRole("button", { name: "Confirm" }).click();
  await there.getByText("The last change was confirmed.").waitFor();
  await until(() => box.isAtRest(), "adit-network, which would take it back, to end");
  assert.equal(box.address(), "192.168.8.11/24");
  await sign(there).waitFor({ state: "detached" });

  await change(there, "192.168.7.11");
  const back = await come(t, OLD);
  await back.getByRole("button", { name: "Revert" }).click();
  await until(() => box.address() === "192.168.8.11/24", "the address before");
  await hears(there, "Live");
  await there.getByText(/The last change was reverted/).waitFor();
});

test("shows both ports' state in the kernel as a cable is unplugged and plugged in", async (t) => {
  const page = await begin(t, LATE);
  const port = (side) => page.locator(".ports li", { hasText: side });
  await port("Command Post’s side: darpa0").getByText("cable in").waitFor();
  const team = (await port("Team’s side: team0").innerText()).replace(/\s+/g, " ");
  assert.match(team, /cable in, 10 Gbit\/s, full duplex Addresses 192\.168\.7\.11\/24.* Name \S+\.local MAC ([0-9a-f]{2}:){5}[0-9a-f]{2}/);
  assert.match((await port("darpa0").innerText()).replace(/\s+/g, " "), /10\.100\.1\.10\/24.* none: the box does not listen on this side/);
  await page.goto(`${OLD}system#network`);
  await port("darpa0").getByText("cable in").waitFor();
  box.plug("wan0", false);
  await port("darpa0").getByText("no cable").waitFor();
  box.plug("wan0", true);
  await port("darpa0").getByText("cable in").waitFor();
});
