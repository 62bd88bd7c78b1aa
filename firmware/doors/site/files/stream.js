// The stream of the box's events, with a watchdog that notices silence. It runs in a page, and in the worker that pages share.

import { fetchSoon, resultOf } from "./session.js";

const SILENCE = 4500; // ms; the box says something every 2 s
const RETRY = 2000;

/** What the box says of an error that EventSource does not show: {trouble, status}. Both are missing if the box does not answer, or
 *  accepts a stream by now. */
async function explanationOf(url) {
  try {
    const answer = await fetchSoon(url);
    if (!answer.ok) await resultOf(answer); // throws
    answer.body.cancel();
    return {};
  } catch ({ status, message }) {
    return status ? { trouble: message, status } : {};
  }
}

/** Follows `url` until the function that it returns is called. Calls `tell` with {view} for a whole view, {patch} for a change of the
 *  view before, and {lost: true, trouble, status} as the line goes and every 2 s until the next view. */
export function follow(url, tell) {
  let source = null, last = performance.now(), tried = last, isLost = false, isEnded = false;

  const lose = async () => {
    isLost = true;
    const said = source.readyState === EventSource.CLOSED ? await explanationOf(url) : {};
    if (isLost && !isEnded) tell({ lost: true, ...said });
  };
  const hear = (message) => {
    last = performance.now();
    isLost = false;
    tell(message);
  };
  const open = () => {
    source?.close();
    source = new EventSource(url);
    let isWhole = false; // nothing of an earlier connection
    source.addEventListener("message", ({ data }) => {
      isWhole = true;
      hear({ view: JSON.parse(data) });
    });
    source.addEventListener("patch", ({ data }) => isWhole && hear({ patch: JSON.parse(data) }));
    source.onerror = lose;
  };

  // EventSource comes back by itself after a closed connection, but neither after an error answer nor from a
  // connection that has gone silent.
  const watchdog = setInterval(() => {
    const now = performance.now(), isClosed = source.readyState === EventSource.CLOSED, isSilent = now - last > SILENCE;
    const isDue = now - tried > RETRY && (isClosed || isSilent);
    if (isSilent && !isClosed && (isDue || !isLost)) lose();
    if (!isDue) return;
    tried = now;
    open();
  }, 250);
  open();
  return () => {
    isEnded = true;
    clearInterval(watchdog);
    source.close();
  };
}
