// What stands around the map: layers, time, zoom, and picking a place on it.
import { list, make, mark, say } from "./dom.js";
import { MapOfRun } from "./map.js";
import { clip, metres, timeOfDay } from "./words.js";

const section = document.getElementById("map");
const slider = section.querySelector("input[type=range]");
const shownTime = section.querySelector("output");
const robots = section.querySelector(".robots");

export const map = new MapOfRun(section.querySelector(".frame canvas"));
map.takeInput();
section.querySelector(".nearer").addEventListener("click", () => map.zoom(1.5));
section.querySelector(".farther").addEventListener("click", () => map.zoom(1 / 1.5));
section.querySelector(".fit").addEventListener("click", () => map.fit());
for (const box of section.querySelectorAll("[data-shows]")) {
  box.addEventListener("change", () => map.setShown(box.dataset.shows, box.checked));
}

// The slider's value is whole seconds since the first map; its right end is now.
let settle = null, now = 0;
slider.addEventListener("input", () => {
  showTime();
  clearTimeout(settle);
  settle = setTimeout(() => map.setTime(timeOf()), 120);
});
const isLive = () => Number(slider.value) >= Number(slider.max);
const timeOf = () => (isLive() ? null : Math.floor(map.first()) + Number(slider.value));

export function goLive() {
  slider.value = slider.max;
  slider.dispatchEvent(new Event("input"));
}
section.querySelector(".live").addEventListener("click", goLive);

function showTime() {
  const words = isLive() ? "now" : `as of ${timeOfDay(timeOf())}`;
  say(shownTime, words);
  slider.setAttribute("aria-valuetext", words);
  mark(section, "time", isLive() ? "now" : "past");
}

function stretchSlider() {
  const first = map.first(), wasLive = isLive();
  slider.disabled = first === null;
  slider.max = first === null ? 1 : Math.max(1, Math.ceil(now - Math.floor(first)));
  if (wasLive) slider.value = slider.max;
  showTime();
}

function showRobots() {
  const create = (robot) => {
    const box = make("input");
    box.type = "checkbox";
    box.checked = true;
    box.addEventListener("change", () => map.setRobot(robot, box.checked));
    return make("label", box, make("span", robot === "" ? "merged" : clip(robot, 20)));
  };
  list(robots, map.robots(), (robot) => `robot ${robot}`, create, () => {});
  section.querySelector(".legend").hidden = !map.kinds().has("cloud");
  const { spread } = map.colours();
  if (spread) say(section.querySelector(".low"), `${metres(spread.low)} m`);
  if (spread) say(section.querySelector(".high"), `${metres(spread.high)} m`);
}
map.onLayers = () => {
  showRobots();
  drawLegend();
};

function drawLegend() {
  const { heights } = map.colours();
  if (!heights) return;
  const canvas = section.querySelector(".legend canvas");
  const paint = canvas.getContext("2d");
  const ramp = paint.createLinearGradient(0, 0, canvas.width, 0);
  heights.forEach((colour, i) => ramp.addColorStop(i / (heights.length - 1), colour));
  paint.fillStyle = ramp;
  paint.fillRect(0, 0, canvas.width, canvas.height);
}

export function showMap(view, time) {
  now = time;
  stretchSlider();
  map.show(view);
  const { count, leftOut, thinned } = map.markers();
  const words = [
    leftOut ? `Of the markers the newest ${count} are shown; ${leftOut} older ones are not.` : "",
    thinned ? `Of the points of ${thinned === 1 ? "one marker" : `${thinned} markers`} only some are drawn.` : "",
  ];
  say(section.querySelector(".leftout"), words.filter(Boolean).join(" "));
}
