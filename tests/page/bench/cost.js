// Prints a table of the pages' sizes, their first paint over a slow link, and the cost of an open page for the box. It asserts nothing:
// tests/bench/README.md has figures and how to run it.
import { launch, visit } from "../stage.js";
import { begin, TOKENS } from "../box/box.js";
import { eventsWith, median } from "./events.js";

const PAINTS = 9, PAGES = { "": "run", display: "display", runs: "runs", setup: "set-up", system: "system" }, TEAMS = [6, 20];
const LINK = { offline: false, latency: 20, downloadThroughput: 20e6 / 8, uploadThroughput: 20e6 / 8 };

const token = { Authorization: `Bearer ${TOKENS.team}` };
const print = (...cells) => console.log(`| ${cells.join(" | ")} |`);

/** A visit with an empty cache over the slow link: milliseconds until the first paint with content, and the page's own files. */
async function paint(browser, made, path) {
  const page = await visit(browser, "about:blank", { extraHTTPHeaders: token });
  const devtools = await page.context().newCDPSession(page);
  const files = new Map();
  devtools.on("Network.responseReceived", ({ requestId, response: { url } }) => !url.includes("/adit/") && files.set(requestId, 0));
  devtools.on("Network.loadingFinished", ({ requestId, encodedDataLength }) => files.has(requestId) && files.set(requestId, encodedDataLength));
  await devtools.send("Network.enable");
  await devtools.send("Network.emulateNetworkConditions", LINK);
  await page.goto(made.url + path, { waitUntil: "load" });
  await page.waitForFunction(() => performance.getEntriesByName("first-contentful-paint").length > 0);
  const first = await page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0].startTime);
  await page.context().close();
  return { first, answers: files.size, bytes: [...files.values()].reduce((sum, bytes) => sum + bytes, 0) };
}

print("page", "answers", "bytes", "first paint, ms", "most");
print("---", "---", "---", "---", "---");
const browser = await launch();
const made = await begin({ robots: 5 });
try {
  for (const [path, name] of Object.entries(PAGES)) {
    const visits = [];
    for (let i = 0; i < PAINTS; ++i) visits.push(await paint(browser, made, path));
    const first = visits.map((each) => each.first);
    print(name, visits[0].answers, visits[0].bytes.toLocaleString("en"), median(first).toFixed(0), Math.max(...first).toFixed(0));
  }
} finally {
  await browser.close();
  await made.end();
}
console.log();
print("robots, 1,000 reports", "first event, bytes", "then kB/s", "events/s", "% of a core for a page");
print("---", "---", "---", "---", "---");
for (const robots of TEAMS) {
  const { first, rate, events, share } = await eventsWith(robots);
  print(robots, first.toLocaleString("en"), rate.toFixed(1), events.toFixed(1), share.toFixed(2));
}
