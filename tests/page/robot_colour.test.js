// Colours of robots and icons of artifacts, without a browser.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { linesOf } from "../../firmware/doors/site/files/artifact_icons.js";
import { chooseColours, dashesOf, kindOf, lookOf, robotLooks, orderRobots, rgbOf, robotRgb, toneOf } from "../../firmware/doors/site/files/robot_colour.js";

const TWENTY = [...Array(20).keys()];
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

test("a robot's kind follows from its name", () => {
  const kinds = { ugv1: "ground", husky: "ground", "": "ground", spot3: "legged", ANYmal_2: "legged", uav7: "flying", drone: "flying", my_uav: "ground" };
  for (const [name, kind] of Object.entries(kinds)) assert.equal(kindOf(name), kind, name);
});

test("twenty robots have twenty colours by day, and neighbouring hues differ in lightness and pattern", () => {
  for (const theme of ["dark", "light"]) assert.equal(new Set(TWENTY.map((place) => `${robotRgb(place, theme)}`)).size, 20);
  const byHue = [...TWENTY].sort((a, b) => toneOf(a).hue - toneOf(b).hue);
  byHue.forEach((place, i) => {
    const next = byHue[(i + 1) % 20];
    assert.notEqual(toneOf(place).lightness, toneOf(next).lightness);
    assert.notDeepEqual(dashesOf(place), dashesOf(next));
  });
});

test("a robot keeps its colour as others join, and has the same on each page, in the order of first poses", () => {
  const colours = (...names) => names.map((name) => lookOf(name).colour);
  colours("r1", "r2", "r10");  // in an event
  assert.deepEqual(colours("r10", "r1", "r2", "r9", "r10"), [2, 0, 1, 3, 2]);
  orderRobots(["r10", "r9"]);  // in the tracks
  assert.deepEqual(colours("r10", "r9", "r1", "r2"), [0, 1, 2, 3]);
  assert.ok(chooseColours([{ name: "r9", colour: 1 }]));
  assert.deepEqual(colours("r10", "r9", "r1", "r2"), [1, 0, 2, 3]);
  assert.ok(!chooseColours([{ name: "r9", colour: 1 }]), "the same colours again are not a change");
});

test("the settings name as many colours as there are", () => {
  const source = `${readFileSync(new URL("../../firmware/rules/settings/settings.hpp", import.meta.url))}`;
  const [words] = /kColourWords\[\] = \{[^}]+\}/.exec(source);
  assert.equal(words.match(/"\w+"/g).length, 1 + TWENTY.length);
});

test("a robot's colour has enough contrast in each theme", () => {
  for (const [theme, ground] of Object.entries(GROUNDS)) {
    for (let place = 0; place < 60; ++place) {
      const ratio = contrast(robotRgb(place, theme), bytesOf(ground));
      assert.ok(ratio >= 4.5, `${place}, ${theme}: ${ratio.toFixed(2)}`);
    }
  }
});

test("no robot has the hue of an alarm level", () => {
  for (let place = 0; place < 60; ++place) {
    for (const level of [25, 75, 158, 277]) assert.ok(Math.abs(toneOf(place).hue - level) >= 10, `${place}: ${toneOf(place).hue}`);
  }
});

const lightHex = (place) => `#${robotRgb(place, "light").map((part) => part.toString(16).padStart(2, "0")).join("")}`;
const onPaper = (pattern) => dashesOf(pattern).map((length) => String(Number((0.3 * length).toFixed(1)))).join(" ") || "none";

test("the run's report has the colours of the light page, and its patterns in 0.3 mm", () => {
  const source = `${readFileSync(new URL("../../firmware/doors/archive/run_report.cpp", import.meta.url))}`;
  assert.deepEqual(source.match(/#[0-9a-f]{6}/g), [...Array(40).keys()].map(lightHex));
  const [, dashes] = /kDashes\[\] = \{([^}]+)\}/.exec(source);
  assert.deepEqual([...dashes.matchAll(/"([^"]+)"/g)].map(([, each]) => each), [0, 1, 2, 3].map(onPaper));
});

test("robots with the same chosen colour have different patterns, and the others have unchosen colours, as in the run's report", () => {
  const source = `${readFileSync(new URL("../archive/run_report_test.cpp", import.meta.url))}`;
  const [, robots, colours, lines] = /DrawsChosenColours[^]*?: \{("r1"[^}]+)\}[^]*?kept\.colours = \{([^;]+)\};[^]*?ElementsAre\(([^)]+)\)/.exec(source);
  const chosen = new Map([...colours.matchAll(/"(\w+)", (\d+)/g)].map(([, name, colour]) => [name, colour - 1]));
  const looks = robotLooks(robots.match(/\w+/g), chosen);
  assert.deepEqual(lines.match(/#[^"]+/g), [...looks.values()].map(({ colour, pattern }) => `${lightHex(colour)} ${onPaper(pattern)}`));
});

test("at night only lightness and pattern differ", () => {
  const reds = new Set(TWENTY.map((place) => `${robotRgb(place, "red")} ${dashesOf(place)}`));
  assert.equal(reds.size, 4);
  for (const rgb of reds) assert.ok(Number(rgb.split(",")[0]) > 2 * Number(rgb.split(",")[2].split(" ")[0]), rgb);
});

test("OKLCH is converted as its author defines it", () => {
  assert.deepEqual(rgbOf(1, 0, 0), [255, 255, 255]);
  assert.deepEqual(rgbOf(0, 0, 0), [0, 0, 0]);
  assert.deepEqual(rgbOf(0.627955, 0.257683, 29.2339), [255, 0, 0]); // sRGB's red
});

test("each artifact type of the ICD has its own icon, and other types another one", () => {
  const types = `${readFileSync(new URL("../../firmware/interface/icd/artifact_types.inc", import.meta.url))}`.match(/^".*"/gm).map((line) => line.slice(1, -1));
  assert.equal(types.length, 10);
  assert.equal(new Set([...types, "Ghost"].map(linesOf)).size, 11);
  assert.equal(linesOf("CELL PHONE"), linesOf("Cell Phone"));
  assert.equal(linesOf("constructor"), linesOf("Ghost"));
});
