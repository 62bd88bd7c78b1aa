// A sound for alarms that nobody has acknowledged: off until somebody wants it, and then so in this browser.
import { drawn } from "./icons.js";

const KEY = "adit-sound", AGAIN = 10_000; // ms
const TONES = { bad: [880, 660], ask: [660, 880] }; // Hz: bad falls, ask rises

const button = document.querySelector("button.sound");
let context = null, wanted = localStorage.getItem(KEY) === "on", at = -Infinity, known = new Set();

function show() {
  button.setAttribute("aria-label", wanted ? "Sound is on" : "Sound is off");
  button.replaceChildren(drawn(wanted ? "loud" : "mute"));
}

/** A browser lets nothing sound before somebody has touched the page. */
function wake() {
  context ??= new AudioContext();
  if (context.state === "suspended") context.resume();
}

function play(tones) {
  wake();
  tones.forEach((pitch, i) => {
    const begin = context.currentTime + 0.25 * i, tone = context.createOscillator(), volume = context.createGain();
    tone.frequency.value = pitch;
    volume.gain.setValueAtTime(0, begin);
    volume.gain.linearRampToValueAtTime(0.3, begin + 0.02);
    volume.gain.setTargetAtTime(0, begin + 0.12, 0.04);
    tone.connect(volume).connect(context.destination);
    tone.start(begin);
    tone.stop(begin + 0.4);
  });
}

button.addEventListener("click", () => {
  wanted = !wanted;
  localStorage.setItem(KEY, wanted ? "on" : "off");
  at = -Infinity;
  if (wanted) play(TONES.ask);
  show();
});
addEventListener("pointerdown", () => wanted && wake());
show();

/** At once for what is new, and again each 10 s until it is acknowledged or has gone. */
export function sounds(alarms) {
  const now = performance.now(); // the box's time of day can step
  const calling = alarms.filter(({ acknowledged, severity }) => !acknowledged && TONES[severity]);
  const isNew = calling.some(({ id }) => !known.has(id));
  known = new Set(calling.map(({ id }) => id));
  if (!wanted || calling.length === 0 || (!isNew && now < at + AGAIN)) return;
  at = now;
  play(TONES[calling[0].severity]);
}
