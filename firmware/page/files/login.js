// The door: a password, or at the first start the code of the box and a new password.
import { post, session } from "./session.js";

const trouble = document.getElementById("trouble");

/** Where to go then: a page of this box, whatever the address says. */
function next() {
  try {
    const url = new URL(new URLSearchParams(location.search).get("next") || "/", location.origin);
    if (url.origin === location.origin) return url.href;
  } catch {} // no address at all
  return "/";
}

/** Shows a form, and does `deed` with its fields when it is sent. */
function show(form, deed) {
  const button = form.querySelector("button"), first = form.querySelector("input");
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    trouble.textContent = "";
    button.disabled = true;
    try {
      await deed(Object.fromEntries(new FormData(form)));
      location.replace(next());
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
  await post("/adit/password", { role: "operator", code, password });
  await logIn({ password });
}

async function begin() {
  const { role, first_start: firstStart } = await session();
  if (role) return location.replace(next());
  if (firstStart) show(document.getElementById("first"), setFirst);
  else show(document.getElementById("login"), logIn);
}

begin().catch(() => {
  trouble.textContent = "The box does not answer.";
  setTimeout(() => location.reload(), 2000);
});
