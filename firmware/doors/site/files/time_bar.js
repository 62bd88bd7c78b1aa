// The time that is shown: by a slider, in steps, or played. The slider's value is whole seconds since the first; its right end is
// now, or where the run ended.
import { mark, say } from "./dom.js";
import { drawn } from "./icons.js";
import { drawTicks } from "./time_ticks.js";
import { timeOfDay } from "./words.js";

const SETTLES = 120; // ms: while somebody slides, the map waits
const FRAME = 250; // ms of playing
const SPEEDS = [10, 60, 1];
const KEYS = { ArrowLeft: -10, ArrowDown: -10, ArrowRight: 10, ArrowUp: 10, PageDown: -60, PageUp: 60 }; // with Shift a sixth or a tenth

export class TimeBar {
  #node;
  #show;
  #end;
  #first = null;
  #last = 0;
  #settle = 0;
  #played = 0; // the timer
  #speed = SPEEDS[0];
  #ticks = { reports: [], alarms: [] };
  #ticksDrawn = [];
  #width = 0; // pixels of the slider: asking for it each second would lay the page out once more

  /** `node`: what holds .bar, output and .steps. `show(at)` is told what time to show; null: now. `end`: what the right end is called. */
  constructor(node, show, end = "now") {
    [this.#node, this.#show, this.#end] = [node, show, end];
    const slider = this.#slider;
    slider.addEventListener("input", () => this.#slid());
    slider.addEventListener("keydown", (event) => this.#pressed(event));
    for (const button of node.querySelectorAll("[data-step]")) {
      button.addEventListener("click", () => this.step(Number(button.dataset.step)));
    }
    this.#find("play").addEventListener("click", () => this.play(!this.#played));
    this.#find("play").append(drawn("play"));
    this.#find("speed").addEventListener("click", () => this.#setSpeed(SPEEDS[(SPEEDS.indexOf(this.#speed) + 1) % SPEEDS.length]));
    this.#setSpeed(SPEEDS[0]);
    node.querySelector(".live")?.addEventListener("click", () => this.goLive());
    new ResizeObserver(([{ contentRect: { width } }]) => {
      this.#width = width;
      this.#drawTicks(true);
    }).observe(this.#find("bar"));
  }

  #find = (name) => this.#node.querySelector(`.${name}`);
  get #slider() {
    return this.#node.querySelector("input[type=range]");
  }
  get #isEnd() {
    return Number(this.#slider.value) >= Number(this.#slider.max);
  }
  /** What is shown; null: now. */
  get at() {
    return this.#isEnd ? null : Math.floor(this.#first) + Number(this.#slider.value);
  }

  /** From the first to the last second that can be shown; `first` null: there is nothing yet. `ticks`: where they stand, {reports: [{at,
   *  level}], alarms: [{at, level}]}, the same lists if they did not change. */
  stretch(first, last, ticks) {
    const wasEnd = this.#isEnd, at = this.at;
    const slider = this.#slider;
    for (const control of [slider, ...this.#node.querySelectorAll(".steps button:not(.live)")]) control.disabled = first === null;
    if (first !== null && this.#first !== null && Math.floor(first) !== Math.floor(this.#first) && !wasEnd) {
      [this.#first, slider.max] = [first, Math.max(1, Math.ceil(last - Math.floor(first)))];
      slider.value = Math.max(0, at - Math.floor(first)); // the same time, from another beginning
    }
    [this.#first, this.#last, this.#ticks] = [first, last, ticks];
    slider.max = first === null ? 1 : Math.max(1, Math.ceil(last - Math.floor(first)));
    if (wasEnd) slider.value = slider.max;
    this.#say();
    this.#drawTicks();
  }

  #drawTicks(isNew = false) {
    const begin = this.#first && Math.floor(this.#first);
    const right = Math.round(this.#width * Math.log(Number(this.#slider.max))); // another one moves a tick by a pixel
    const shown = [begin, right, this.#ticks.reports, this.#ticks.alarms, document.documentElement.dataset.theme];
    if (!isNew && shown.every((each, i) => each === this.#ticksDrawn[i])) return;
    this.#ticksDrawn = shown;
    const first = Math.floor(this.#first ?? 0);
    drawTicks(this.#find("ticks"), this.#ticks, first, first + Number(this.#slider.max));
  }

  #slid() {
    this.play(false);
    this.#say();
    clearTimeout(this.#settle);
    this.#settle = setTimeout(() => this.#show(this.at), SETTLES);
  }

  #pressed(event) {
    const step = KEYS[event.key];
    if (!step || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    this.step(event.shiftKey ? Math.sign(step) * (Math.abs(step) === 60 ? 10 : 1) : step);
  }

  #set(value) {
    this.#slider.value = Math.min(Number(this.#slider.max), Math.max(0, value));
    this.#say();
    clearTimeout(this.#settle);
    this.#show(this.at);
  }

  /** So many seconds on, or back. */
  step(seconds) {
    if (this.#first === null) return;
    this.play(false);
    this.#set(Number(this.#slider.value) + seconds);
  }

  goLive() {
    this.play(false);
    this.#set(Number(this.#slider.max));
  }

  isPlaying = () => Boolean(this.#played);

  /** Goes on by itself up to the end; from the end it begins at the first. */
  play(isOn) {
    if (isOn === this.isPlaying() || (isOn && this.#first === null)) return;
    clearInterval(this.#played);
    this.#played = 0;
    if (isOn && this.#isEnd) this.#set(0);
    if (isOn) {
      let exact = Number(this.#slider.value);
      this.#played = setInterval(() => {
        exact += (this.#speed * FRAME) / 1000;
        this.#set(Math.floor(exact));
        if (this.#isEnd) this.play(false);
      }, FRAME);
    }
    const button = this.#find("play");
    button.setAttribute("aria-pressed", String(isOn));
    button.setAttribute("aria-label", isOn ? "Pause" : "Play");
    button.replaceChildren(drawn(isOn ? "pause" : "play"));
  }

  #setSpeed(speed) {
    this.#speed = speed;
    say(this.#find("speed"), `${speed}×`);
    this.#find("speed").setAttribute("aria-label", `${speed}×: plays ${speed} times as fast`);
  }

  #say() {
    const at = this.at, words = at === null ? this.#end : `as of ${timeOfDay(at)}`;
    const slider = this.#slider;
    say(this.#node.querySelector("output"), words);
    if (slider.getAttribute("aria-valuetext") !== words) slider.setAttribute("aria-valuetext", words);
    mark(this.#node.parentElement, "time", at === null ? "now" : "past");
  }
}
