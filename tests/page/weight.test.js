import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { HtmlValidate } from "html-validate";

const FOLDER = fileURLToPath(new URL("../../firmware/site/files/", import.meta.url));
const MOST = 80_000;
const files = readdirSync(FOLDER);
const read = (name) => readFileSync(FOLDER + name);

const TYPES = `${readFileSync(new URL("../../firmware/artifact_types.inc", import.meta.url))}`.match(/^".*"/gm).join(", ");

/** As toolchain/cmake/embed.cmake puts it into aditd: scripts without the lines that are a comment and with the artifact
 *  types, style without comments, pages without what indents their lines. */
function embedded(name) {
  if (name.endsWith(".css")) return `${read(name)}`.replaceAll(/ *\/\*[^*]*\*\//g, "");
  if (name.endsWith(".html")) return `${read(name)}`.replaceAll(/\n +/g, "\n");
  if (!name.endsWith(".js")) return read(name);
  return `\n${read(name)}`.replaceAll(/\n *(\/\/[^\n]*|\/\*\*[^\n]*\*\/)/g, "\n").slice(1).replace('"artifact_types.inc"', TYPES);
}

test("all pages together weigh at most 80 kB gzipped", (t) => {
  const bytes = files.reduce((sum, name) => sum + gzipSync(embedded(name)).length, 0);
  t.diagnostic(`${files.length} files, ${bytes} bytes gzipped`);
  assert.ok(bytes > 10_000 && bytes <= MOST, `${bytes} bytes`);
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
    assert.ok(read(page).includes('<script src="again.js"></script>\n<link rel="stylesheet"'), `${page}: a part that does not come is asked for again`);
    assert.doesNotMatch(read(page).toString(), /<script>|<style|\sstyle=|\son\w+=|https?:/);
  }
});
