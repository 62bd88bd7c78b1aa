// Who looks at this page, and how it says something to the box.

let asked = null;

/** {role: "operator", "viewer" or null (nobody is logged in), csrf, first_start}; asked for once, or `again`. */
export function session(again = false) {
  if (again || !asked) {
    asked = fetch("/adit/session", { cache: "no-store" }).then(resultOf);
    asked.catch(() => (asked = null));
  }
  return asked;
}

let sitsOut = false, leaves = false;

/** Asks for a password, and comes back here afterwards. However many hear that nobody is logged in, the page leaves once. */
export function toLogin() {
  if (sitsOut || leaves) return;
  leaves = true;
  const here = location.pathname + location.search + location.hash;
  location.replace(`login.html?next=${encodeURIComponent(here)}`);
}

/** To the login where the box answers and says that nobody is logged in. */
export async function checkSession() {
  const { role } = await session(true).catch(() => ({}));
  if (role === null) toLogin();
}

/** Stays until the box, which was reset, has restarted: before, no page could be loaded whole. Then to its login. */
export async function sitOutReset() {
  sitsOut = true;
  for (const end = performance.now() + 15_000; performance.now() < end; ) {
    await new Promise((resolve) => setTimeout(resolve, 250));
    const { first_start: firstStart } = await session(true).catch(() => ({}));
    if (firstStart) break;
  }
  sitsOut = false;
  toLogin();
}

/** Posts `body` as JSON and gives the answer; an Error's message is the sentence to show, its `status` the box's. */
export async function post(path, body = {}) {
  const { csrf } = await session();
  try {
    return await send(path, body, csrf);
  } catch (error) {
    if (error.status === 401) toLogin();
    if (error.status !== 403) throw error;
    const { csrf: newer } = await session(true); // somebody logged in again, in another tab
    if (newer === csrf) throw error;
    return send(path, body, newer);
  }
}

/** `action`, one at a time: presses meanwhile do nothing. It should end by showing the box's new state, or the second press of a
 *  double click asks the box again if the first answer comes between the two. */
export function oneAtATime(action) {
  let isBusy = false;
  return async (...words) => {
    if (isBusy) return;
    isBusy = true;
    await action(...words).finally(() => (isBusy = false));
  };
}

let ahead = 0; // of this device's clock, in ms

/** The box's clock, in seconds since 1970: a phone's own may be anything. */
export const boxNow = () => (Date.now() + ahead) / 1000;

const SILENT = "The box does not answer.";

/** What a path gives, where it gives what is asked for; an Error's message is the sentence to show. */
async function ask(path, signal) {
  const answer = await fetch(path, { cache: "no-store", signal }).catch(() => Promise.reject(new Error(SILENT)));
  if (answer.status === 401) toLogin();
  ahead = Date.parse(answer.headers.get("Date")) - Date.now() || 0;
  return answer;
}

/** Its JSON. */
export const get = async (path, signal) => resultOf(await ask(path, signal));

/** It as a file: its name and its bytes. */
export async function getFile(path) {
  const answer = await ask(path);
  if (!answer.ok) await resultOf(answer); // throws
  const name = /filename="([^"]+)"/.exec(answer.headers.get("Content-Disposition"))?.[1] ?? "adit";
  return { name, blob: await answer.blob() };
}

async function send(path, body, csrf) {
  const file = body instanceof Blob;
  const headers = { "Content-Type": file ? "application/octet-stream" : "application/json" };
  if (csrf) headers["Adit-CSRF"] = csrf;
  const request = { method: "POST", headers, body: file ? body : JSON.stringify(body) };
  return resultOf(await fetch(path, request).catch(() => Promise.reject(new Error(SILENT))));
}

/** The JSON of an answer; throws the Error of one that is none. */
export async function resultOf(answer) {
  const said = await answer.json().catch(() => null);
  if (answer.ok) return said;
  const sentence = typeof said === "string" ? said : `The box answered ${answer.status}.`;
  throw Object.assign(new Error(sentence), { status: answer.status, isBusy: answer.headers.has("Retry-After") });
}

/** Shows the role in `node`, which has a `.text` and a button to log out. */
export async function showWho(node) {
  const { role, csrf } = await session().catch(() => ({}));
  if (!role || !csrf) return;
  node.querySelector(".text").textContent = `Logged in as ${role}`;
  node.querySelector("button").addEventListener("click", async () => {
    await post("/adit/logout").catch(() => {}); // where that fails, the login says so
    toLogin();
  });
  node.hidden = false;
}
