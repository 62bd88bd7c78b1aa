// Prints how long the map of twenty robots takes until it is complete, over 20 Mbit/s: as the page asks for its tiles, and with a request
// for each of the same tiles. Asserts nothing: tests/bench/README.md has figures and how to run it.
import { setTimeout as sleep } from "node:timers/promises";
import { launch, visit } from "../stage.js";
import { begin, TOKENS } from "../box/box.js";
import { median } from "./events.js";

const LINK = { offline: false, latency: 20, downloadThroughput: 20e6 / 8, uploadThroughput: 20e6 / 8 };
const ROUNDS = Number(process.env.BENCH_ROUNDS ?? 5), EXPLORES = Number(process.env.BENCH_SECONDS ?? 90) * 1000;
const QUIET = 3000; // ms without an answer: the map is complete
const AT_ONCE = 4; // requests, as the page has
const token = { Authorization: `Bearer ${TOKENS.team}` };
const print = (...cells) => console.log(`| ${cells.join(" | ")} |`);

/** A page on the slow link, with an empty cache, and what it fetches of tiles: {page, asked: [{url, end, bytes}]}; times in ms. */
async function slowPage(browser) {
  const page = await visit(browser, "about:blank", { extraHTTPHeaders: token, viewport: { width: 1920, height: 1080 } });
  const devtools = await page.context().newCDPSession(page), byId = new Map(), asked = [];
  devtools.on("Network.responseReceived", ({ requestId, response: { url } }) => url.includes("/tiles?") && byId.set(requestId, url));
  devtools.on("Network.loadingFinished", ({ requestId, encodedDataLength }) => {
    if (byId.has(requestId)) asked.push({ url: byId.get(requestId), end: performance.now(), bytes: encodedDataLength });
  });
  await devtools.send("Network.enable");
  await devtools.send("Network.emulateNetworkConditions", LINK);
  return { page, asked };
}

/** The page itself, from the navigation on: {took, urls, bytes}. */
async function byPage(browser, url) {
  const { page, asked } = await slowPage(browser), began = performance.now();
  await page.goto(url);
  while (!asked.length || performance.now() - asked.at(-1).end < QUIET) await sleep(100);
  await page.context().close();
  return { took: asked.at(-1).end - began, urls: asked.map((each) => each.url), bytes: asked.reduce((sum, each) => sum + each.bytes, 0) };
}

/** The requests for the same tiles, one each. */
const singly = (urls) => urls.flatMap((each) => {
  const url = new URL(each), places = url.searchParams.get("tiles").split(",");
  url.searchParams.delete("tiles");
  return places.map((place) => `${url.pathname.replace(/tiles$/, place)}.png${url.search}`);
});

/** A request for each: {took, bytes}. */
async function alone(browser, url, paths) {
  const { page } = await slowPage(browser);
  await page.goto(`${url}icon.svg`);
  const result = await page.evaluate(async ([paths, atOnce]) => {
    const began = performance.now(), left = [...paths];
    let bytes = 0, failed = 0;
    const work = async () => {
      while (left.length) {
        const answer = await fetch(left.shift());
        if (answer.ok) bytes += (await answer.arrayBuffer()).byteLength;
        else ++failed;
      }
    };
    await Promise.all(Array.from({ length: atOnce }, work));
    return { took: performance.now() - began, bytes, failed };
  }, [paths, AT_ONCE]);
  await page.context().close();
  return result;
}

const browser = await launch(), made = await begin({ robots: 20 });
try {
  await sleep(EXPLORES);
  made.freezeRobots();
  await sleep(5000); // until the box has drawn what it has
  const together = [], apart = [];
  for (let i = 0; i < ROUNDS; ++i) {
    together.push(await byPage(browser, made.url));
    apart.push(await alone(browser, made.url, singly(together.at(-1).urls)));
  }
  const took = (all) => all.map((each) => each.took);
  const row = (name, all, requests) =>
    print(name, requests, Math.round(all[0].bytes / 1000), median(took(all)).toFixed(0), Math.max(...took(all)).toFixed(0));
  const { urls } = together[0], { failed } = apart[0];
  if (failed) console.log(`${failed} tiles are not there any more`);
  print("twenty robots", "requests", "kB", "complete after, ms", "most");
  print("---", "---", "---", "---", "---");
  row("the page, from its opening on", together, urls.length);
  row("the same tiles, a request each, without the page", apart, singly(urls).length);
} finally {
  await browser.close();
  await made.end();
}
