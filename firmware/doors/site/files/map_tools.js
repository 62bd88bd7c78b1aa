// What stands on the map: zoom, measuring, and which robot is followed.
import { attribute, mark, list, make, say } from "./dom.js";
import { drawn } from "./icons.js";
import { byName, clip } from "./words.js";

const LONG = 1, LOOK = 500; // seconds without a word; ms

let section = null, map = null;

export function offerTools(panel, shown) {
  [section, map] = [panel, shown];
  const tool = (name) => section.querySelector(`.zoom .${name}`);
  tool("nearer").addEventListener("click", () => map.zoom(1.5));
  tool("farther").addEventListener("click", () => map.zoom(1 / 1.5));
  tool("fit").addEventListener("click", () => map.fit());
  tool("measure").append(drawn("ruler"));
  tool("measure").title = "Measure between two points";
  tool("measure").addEventListener("click", () => map.measure(!map.ruler().isOn));
  choice().addEventListener("change", () => map.follow(choice().value || null));
  section.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !map.ruler().isOn) return;
    event.preventDefault();
    map.measure(false);
  });
  map.onTool = show;
  setInterval(showProgress, LOOK);
}
const choice = () => section.querySelector(".follow select");

function show() {
  const { isOn, words } = map.ruler();
  attribute(section.querySelector(".measure"), "aria-pressed", String(isOn));
  mark(document.body, "measures", String(isOn));
  say(section.querySelector(".measured"), words);
  const followed = map.followed() ?? "";
  if (choice().value !== followed) choice().value = followed;
}

function showProgress() {
  const progress = map.progress();
  say(section.querySelector(".loads"), progress && progress.seconds > LONG ? `Map loads, ${progress.done} of ${progress.all}` : "");
}

/** Which robots there are to follow. Nothing changes in the list while it is open. */
export function showTools({ robots }) {
  const select = choice(), names = robots.map(({ name }) => name).sort(byName);
  if (document.activeElement === select) return;
  select.disabled = names.length === 0;
  const create = (name) => {
    const option = make("option", name ? clip(name, 20) : "Follow …");
    option.value = name;
    return option;
  };
  list(select, ["", ...names], (name) => `follow ${name}`, create, () => {});
  show();
}
