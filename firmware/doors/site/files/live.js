// The line to the box: views of the run, by a stream that all tabs of the browser share.

import { patched } from "./patched.js";
import { checkSession } from "./session.js";
import { follow as followStream } from "./stream.js";

const URGENT = ["alarms", "reports"]; // of a view
const SILENCE = 10; // s; the worker says something every 4.5 s, also while the box is silent

/** Follows the run: `show({view, time, lost, trouble, isUrgent})` each second, and at once (`isUrgent`) if reports or alarms changed or the
 *  line went or came back. `view`: the last one (null: none came yet); `time`: the box's clock; `trouble`: the box's sentence, if it
 *  answers with an error. Gives what shows it once more, at once. */
export function follow(url, show) {
  let view = null, heardAt = 0, lost = false, trouble = "";
  const again = (isUrgent = true) => show({ view, lost, trouble, isUrgent, time: view && view.now + (performance.now() - heardAt) / 1000 });
  const hear = (message) => {
    const before = { view, lost };
    lost = Boolean(message.lost);
    trouble = message.trouble ?? "";
    if (!lost) {
      view = message.view ?? patched(view, message.patch);
      heardAt = performance.now() - (message.age ?? 0);
    }
    if (lost || before.lost || URGENT.some((name) => view[name] !== before.view?.[name])) again();
    if (message.status) checkSession(); // perhaps the session ended
  };
  if (globalThis.SharedWorker) share(url, hear);
  else followShown(url, hear);
  setInterval(() => again(false), 1000);
  return () => again();
}

/** By the worker of all tabs. If its script does not come, as from a box that was updated since, or the worker ends: alone. */
function share(url, hear) {
  const worker = new SharedWorker("stream_worker.js", { name: url }), { port } = worker;
  let silence = 0; // in turns of the watchdog: none passes while the tab is frozen or the computer sleeps
  const part = () => {
    clearInterval(watchdog);
    port.close();
    followShown(url, hear);
  };
  const watchdog = setInterval(() => ++silence > SILENCE && part(), 1000);
  worker.onerror = part;
  port.onmessage = ({ data }) => {
    silence = 0;
    port.postMessage("heard");
    hear(data);
  };
}

/** A stream of this tab's own, while the tab is shown: browsers such as Chrome for Android have no shared workers. */
function followShown(url, hear) {
  let end = null;
  const turn = () => {
    end?.();
    end = document.hidden ? null : followStream(url, hear);
  };
  document.addEventListener("visibilitychange", turn);
  turn();
}
