// What stands around the map: layers and time. map_tools.js has what stands on it.
import { life } from "./arriving.js";
import { list, make, say } from "./dom.js";
import { MapOfRun } from "./map.js";
import { offerTools, showTools } from "./map_tools.js";
import { remembered } from "./remembered.js";
import { tint } from "./robot_colour.js";
import { alarmTicks } from "./run_history.js";
import { TimeBar } from "./time_bar.js";
import { whenThemeChanges } from "./theme_now.js";
import { clip, metres } from "./words.js";

const section = document.getElementById("map");
const robots = section.querySelector(".robots");

export const map = new MapOfRun(section.querySelector(".frame canvas"));
map.takeInput();
offerTools(section, map);
const boxes = [...section.querySelectorAll("[data-shows]")], presets = [...section.querySelectorAll("[data-layers]")];
const layersOf = ({ dataset }) => dataset.layers.split(" ");
function showLayers() {
  for (const box of boxes) map.setShown(box.dataset.shows, box.checked);
  const isSet = (preset) => boxes.every((box) => box.checked === layersOf(preset).includes(box.dataset.shows));
  for (const preset of presets) preset.setAttribute("aria-pressed", String(isSet(preset)));
}
for (const box of boxes) box.addEventListener("change", showLayers);
for (const preset of presets) {
  preset.addEventListener("click", () => {
    for (const box of boxes) box.checked = layersOf(preset).includes(box.dataset.shows);
    showLayers();
  });
}
showLayers();
/** @type {HTMLDetailsElement} */
const layers = section.querySelector(".layers");
layers.addEventListener("keydown", (event) => {
  if (event.key !== "Escape" || !layers.open) return;
  event.preventDefault();
  layers.open = false;
  layers.querySelector("summary").focus();
});
section.querySelector(".by-robot").addEventListener("change", ({ target }) => map.colourBy(target.checked ? "robot" : "height"));

/** The time that is shown. */
export const time = new TimeBar(section.querySelector(".time"), (at) => map.setTime(at));

const ticksOf = remembered((reports, run_number) =>
  reports.filter(({ run }) => run === run_number).map((report) => ({ at: report.received, level: life(report).level })));
const showTimes = ({ reports, run_number }, now) => time.stretch(map.first(), now, { reports: ticksOf(reports, run_number), alarms: alarmTicks() });

function showRobots() {
  const create = (robot) => {
    const box = make("input");
    box.type = "checkbox";
    box.checked = true;
    box.addEventListener("change", () => map.setRobot(robot, box.checked));
    const name = make("span.owner", robot === "" ? "merged" : clip(robot, 20));
    if (robot) tint(name, robot);
    return make("label", box, name);
  };
  list(robots, map.robots(), (robot) => `robot ${robot}`, create, () => {});
}
map.onLayers = () => {
  showRobots();
  drawLegend();
};

function drawLegend() {
  const legend = map.legend();
  section.querySelector(".legend").hidden = !map.kinds().has("cloud") || !legend?.heights;
  if (!legend?.heights || !legend.spread) return;
  say(section.querySelector(".low"), `${metres(legend.spread.low)} m`);
  say(section.querySelector(".high"), `${metres(legend.spread.high)} m`);
  const canvas = section.querySelector(".legend canvas");
  const ctx = canvas.getContext("2d");
  const ramp = ctx.createLinearGradient(0, 0, canvas.width, 0);
  legend.heights.forEach((colour, i) => ramp.addColorStop(i / (legend.heights.length - 1), colour));
  ctx.fillStyle = ramp;
  ctx.fillRect(0, 0, canvas.width, canvas.height);
}
whenThemeChanges(drawLegend);

export function showMap(view, now) {
  showTimes(view, now);
  map.show(view);
  showTools(view);
  const { count, leftOut, thinned } = map.markers();
  const words = [
    leftOut ? `The map shows the newest ${count} markers and leaves out ${leftOut}.` : "",
    thinned ? `Only some points of ${thinned === 1 ? "one marker" : `${thinned} markers`} are drawn.` : "",
  ];
  say(section.querySelector(".leftout"), words.filter(Boolean).join(" "));
}
