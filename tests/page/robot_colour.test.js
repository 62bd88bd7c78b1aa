// The robots' colours and the artifacts' icons, without a browser.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { linesOf } from "../../firmware/site/files/artifact_icons.js";
import { kindOf, rgbOf, robotRgb, toneOf } from "../../firmware/site/files/robot_colour.js";

const TWENTY = [...Array(8).keys()].map((i) => `ugv${i + 1}`)
  .concat([...Array(6).keys()].map((i) => `spot${i + 1}`), [...Array(6).keys()].map((i) => `uav${i + 1}`));
const GROUNDS = { dark: "0b0e10", light: "eceae4", red: "080000" };

const bytesOf = (hex) => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16));
function luminance(rgb) {
  const [r, g, b] = rgb.map((value) => (value / 255 <= 0.04045 ? value / 255 / 12.92 : ((value / 255 + 0.055) / 1.055) ** 2.4));
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}
const contrast = (one, other) => {
  const [low, high] = [luminance(one), luminance(other)].sort((a, b) => a - b);
  return (high + 0.05) / (low + 0.05);
};

test("a robot's kind is told from its name", () => {
  const kinds = { ugv1: "ground", husky: "ground", "": "ground", spot3: "legged", ANYmal_2: "legged", uav7: "flying", drone: "flying", my_uav: "ground" };
  for (const [name, kind] of Object.entries(kinds)) assert.equal(kindOf(name), kind, name);
});

test("twenty robots have twenty colours by day", () => {
  for (const theme of ["dark", "light"]) assert.equal(new Set(TWENTY.map((name) => `${robotRgb(name, theme)}`)).size, 20);
});

test("a robot's colour is read on the ground of each theme", () => {
  for (const [theme, ground] of Object.entries(GROUNDS)) {
    for (const name of [...TWENTY, "X", "scout_99", "r2d2"]) {
      const ratio = contrast(robotRgb(name, theme), bytesOf(ground));
      assert.ok(ratio >= 4.5, `${name}, ${theme}: ${ratio.toFixed(2)}`);
    }
  }
});

test("hues keep within their kind's, whatever the number", () => {
  for (const [prefix, [from, to]] of Object.entries({ ugv: [195, 262], spot: [308, 348], uav: [108, 138] })) {
    for (let i = 0; i < 200; ++i) {
      const { hue } = toneOf(`${prefix}${i}`);
      assert.ok(hue >= from && hue <= to, `${prefix}${i}: ${hue}`);
    }
  }
});

test("at night lightness alone differs", () => {
  const reds = new Set(TWENTY.map((name) => `${robotRgb(name, "red")}`));
  assert.equal(reds.size, 3);
  for (const rgb of reds) assert.ok(Number(rgb.split(",")[0]) > 2 * Number(rgb.split(",")[2]), rgb);
});

test("OKLCH is converted as its author says", () => {
  assert.deepEqual(rgbOf(1, 0, 0), [255, 255, 255]);
  assert.deepEqual(rgbOf(0, 0, 0), [0, 0, 0]);
  assert.deepEqual(rgbOf(0.627955, 0.257683, 29.2339), [255, 0, 0]); // sRGB's red
});

test("each artifact type of the ICD has an icon of its own, and what is none has another", () => {
  const types = `${readFileSync(new URL("../../firmware/artifact_types.inc", import.meta.url))}`.match(/^".*"/gm).map((line) => line.slice(1, -1));
  assert.equal(types.length, 10);
  assert.equal(new Set([...types, "Ghost"].map(linesOf)).size, 11);
  assert.equal(linesOf("CELL PHONE"), linesOf("Cell Phone"));
  assert.equal(linesOf("constructor"), linesOf("Ghost"));
});
