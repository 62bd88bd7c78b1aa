import assert from "node:assert/strict";
import { test } from "node:test";
import { come, freshBox, PASSWORD } from "./fresh_box.js";
import { complaints, hears, openCards, type } from "./setup_page.js";
import { axeFindsNothing, shoot } from "./watch.js";

const SIZES = [["phone", 390, 844], ["720p at 200 %", 640, 360], ["720p", 1280, 720], ["1080p", 1920, 1080], ["4k", 3840, 2160]];
const STEPS = ["network", "post", "tokens", "robots", "test", "courses", "all", "file"];
const A = { name: "A", scoring: { address: "10.100.1.200", port: 8000 }, mapping: { address: "10.100.1.201", port: 8000 } };
const SETTINGS = { robots: [{ name: "ugv1", alias: "husky-1" }], courses: [A] };

async function turnTo(page, name) {
  await page.evaluate((name) => (location.hash = name), name);
  await page.locator(`#step-${name}`).waitFor();
}

test("fits every screen, in both themes, without axe faults", async (t) => {
  const box = await freshBox(t, { secrets: ["scoring"], settings: SETTINGS });
  await box.settle();
  const page = await come(t, box, "setup", PASSWORD, { bypassCSP: true });
  await hears(page, "Live");
  for (const name of STEPS) {
    await turnTo(page, name);
    await openCards(page);
    if (name === "robots") {
      await type(page, "robots[0].name", "two words");
      await hears(page, "1 error");
    }
    for (const [size, width, height] of SIZES) {
      await page.setViewportSize({ width, height });
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${name} is wider than the ${size}`);
      const small = await page.$$eval("main button, main summary, main a, nav a, select, main input, #typed button", (nodes) =>
        nodes.filter((node) => node.checkVisibility() && node.getBoundingClientRect().height < (node.type === "checkbox" ? 24 : 44)).map((node) => node.outerHTML));
      assert.deepEqual(small, [], `${name}, ${size}: too small for gloves`);
      const colorScheme = { phone: "dark", "1080p": "light" }[size];
      if (!colorScheme) continue;
      await page.emulateMedia({ colorScheme });
      await axeFindsNothing(page, `${name}, ${size}, ${colorScheme}`);
      await shoot(page, `setup-${name}-${size}-${colorScheme}`);
    }
  }
  await page.getByRole("button", { name: "Drop" }).click();
  await turnTo(page, "courses");
  await page.getByRole("button", { name: "Switch to Course A" }).click();
  for (const colorScheme of ["dark", "light"]) {
    await page.emulateMedia({ colorScheme });
    await page.setViewportSize({ width: 3840, height: 2160 });
    await axeFindsNothing(page, `the dialog, ${colorScheme}`);
    await page.setViewportSize({ width: 390, height: 844 });
    await shoot(page, `setup-switch-phone-${colorScheme}`);
  }
  assert.ok(await page.evaluate(() => document.querySelector("#review").scrollWidth <= innerWidth));
  assert.deepEqual(complaints(page), []);
});

test("can be used by keyboard alone", async (t) => {
  const box = await freshBox(t, { secrets: ["scoring", "mapping"], settings: SETTINGS });
  await box.settle();
  const page = await come(t, box, "setup#robots", PASSWORD);
  await hears(page, "Live");
  const reach = async (look) => {
    for (let i = 0; i < 60; ++i) {
      await page.keyboard.press("Tab");
      if (await page.evaluate(look)) return;
    }
    assert.fail(`not reached: ${look}`);
  };
  await reach(() => document.activeElement.textContent === "Skip to the set-up");
  await reach(() => document.activeElement.closest("#steps") !== null);
  await reach(() => document.activeElement.textContent === "Add a robot");
  await page.keyboard.press("Enter");
  await page.keyboard.type("uav1");
  await reach(() => document.activeElement.textContent === "Next");
  await page.keyboard.press("Enter");
  await page.locator("#review[open]").waitFor();
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Cancel");
  await page.keyboard.press("Tab");
  await page.keyboard.press("Enter");
  await page.getByRole("heading", { name: "Test" }).waitFor();
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Test", "a new step is read out");
  await page.goBack();
  await page.getByRole("heading", { name: "Robots" }).waitFor();
});
