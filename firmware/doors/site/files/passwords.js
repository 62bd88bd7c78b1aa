// Sets and removes passwords, and shows the errors that the box finds in them.
import { post } from "./session.js";

const DONE = {
  operator: "Changed. All other operators must log in again.",
  viewer: "Set. All viewers must log in again.",
  removed: "Removed. Viewers cannot log in.",
};

/** Does one action of a form, and says what came of it. */
async function attempt(form, action) {
  const outcome = form.querySelector(".outcome"), buttons = form.querySelectorAll("button");
  const say = (text, bad) => {
    outcome.textContent = text;
    outcome.dataset.bad = bad;
  };
  say("", false);
  for (const button of buttons) button.disabled = true;
  try {
    say(await action(), false);
    form.reset();
  } catch (error) {
    say(error.message, true);
  }
  for (const button of buttons) button.disabled = false;
}

async function set(role, { current, password, again }) {
  if (!current) throw new Error("The operator’s present password is missing.");
  if (password !== again) throw new Error("The two new passwords differ.");
  await post("/adit/password", { role, current, password });
  return DONE[role];
}

async function remove({ current }) {
  if (!current) throw new Error("The operator’s present password is missing.");
  await post("/adit/password", { role: "viewer", current, password: null });
  return DONE.removed;
}

export function offerPasswords() {
  for (const form of document.getElementById("passwords").querySelectorAll("form")) {
    const fields = () => /** @type {any} */ (Object.fromEntries(new FormData(form)));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      attempt(form, () => set(form.dataset.role, fields()));
    });
    form.querySelector(".remove")?.addEventListener("click", () => attempt(form, () => remove(fields())));
  }
}
