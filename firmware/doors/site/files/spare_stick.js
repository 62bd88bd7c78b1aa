// The export and the stick in the box: its state, and the exports on it.
import { make } from "./dom.js";

const place = document.querySelector("#spare .stick");
const told = place.querySelector("p"), offers = place.querySelector("div");

const sentence = (text) => `${text[0].toUpperCase()}${text.slice(1)}.`;
const DOING = {
  writing: "The box is writing the export to the stick. Leave the stick in.",
  checking: "The box is reading the export back. Leave the stick in.",
  reading: "The box is reading the export from the stick.",
};

/** {text, bad} of the stick; `standby`: this box has an export to write. */
function wordOf({ doing, refusal, written, hindrance, unreadable }, standby) {
  if (doing) return { text: DOING[doing] ?? sentence(doing) };
  if (refusal) return { text: sentence(refusal), bad: true };
  if (standby && written) return { text: `The export is on the stick and was read back: ${written}. You can unplug the stick. Note the code, and unplug this box before the spare takes over.` };
  const why = (standby && hindrance) || unreadable;
  return { text: why ? sentence(why) : "" };
}

function nameOf({ name, box, at }) {
  return box && at !== null ? `the box at ${box}, ${new Date(at * 1000).toLocaleString()}` : name;
}

/** Nothing moves under a finger: what is offered stays as it is, where it is the same. `take(name)`: what a press does. */
function offer(exports, take) {
  const key = JSON.stringify(exports);
  if (offers.dataset.key === key) return;
  offers.dataset.key = key;
  offers.replaceChildren(...exports.map((each) => {
    const button = make("button", `Import from the stick: ${nameOf(each)}`);
    button.addEventListener("click", () => take(each.name));
    return button;
  }));
}

/** `takes`: an export was imported already. */
export function showStick({ stick, standby, code, takes_over: takesOver }, takes, take) {
  place.hidden = !stick || takesOver;
  if (place.hidden) return;
  const { text, bad } = wordOf(stick, standby && Boolean(code));
  if (told.textContent !== text) told.textContent = text;
  told.dataset.bad = Boolean(bad);
  offer(takes || stick.doing ? [] : stick.exports.filter(({ name }) => !(standby && name === stick.written)), take);
}
