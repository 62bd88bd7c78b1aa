import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { HtmlValidate } from "html-validate";

const FOLDER = fileURLToPath(new URL("../../firmware/page/files/", import.meta.url));
const MOST = 80_000;
const files = readdirSync(FOLDER);
const read = (name) => readFileSync(FOLDER + name);

test("all pages together weigh at most 80 kB gzipped", (t) => {
  const bytes = files.reduce((sum, name) => sum + gzipSync(read(name)).length, 0);
  t.diagnostic(`${files.length} files, ${bytes} bytes gzipped`);
  assert.ok(bytes > 10_000 && bytes <= MOST, `${bytes} bytes`);
});

/** All modules that a module needs, itself included. */
function modulesOf(name, known = new Set()) {
  if (known.has(name)) return known;
  known.add(name);
  for (const [, other] of read(name).toString().matchAll(/from "\.\/([a-z_]+\.js)"/g)) modulesOf(other, known);
  return known;
}

test("the run is asked for at once, not module after module", () => {
  for (const page of ["index.html", "display.html"]) {
    const text = read(page).toString();
    const [, first] = text.match(/<script type="module" src="([^"]+)"/);
    const preloaded = [...text.matchAll(/<link rel="modulepreload" href="([^"]+)">/g)].map(([, name]) => name);
    assert.deepEqual([first, ...preloaded].sort(), [...modulesOf(first)].sort(), page);
  }
});

test("every page is valid HTML without script or style of its own", async () => {
  const validator = new HtmlValidate({
    extends: ["html-validate:standard"],
    rules: { "no-inline-style": "error", "no-trailing-whitespace": "error", "void-style": "off", "doctype-style": "off", "long-title": "off" },
  });
  const pages = files.filter((name) => name.endsWith(".html"));
  assert.ok(pages.includes("index.html") && pages.includes("display.html"));
  for (const page of pages) {
    const report = await validator.validateString(read(page).toString(), page);
    const found = report.results.flatMap(({ messages }) => messages.map(({ line, message, ruleId }) => `${page}:${line}: ${message} (${ruleId})`));
    assert.deepEqual(found, []);
    assert.doesNotMatch(read(page).toString(), /<script>|<style|\sstyle=|\son\w+=|https?:/);
  }
});
