// A run that is looked at again: the same map as that of the run view, at any of its times.
import { life } from "./arriving.js";
import { say } from "./dom.js";
import { MapOfRun } from "./map.js";
import { offerTools, showTools } from "./map_tools.js";
import { get } from "./session.js";
import { TimeBar } from "./time_bar.js";

const section = document.getElementById("look");
let map = null, time = null, end = 0; // made when they are first seen: a canvas that is hidden has no size

function offer() {
  map = new MapOfRun(section.querySelector("#map .frame canvas"));
  map.takeInput();
  offerTools(section.querySelector("#map"), map);
  time = new TimeBar(section.querySelector("#map .time"), (at) => map.setTime(at ?? end), "the end");
}

/** Shows the run whose paths begin with `base`, and whose reports are numbered `run`; an Error's message is the sentence to show. */
export async function lookAgain(base, title, run) {
  const head = section.querySelector("h2");
  say(head, `Opening ${title} …`); // a long run takes seconds
  section.hidden = false;
  head.focus();
  const paths = [`${base}/map`, `${base}/tracks`, `${base}/history`, `/adit/reports?run=${run}`, "/adit/run"];
  const [{ layers }, { tracks }, { attention }, reports, { colours }] = await Promise.all(paths.map((path) => get(path)));
  const times = [
    ...layers.flatMap(({ first, last }) => [first, last]),
    ...tracks.flatMap(({ poses }) => [poses[0][0], poses.at(-1)[0]]),
    ...reports.map(({ received }) => received),
  ];
  const first = times.length ? times.reduce((a, b) => Math.min(a, b)) : null;
  end = times.reduce((a, b) => Math.max(a, b), 0);
  say(head, title);
  if (!map) offer();
  map.lookAgain(base, { reports: [...reports].reverse(), run_number: run, now: end, colours });
  showTools({ robots: tracks.map(({ robot }) => ({ name: robot })) });
  time.stretch(first, end, {
    reports: reports.map((report) => ({ at: report.received, level: life(report).level })),
    alarms: attention.filter(({ came }) => came).map(({ at }) => ({ at, level: "bad" })),
  });
  time.goLive();
}

export function leave() {
  time?.play(false);
  section.hidden = true;
}

section.querySelector(".leave").addEventListener("click", () => {
  leave();
  document.getElementById("runs-title").scrollIntoView();
});
