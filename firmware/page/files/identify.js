// Makes the lights of this box flash, to tell it from others.
import { barred } from "./deeds.js";
import { say } from "./dom.js";
import { post } from "./session.js";

const SECONDS = 10;
const button = document.querySelector("button.identify");
const outcome = document.getElementById("identified");

button.addEventListener("click", async () => {
  if (barred()) return;
  say(outcome, "");
  await post("/adit/identify", { seconds: SECONDS }).catch((error) => say(outcome, error.message));
});

export function showIdentify({ identify_until }, now) {
  const left = identify_until === null ? 0 : Math.ceil(identify_until - now);
  say(button, left > 0 ? `Flashing, ${left} s` : "Identify");
  button.disabled = Boolean(barred());
}
