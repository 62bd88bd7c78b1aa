// The line to the box: server-sent events, and a watchdog that notices when they stop.

import { patched } from "./patched.js";
import { checkSession } from "./session.js";

const SILENCE = 4500;  // ms; the box says something every 2 s
const RETRY = 2000;

/** Follows the run: `show({view, time, lost})` for each view that comes (null: none came yet), as the line goes and
 *  comes back, and each second, for ages grow. `time` is the box's clock. Gives what shows it once more. */
export function follow(url, show) {
  let view = null, heardAt = 0, lost = false;
  const again = () => show({ view, lost, time: view && view.now + (performance.now() - heardAt) / 1000 });
  const heard = (next) => {
    view = next;
    heardAt = performance.now();
    again();
  };
  const lose = (isLost) => {
    lost = isLost;
    again();
  };
  listen(url, heard, lose);
  setInterval(again, 1000);
  return again;
}

/** Calls `heard(view)` for each view that comes, and `lost(true or false)` as the line goes and comes back. The box tells
 *  a view whole, and then what it changes by. */
function listen(url, heard, lost) {
  let source = null, last = performance.now(), isLost = false;

  const set = (value) => {
    if (isLost !== value) lost((isLost = value));
  };
  const open = () => {
    source?.close();
    source = new EventSource(url);
    let view = null; // nothing of an earlier connection
    const take = (next) => {
      last = performance.now();
      set(false);
      heard((view = next));
    };
    source.addEventListener("message", ({ data }) => take(JSON.parse(data)));
    source.addEventListener("patch", ({ data }) => view && take(patched(view, JSON.parse(data))));
    source.onerror = () => {
      set(true);
      if (source.readyState === EventSource.CLOSED) checkSession(); // an error answer: perhaps the session ended
    };
  };

  // EventSource comes back by itself after a closed connection, but neither after an error answer nor from a
  // connection that has gone silent.
  let tried = last;
  setInterval(() => {
    const now = performance.now();
    if (now - last > SILENCE) set(true);
    const dead = source.readyState === EventSource.CLOSED || now - last > SILENCE;
    if (dead && now - tried > RETRY) {
      tried = now;
      open();
    }
  }, 250);
  open();
}
