// A report's history and the answer that is kept, asked for when its row is opened and when it moved on.
import { make } from "./dom.js";
import { fetchSoon } from "./session.js";
import { clip, timeOfDay } from "./words.js";

export async function showHistory(node, { number, changed }) {
  if (node.dataset.of === String(changed)) return;
  node.dataset.of = String(changed);
  try {
    const answer = await fetchSoon(`/adit/reports/${number}`);
    if (!answer.ok) throw new Error();
    const { history, answer: said, sender } = await answer.json();
    const steps = history.map((step) => {
      const time = make("time", timeOfDay(step.at));
      return make("li", time, ` ${clip(step.state.replace("_", " "), 40)}`, step.note ? `: ${clip(step.note)}` : "");
    });
    node.replaceChildren(make("p", `From ${clip(sender, 60)}`), make("ol", ...steps));
    if (said) node.append(make("p", `Answer: ${clip(said)}`));
  } catch {
    node.dataset.of = ""; // asked for again with the next event
    node.replaceChildren(make("p", "The box does not send the history."));
  }
}
