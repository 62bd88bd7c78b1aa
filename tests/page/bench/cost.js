// Measures how soon the page paints over a slow link, and what an open page costs the box. It asserts nothing:
// tests/bench/README.md has figures and how to run it.
import { once } from "node:events";
import { readFileSync } from "node:fs";
import { get } from "node:http";
import { launch, visit } from "../stage.js";
import { begin, TOKENS } from "../box/box.js";

const PAGES = 4, LISTENERS = 20, SECONDS = Number(process.env.BENCH_SECONDS ?? 20), ROUNDS = 3, PAINTS = 9;
const LINK = { offline: false, latency: 20, downloadThroughput: 20e6 / 8, uploadThroughput: 20e6 / 8 };
const TICKS = 100; // a second: USER_HZ

const sleep = (seconds) => new Promise((resolve) => setTimeout(resolve, seconds * 1000));
const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

/** CPU seconds of a process so far. */
function cpu(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
  return (Number(fields[11]) + Number(fields[12])) / TICKS;
}

async function share(pid) {
  const [before, began] = [cpu(pid), performance.now()];
  await sleep(SECONDS);
  return (100 * (cpu(pid) - before)) / ((performance.now() - began) / 1000);
}

const token = { Authorization: `Bearer ${TOKENS.team}` };
async function open(browser, made, path) {
  const page = await visit(browser, made.url + path, { extraHTTPHeaders: token });
  await page.waitForSelector("body[data-link=live]");
  return page;
}

/** Milliseconds to the first paint with something on it, with an empty cache, over the slow link. */
async function paint(browser, made, path) {
  const context = await browser.newContext({ extraHTTPHeaders: token, viewport: { width: 1280, height: 720 } });
  const page = await context.newPage();
  const devtools = await context.newCDPSession(page);
  await devtools.send("Network.enable");
  await devtools.send("Network.emulateNetworkConditions", LINK);
  await page.goto(made.url + path);
  await page.waitForSelector("body[data-link=live]");
  const [first, live] = await page.evaluate(() => [performance.getEntriesByName("first-contentful-paint")[0].startTime, performance.now()]);
  await context.close();
  return { first, live };
}

/** Somebody who only listens to the run's events; how many bytes came. */
async function listen(made) {
  const request = get(`${made.url}adit/events`, { headers: token });
  const [answer] = await once(request, "response");
  const heard = { bytes: 0, end: () => request.destroy() };
  answer.on("data", (piece) => (heard.bytes += piece.length)).on("error", () => {});
  return heard;
}

const made = await begin({ robots: 5 });
const browser = await launch();
try {
  await sleep(10);
  for (const path of ["", "display"]) {
    const paints = [];
    for (let i = 0; i < PAINTS; ++i) paints.push(await paint(browser, made, path));
    const [first, live] = ["first", "live"].map((what) => paints.map((each) => each[what]));
    console.log(`/${path}: first paint ${median(first).toFixed(0)} ms (most ${Math.max(...first).toFixed(0)}), with the run in it ${median(live).toFixed(0)} ms`);
  }
  for (const path of ["", "display"]) {
    const each = [];
    for (let round = 0; round < ROUNDS; ++round) {
      const without = await share(made.pid);
      const pages = await Promise.all(Array.from({ length: PAGES }, () => open(browser, made, path)));
      await sleep(3);
      const withPages = await share(made.pid);
      const first = await Promise.all(pages.slice(1).map((page) => page.context().close())).then(() => sleep(1)).then(() => share(made.pid));
      await pages[0].context().close();
      each.push({ without, withPages, first });
    }
    const of = (what) => median(each.map((one) => one[what]));
    console.log(`/${path}: aditd takes ${of("without").toFixed(1)} % of a core without a page, ${of("first").toFixed(1)} % with one, ${of("withPages").toFixed(1)} % with ${PAGES}: ` +
      `${median(each.map((one) => (one.withPages - one.without) / PAGES)).toFixed(2)} % for each`);
  }
  const without = await share(made.pid);
  const listeners = await Promise.all(Array.from({ length: LISTENERS }, () => listen(made)));
  const withThem = await share(made.pid);
  const kilobytes = listeners[0].bytes / 1000 / SECONDS;
  for (const listener of listeners) listener.end();
  console.log(`the events alone, ${LISTENERS} listeners: ${((withThem - without) / LISTENERS).toFixed(2)} % of a core and ${kilobytes.toFixed(0)} kB/s for each`);
} finally {
  await browser.close();
  await made.end();
}
