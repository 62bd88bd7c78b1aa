// Makes the READMEs' pictures of a rehearsal with six robots: ADIT_BIN=... node readme_pictures.js FOLDER
import { join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { until } from "./box.js";
import { begin, PASSWORD } from "./box/box.js";
import { launch, visit } from "./stage.js";

const PICTURES = [
  { name: "page", path: "" },
  { name: "display", path: "display" },
  { name: "setup", path: "setup#test", act: (page) => page.getByRole("button", { name: /^Run the test/ }).first().click() },
  { name: "system", path: "system", width: 1600, height: 1000 },
];

const folder = process.argv[2];
const made = await begin({ robots: 6, settings: { reports: { review: "duplicates" } }, post: ["--team", "Cerberus"] });
const browser = await launch();
try {
  const first = await until(async () => (await made.run()).robots[0], "a robot");
  await sleep(20_000);
  const { x, y } = first.position;
  for (const [type, left, up] of [["Survivor", 4, 2], ["Drill", -3, 6], ["Backpack", 12, 8], ["Gas", 8, -4], ["Gas", 10, -4]]) await made.compose(type, x + left, y + up);
  await sleep(50_000);  // so that there is enough to see
  const page = await visit(browser, `${made.url}login.html`, { colorScheme: "dark" });
  await page.fill("#login input[name=password]", PASSWORD);
  await page.click("#login button");
  await page.waitForURL((url) => !url.pathname.includes("login"));
  for (const { name, path, act, width = 1280, height = 720 } of PICTURES) {
    await page.setViewportSize({ width, height });
    await page.goto(made.url + path);
    await sleep(15_000);  // plots and age lines are as long as the page was open
    await act?.(page);
    if (act) await sleep(9000);
    await page.screenshot({ path: join(folder, `${name}.png`) });
  }
} finally {
  await browser.close();
  await made.end();
}
