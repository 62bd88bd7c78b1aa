// The door: a password, or a new one: at the first start with the code of the box, without while set-up is open.
import "./presses.js";
import { missingTokens } from "./draft.js";
import { warnOfClearText } from "./https.js";
import { get, isFault, post, session } from "./session.js";

const trouble = document.getElementById("trouble");

/** Where to go then: a page of this box, whatever the address says. */
function next() {
  try {
    const url = new URL(new URLSearchParams(location.search).get("next") || "/", location.origin);
    if (url.origin === location.origin) return url.href;
  } catch {} // no address at all
  return "/";
}

/** To the set-up where nothing can go up yet, or all is as it was given; else where he wanted to go. */
async function goOn(isFirst) {
  const wanted = next();
  if (wanted !== `${location.origin}/` || (await session(true)).role !== "operator") return location.replace(wanted);
  const said = await get("/adit/settings").catch(() => null);
  const isReady = !said || (missingTokens(said).length === 0 && (said.saved || !isFirst));
  location.replace(isReady ? wanted : "/setup");
}

/** Shows a form, and does `action` with its fields when it is sent. */
function show(form, action) {
  const button = form.querySelector("button"), first = form.querySelector("input");
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    trouble.textContent = "";
    button.disabled = true;
    try {
      await action(Object.fromEntries(new FormData(form)));
      await goOn(form.id === "first");
    } catch (error) {
      trouble.textContent = error.message;
      button.disabled = false;
      first.select();
    }
  });
  form.hidden = false;
  first.focus();
}

const logIn = ({ password }) => post("/adit/login", { password });

async function setFirst({ code, password, again }) {
  if (password !== again) throw new Error("The two new passwords differ.");
  await post("/adit/password", { role: "operator", code: code?.replaceAll(" ", ""), password });
  await logIn({ password });
}

async function begin() {
  const { role, first_start: firstStart, set_up_open: isOpen } = await session();
  if (role) return location.replace(next());
  await warnOfClearText(document.getElementById("clear"));
  const first = document.getElementById("first");
  if (isOpen) for (const each of first.querySelectorAll(".code")) each.remove();
  if (firstStart || isOpen) show(first, setFirst);
  if (!firstStart) show(document.getElementById("login"), logIn);
}

begin().catch((error) => {
  if (isFault(error)) return;
  trouble.textContent = "The box does not answer.";
  setTimeout(() => location.reload(), 2000);
});
