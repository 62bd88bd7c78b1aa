// Shared by tests with a scene: a program that serves the page with the scene, and a browser page.
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdirSync } from "node:fs";
import { join, resolve } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { patient } from "./patience.js";

/** The directory of the tested programs. */
export const BIN = resolve(process.env.ADIT_BIN);
/** The source files of the pages. */
export const FILES = fileURLToPath(new URL("../../firmware/doors/site/files", import.meta.url));
/** Debian's headless shell of Chromium: the same engine, in half the time of the whole browser. */
export const CHROMIUM = process.env.CHROMIUM ?? "/usr/bin/chromium-headless-shell";

/** Serves `scene` on `port` (0: any free one); `more`: "first-start", "set-up-open", "https" or "by-tls". */
export async function serve(scene, port = 0, ...more) {
  const program = spawn(join(BIN, "adit_page_scenes"), [String(port), scene, ...more], { stdio: ["pipe", "pipe", "inherit"] });
  const [line] = await once(createInterface({ input: program.stdout }), "line");
  return {
    port: Number(line),
    url: `http://127.0.0.1:${line}/`,
    play: (next) => program.stdin.write(`${next}\n`),
    freeze: () => program.kill("SIGSTOP"),
    thaw: () => program.kill("SIGCONT"),
    async end() {
      if (program.exitCode !== null || program.signalCode !== null) return;
      program.kill("SIGKILL");
      await once(program, "exit");
    },
  };
}

export const launch = (executablePath = CHROMIUM) =>
  chromium.launch({
    executablePath,
    timeout: patient(30_000),
    args: ["--disable-gpu", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"]
      .concat(process.getuid() === 0 ? ["--no-sandbox"] : []),
  });

const BY_TOKEN = { extraHTTPHeaders: { Authorization: "Bearer team-1" } };

/** Opens the page with the token. */
export async function look(browser, url, options = {}, prepare = () => {}) {
  const page = await visit(browser, url, { ...BY_TOKEN, ...options }, prepare);
  await page.waitForSelector("body[data-link=live]");
  return page;
}

/** Opens a page. Its complaints and requests are in `page.complaints` and `page.requests`. */
export async function visit(browser, url, options = {}, prepare = () => {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, ...options });
  context.setDefaultTimeout(patient(120_000));
  // A worker's requests lack the context's headers, so a page with a token gets no shared workers.
  if (options.extraHTTPHeaders) await context.addInitScript(() => delete globalThis.SharedWorker);
  const page = await context.newPage();
  page.complaints = [];
  page.requests = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) page.complaints.push(message.text());
  });
  page.on("pageerror", (error) => page.complaints.push(String(error)));
  page.on("dialog", (dialog) => page.complaints.push(`dialog: ${dialog.message()}`) && dialog.dismiss());
  page.on("request", (request) => page.requests.push(request.url()));
  await prepare(page);
  await page.goto(url);
  return page;
}

/** Closes the page. Errors of the test's handlers for pending answers then fail no test. */
export async function leave(page) {
  if (!page.isClosed()) await page.unrouteAll({ behavior: "ignoreErrors" });
  await page.context().close();
}

/** An init script for settled() and hears(): counts the page's pending requests and frames, and the box's events. */
export function countAwaited() {
  globalThis.awaited = globalThis.still = globalThis.heard = 0;
  const { EventSource } = globalThis;
  globalThis.EventSource = class extends EventSource {
    constructor(...words) {
      super(...words);
      for (const type of ["message", "patch"]) this.addEventListener(type, ({ isTrusted }) => (globalThis.heard += isTrusted));
    }
  };
  const { prototype } = Response;
  for (const [owner, name] of [[globalThis, "fetch"], [globalThis, "createImageBitmap"], [prototype, "json"], [prototype, "blob"]]) {
    const real = owner[name];
    owner[name] = function (...words) {
      ++globalThis.awaited;
      return real.apply(this, words).finally(() => --globalThis.awaited);
    };
  }
  const { requestAnimationFrame } = globalThis;
  globalThis.requestAnimationFrame = (draw) => {
    ++globalThis.awaited;
    return requestAnimationFrame((at) => {
      --globalThis.awaited;  // before draw(), which may be settled() looking
      draw(at);
    });
  };
}

/** Waits until a watched page has no pending request for three frames, so that it has drawn everything. */
export const settled = (page) =>
  page.waitForFunction(() => {
    globalThis.still = globalThis.awaited ? 0 : (globalThis.still + 1) % 4;
    return !globalThis.awaited && !globalThis.still;
  });

/** Waits until the page has received `count` more events and, on the run page, was drawn since. The page is drawn each second, so it
 *  has then handled the events. */
export async function hears(page, count) {
  const before = await page.evaluate(() => globalThis.heard);
  await page.waitForFunction((enough) => globalThis.heard >= enough, before + count);
  if (!(await page.$("#about"))) return;
  const told = await page.textContent("#about");  // the box's clock
  await page.waitForFunction((told) => document.getElementById("about").textContent !== told, told);
}

/** Waits until every element that appeared or moved takes presses again: presses.js. */
export const armed = (page) => page.waitForFunction(() => !document.querySelector("[data-moving]"));

/** Saves a picture beside the programs, for people. */
export async function shoot(page, name) {
  const folder = join(BIN, "../screenshots");
  mkdirSync(folder, { recursive: true });
  await page.screenshot({ path: join(folder, `${name}.png`) });
}
