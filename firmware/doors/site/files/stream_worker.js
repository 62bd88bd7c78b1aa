// A shared worker: the tabs of one browser that follow the same URL, which is the worker's name, have one stream.

import { patched } from "./patched.js";
import { follow } from "./stream.js";

const MOST_UNANSWERED = 100; // messages: 25 s at the box's fastest

const unanswered = new Map(); // by the port of each tab
let end = null, view = null, lost = null, heardAt = 0;

/** A tab that is closed, or that the browser has frozen, answers no more. If it goes on, it follows alone. */
function leave(port) {
  port.close();
  unanswered.delete(port);
  if (unanswered.size) return;
  end();
  end = view = lost = null;
}

function tell(message) {
  if (message.lost) lost = message;
  else [view, lost, heardAt] = [message.view ?? patched(view, message.patch), null, performance.now()];
  for (const [port, count] of unanswered) {
    unanswered.set(port, count + 1);
    if (count < MOST_UNANSWERED) port.postMessage(message);
    else leave(port);
  }
}

addEventListener("connect", ({ ports: [port] }) => {
  unanswered.set(port, 0);
  port.onmessage = () => unanswered.set(port, 0);
  if (view) port.postMessage({ view, age: performance.now() - heardAt });
  if (lost) port.postMessage(lost);
  end ??= follow(name, tell);
});
