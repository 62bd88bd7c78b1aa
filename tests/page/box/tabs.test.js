// Many tabs of one browser share one event stream of the box. A tab without a shared worker has its own while it is visible.
import assert from "node:assert/strict";
import { get } from "node:http";
import { test } from "node:test";
import { until } from "../box.js";
import { TOKENS } from "./box.js";
import { box, logIn } from "./visits.js";

const MOST = 24;  // limit of a box's streams

/** Opens streams beside those of the pages until the box rejects one, or `most` of them. Returns their number and a function that ends
 *  them. */
async function fill(made, most = MOST) {
  const open = [];
  const one = () => new Promise((opened, failed) => {
    const request = get(`${made.url}adit/events`, { headers: { Authorization: `Bearer ${TOKENS.team}` } }, (answer) => {
      answer.on("error", () => {}).resume();
      if (answer.statusCode === 200) open.push(request);
      opened(answer.statusCode === 200);
    }).on("error", failed);
  });
  while (open.length < most && (await one()));
  return { count: open.length, end: () => open.forEach((request) => request.destroy()) };
}

/** Waits until the pages have that many open streams. */
const streamsAre = (made, count) => until(async () => {
  const { count: others, end } = await fill(made);
  end();
  return MOST - others === count;
}, `${count} streams`);

const isLive = (page) => page.waitForSelector("body[data-link=live]");

/** That many live tabs of one browser. */
async function tabs(t, made, count) {
  const pages = [await logIn(t, made)];
  while (pages.length < count) {
    const page = await pages[0].context().newPage();
    pages.push(page);
    await page.goto(made.url);
  }
  await Promise.all(pages.map(isLive));
  return pages;
}

test("seven tabs of one browser share one stream, the seventh sends a report, and all recover with the box", async (t) => {
  const made = await box(t), pages = await tabs(t, made, 7), [first] = pages, last = pages.at(-1);
  await streamsAre(made, 1);
  await last.locator("#reports .compose:enabled").click();
  await last.locator("#compose .types").getByRole("button", { name: "Drill", exact: true }).click();
  for (const [name, value] of [["x", "7"], ["y", "2"], ["z", "0.5"]]) await last.fill(`#compose input[name=${name}]`, value);
  await last.getByRole("button", { name: "Check" }).click();
  await last.locator("#compose").getByRole("button", { name: "Send" }).click();
  for (const page of [last, first]) await page.locator('#reports li[data-key="1"]', { hasText: "Drill" }).waitFor();
  await made.killAditd();
  await Promise.all(pages.map((page) => page.waitForSelector("body[data-link=lost]")));
  await made.startAditd();
  await Promise.all(pages.map(isLive));
  await streamsAre(made, 1);
  await Promise.all(pages.slice(1).map((page) => page.close()));
  await made.compose("Rope", 90);
  await first.locator('#reports li[data-key="2"]', { hasText: "Rope" }).waitFor();
});

test("display and run page share one stream, and all tabs of an ended session go to the login", async (t) => {
  const made = await box(t), pages = await tabs(t, made, 3);
  await pages[1].goto(`${made.url}display`);
  await isLive(pages[1]);
  await streamsAre(made, 1);
  const { said: sessions } = await made.ask("/adit/sessions");
  for (const { number } of sessions) await made.ask(`/adit/sessions/${number}/end`, {});
  await Promise.all(pages.map((page) => page.waitForURL(/login\.html/)));
  await streamsAre(made, 0);
});

test("a tab without a shared worker has its own stream only while it is visible", async (t) => {
  const made = await box(t);
  const page = await logIn(t, made, (page) => page.addInitScript(() => delete globalThis.SharedWorker));
  const show = (isShown) => page.evaluate((isHidden) => {
    Object.defineProperty(document, "hidden", { value: isHidden, configurable: true });
    document.dispatchEvent(new Event("visibilitychange"));
  }, !isShown);
  await streamsAre(made, 1);
  await show(false);
  await streamsAre(made, 0);
  await made.compose("Rope", 90);
  await show(true);
  await page.locator('#reports li[data-key="1"]', { hasText: "Rope" }).waitFor();
  await streamsAre(made, 1);
  assert.equal(await page.getAttribute("body", "data-link"), "live");
});

test("a page without a stream shows the box's sentence, and is live once another page closes", async (t) => {
  const made = await box(t), pages = [await logIn(t, made), await logIn(t, made)];
  for (const page of pages) await page.goto("about:blank");
  let others;
  await until(async () => (others = await fill(made)).count === MOST || others.end(), "all streams to be free");
  for (const [i, path] of ["", "display"].entries()) {
    await pages[i].goto(made.url + path);
    await pages[i].locator("#attention", { hasText: `too many pages are open: the box serves at most ${MOST} at once` }).waitFor();
    assert.doesNotMatch(await pages[i].innerText("#attention"), /does not answer/);
  }
  assert.equal(await pages[0].textContent("#link"), `The box answers: too many pages are open: the box serves at most ${MOST} at once`);
  assert.match(await pages[0].title(), /The box sends no data to this page/);
  others.end();
  await Promise.all(pages.map(isLive));
});

test("tabs have their own streams if their worker ends or its script is lost", async (t) => {
  const made = await box(t), pages = await tabs(t, made, 2);
  const devtools = await pages[0].context().browser().newBrowserCDPSession();
  const { targetInfos } = await devtools.send("Target.getTargets");
  const workers = targetInfos.filter(({ type, url }) => type === "shared_worker" && url.startsWith(made.url));
  assert.equal(workers.length, 1);
  const { sessionId } = await devtools.send("Target.attachToTarget", { targetId: workers[0].targetId, flatten: false });
  await devtools.send("Target.sendMessageToTarget", { sessionId, message: JSON.stringify({ id: 1, method: "Runtime.evaluate", params: { expression: "close()" } }) });
  await streamsAre(made, 2);
  await Promise.all(pages.map(isLive));

  const other = await logIn(t, made, (page) => page.addInitScript(() => {
    const { SharedWorker } = globalThis;
    globalThis.SharedWorker = class extends SharedWorker {
      constructor(name, ...more) {
        super(name.replace(/\.[0-9a-f]+\./, ".0123456789ab."), ...more);  // from another version of the box
      }
    };
  }));
  await streamsAre(made, 3);
  await isLive(other);
});
