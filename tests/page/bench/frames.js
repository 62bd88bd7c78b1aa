// Measures a page's load on the browser and how smoothly its map moves: twenty active robots, 1,000 reports on record, dragging and
// zooming, a browser without a GPU. It asserts nothing: tests/bench/README.md has figures and how to run it.
import { launch, visit } from "../stage.js";
import { TOKENS } from "../box/box.js";
import { withReports } from "./events.js";

const ROBOTS = Number(process.env.BENCH_ROBOTS ?? 20), SECONDS = Number(process.env.BENCH_SECONDS ?? 10), WARM = Number(process.env.BENCH_WARM ?? 60);
const SCREENS = [[1280, 720], [1920, 1080]];
const canvas = "#map .frame canvas";

const sleep = (seconds) => new Promise((resolve) => setTimeout(resolve, seconds * 1000));

/** Moves the map frame by frame, as a hand does. Returns the milliseconds between frames. */
async function move(page, how) {
  return page.$eval(canvas, async (node, { how, seconds }) => {
    const { x, y, width, height } = node.getBoundingClientRect(), frame = () => new Promise(requestAnimationFrame);
    node.setPointerCapture = () => {};
    const send = (type, left, top) => node.dispatchEvent(new PointerEvent(type, { pointerId: 1, clientX: x + left, clientY: y + top, bubbles: true }));
    const times = [];
    const place = (i) => [width / 2 + (width / 3) * Math.sin(i / 20), height / 2 + (height / 3) * Math.cos(i / 27)];
    if (how === "dragged") send("pointerdown", ...place(0));
    const end = performance.now() + seconds * 1000;
    for (let i = 0, last = performance.now(); last < end; ++i) {
      if (how === "dragged") send("pointermove", ...place(i));
      if (how === "zoomed") node.dispatchEvent(new WheelEvent("wheel", { deltaY: 24 * Math.sign(Math.sin(i / 40)), clientX: x + width / 2, clientY: y + height / 2, bubbles: true, cancelable: true }));
      const now = await frame();
      times.push(now - last);
      last = now;
    }
    if (how === "dragged") send("pointerup", ...place(0));
    return times.slice(1);
  }, { how, seconds: SECONDS });
}

/** Figures of one run: frames per second, milliseconds between frames, CPU time per wall time (of the main thread; of all processes of
 *  the browser, in per cent of a core), and the main thread's CPU time per frame. */
async function measure(page, devtools, all, how) {
  const busy = async () => {
    const { processInfo } = await all.send("SystemInfo.getProcessInfo");
    const { metrics } = await devtools.send("Performance.getMetrics");
    const of = (name) => metrics.find((each) => each.name === name).value;
    return { task: of("TaskDuration"), script: of("ScriptDuration"), all: processInfo.reduce((sum, { cpuTime }) => sum + cpuTime, 0), at: performance.now() / 1000 };
  };
  const before = await busy(), times = (await move(page, how)).sort((a, b) => a - b), after = await busy();
  const share = (what) => `${((100 * (after[what] - before[what])) / (after.at - before.at)).toFixed(0)} %`;
  const at = (part) => `${times[Math.min(times.length - 1, Math.floor(times.length * part))].toFixed(0)} ms`;
  const each = `${((1000 * (after.task - before.task)) / times.length).toFixed(1)} ms`;
  return [`${(times.length / SECONDS).toFixed(0)}/s`, at(0.5), at(0.95), at(1), share("all"), share("task"), share("script"), each];
}

const made = await withReports(ROBOTS);
const browser = await launch(), all = await browser.newBrowserCDPSession();
try {
  await sleep(WARM);
  console.log(`${ROBOTS} robots, ${SECONDS} s each\n| screen | the map is | frames | median | 95 % | longest | browser | main thread | of it script | each frame |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |`);
  for (const [width, height] of SCREENS) {
    const page = await visit(browser, made.url, { extraHTTPHeaders: { Authorization: `Bearer ${TOKENS.team}` }, viewport: { width, height } });
    await page.waitForSelector("body[data-link=live]");
    const devtools = await page.context().newCDPSession(page);
    await devtools.send("Performance.enable", { timeDomain: "threadTicks" });  // CPU time, independent of the machine's other load
    await sleep(5);
    for (const how of ["left alone", "dragged", "zoomed"]) console.log(`| ${width} x ${height} | ${[how, ...(await measure(page, devtools, all, how))].join(" | ")} |`);
    await page.context().close();
  }
} finally {
  await browser.close();
  await made.end();
}
