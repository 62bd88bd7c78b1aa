// The size and the caching of a page, by real answers to a browser and a script.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { appendFileSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { get } from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { gunzipSync } from "node:zlib";
import { HtmlValidate } from "html-validate";
import { FILES, serve } from "./stage.js";
import { visitor } from "./watch.js";

const PAGES = ["", "display", "runs", "setup", "system", "help", "login.html"];
const MOST_REQUESTS = 5;  // the page, its script, its style, its icon, and its reload script
const MOST = 60_000;  // bytes of one page, compressed
const SITE = fileURLToPath(new URL("../../firmware/doors/site/", import.meta.url));

async function stageFor(t) {
  const stage = await serve("calm");
  t.after(() => stage.end());
  return stage;
}

/** The answer to a script: {status, headers, body}. */
const ask = (url, headers = {}) =>
  new Promise((resolve, reject) => {
    get(url, { headers }, async (answer) => resolve({ ...answer, status: answer.statusCode, headers: answer.headers, body: Buffer.concat(await answer.toArray()) })).on("error", reject);
  });

/** The files that a page names. */
const namedIn = (html) => [...html.matchAll(/(?:href|src)="([^"/]+\.(?:js|css|svg))"/g)].map(([, name]) => name);

/** A browser's requests for a page, without the API: [{url, headers, kept, length}]. */
async function visitTwice(t, stage, path) {
  const page = await visitor(t, "about:blank", { extraHTTPHeaders: { Authorization: "Bearer team-1" } });
  const devtools = await page.context().newCDPSession(page);
  await devtools.send("Network.enable");
  const answers = new Map(), add = (id, what) => answers.set(id, { length: 0, ...answers.get(id), ...what });
  devtools.on("Network.requestServedFromCache", ({ requestId }) => add(requestId, { kept: true }));
  devtools.on("Network.responseReceived", ({ requestId, response }) => add(requestId, { url: response.url, headers: response.headers, ...(response.fromDiskCache && { kept: true }) }));
  devtools.on("Network.loadingFinished", ({ requestId, encodedDataLength }) => add(requestId, { length: encodedDataLength }));
  const files = () => [...answers.values()].filter(({ url }) => url?.startsWith(stage.url) && !url.includes("/adit/"));
  const visits = [];
  for (const once of ["first", "again"]) {
    await page.goto(`${stage.url}${path}`, { waitUntil: "load" });
    await page.waitForFunction(() => performance.getEntriesByName("first-contentful-paint").length > 0);
    visits.push(files());
    answers.clear();
    assert.ok(visits.at(-1).length > 0, once);
  }
  return visits;
}

test("a page loads in a few answers, all compressed", async (t) => {
  const stage = await stageFor(t);
  for (const path of ["", "display", "setup", "system"]) {
    const [first, again] = await visitTwice(t, stage, path);
    const bytes = first.reduce((sum, { length }) => sum + length, 0);
    t.diagnostic(`/${path}: ${first.length} answers, ${bytes} bytes; again: ${again.filter(({ kept }) => !kept).length} answers`);
    const names = new Set(first.map(({ url }) => url));
    assert.ok(names.size >= 4 && names.size <= MOST_REQUESTS, [...names].join(" "));
    assert.ok(bytes > 5_000 && bytes <= MOST, `/${path}: ${bytes} bytes`);
    for (const { url, headers } of first) assert.equal(headers["Content-Encoding"], "gzip", url);
    for (const { url, kept } of again) assert.ok(kept || !/\.[0-9a-f]{12}\./.test(url), `asked for again: ${url}`);
  }
});

test("files named by their content have that content and may be cached; a page is requested each time", async (t) => {
  const stage = await stageFor(t);
  for (const path of PAGES) {
    const page = await ask(stage.url + path);
    assert.equal(page.headers["cache-control"], "no-cache");
    const names = namedIn(`${page.body}`);
    assert.deepEqual(names.map((name) => name.split(".").at(-1)).sort(), ["css", "js", "js", ...names.filter((name) => name.endsWith(".svg")).map(() => "svg")], path);
    for (const name of names) {
      const plain = await ask(stage.url + name), packed = await ask(stage.url + name, { "Accept-Encoding": "gzip" });
      assert.deepEqual([plain.status, plain.headers["content-encoding"], packed.headers["content-encoding"]], [200, undefined, "gzip"], name);
      assert.deepEqual(gunzipSync(packed.body), plain.body, name);
      const [, hash] = /\.([0-9a-f]{12})\.(?:js|css)$/.exec(name) ?? [];
      if (hash) assert.equal(createHash("sha256").update(plain.body).digest("hex").slice(0, 12), hash, name);
      else assert.ok(name.endsWith(".svg"), name);
      assert.match(packed.headers["cache-control"], hash ? /max-age=31536000, immutable/ : /^no-cache$/, name);
      const same = await ask(stage.url + name, { "Accept-Encoding": "gzip", "If-None-Match": packed.headers.etag });
      assert.deepEqual([same.status, same.body.length], [304, 0], name);
    }
  }
});

/** The built files of the pages for source files `files`, as text by name. */
function made(files) {
  const folder = mkdtempSync(join(tmpdir(), "adit-bundle-"));
  try {
    execFileSync(join(SITE, "bundle"), [files, join(SITE, "parts"), join(SITE, "../../interface/icd/artifact_types.inc"), folder], { stdio: "pipe" });
    const served = join(folder, "served");
    return Object.fromEntries(readdirSync(served).map((file) => [file, readFileSync(join(served, file), "utf8")]));
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/** A copy of the pages' source files in a directory that is removed after the test. */
function elsewhere(t) {
  const folder = mkdtempSync(join(tmpdir(), "adit-pages-"));
  t.after(() => rmSync(folder, { recursive: true }));
  execFileSync("cp", ["-r", FILES, join(folder, "files")]);
  return join(folder, "files");
}

test("the build does not depend on the directory", (t) => {
  const other = elsewhere(t);
  const first = made(FILES);
  assert.ok(Object.keys(first).length > PAGES.length * 3);
  assert.deepEqual(first, made(other));
  for (const [name, text] of Object.entries(first)) assert.ok(!text.includes(SITE) && !text.includes(other) && !/\/\*|^\s*\/\/ /m.test(text), name);
});

test("a page that names a missing part fails to build", (t) => {
  const other = elsewhere(t);
  appendFileSync(join(other, "runs.html"), "<!-- part: nobody -->\n");
  assert.throws(() => made(other), /nobody\.html/);
});

test("every page is valid HTML without inline script or style", async () => {
  const validator = new HtmlValidate({
    extends: ["html-validate:standard"],
    rules: { "no-inline-style": "error", "no-trailing-whitespace": "error", "void-style": "off", "doctype-style": "off", "long-title": "off" },
  });
  const pages = Object.entries(made(FILES)).filter(([name]) => name.endsWith(".html"));
  assert.equal(pages.length, PAGES.length);
  for (const [page, text] of pages) {
    const report = await validator.validateString(text, page);
    const found = report.results.flatMap(({ messages }) => messages.map(({ line, message, ruleId }) => `${page}:${line}: ${message} (${ruleId})`));
    assert.deepEqual(found, []);
    assert.match(text, /<script src="first\.[0-9a-f]+\.js"><\/script>\n<link href="[^"]+" rel="stylesheet">/, `${page}: a part that does not come is asked for again`);
    assert.doesNotMatch(text, /<script>|<style|\sstyle=|\son\w+=|https?:/);
  }
});
