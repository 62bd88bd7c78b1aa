// Who looks at this page, and how it says something to the box.

const GET_WITHIN = 15, POST_WITHIN = 30; // s; a box answers a report within 20 s
const SILENT = "The box does not answer.";

/** The signal that ends a request after so many seconds. */
// @ts-ignore: each browser of the floor has timeout()
export const after = (seconds) => AbortSignal.timeout(1000 * seconds);

/** The Error to show if no whole answer came; its `status` is 0. */
const silence = (sentence) => Object.assign(new Error(sentence), { status: 0 });

/** Throws what to show if no whole answer came; an Error that the box answered stays.
 *  @returns {never} */
function unanswered(error) {
  throw error.status ? error : silence(error.name === "TimeoutError" ? "The box did not answer in time." : SILENT);
}

/** For a catch: whether the error is the script's rather than the box's. failed.js shows it. */
export function isFault(error) {
  if (error.status === undefined) reportError(error);
  return error.status === undefined;
}

/** fetch() for a GET that ends in time. */
export const fetchSoon = (path, options = {}) => fetch(path, { signal: after(GET_WITHIN), ...options });

let asked = null;

/** {role: "operator", "viewer" or null (nobody is logged in), csrf, first_start}; asked for once, or `again`. */
export function session(again = false) {
  if (again || !asked) {
    asked = fetchSoon("/adit/session", { cache: "no-store" }).then(resultOf).catch(unanswered);
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

async function ask(path, signal) {
  const answer = await fetch(path, { cache: "no-store", signal });
  if (answer.status === 401) toLogin();
  ahead = Date.parse(answer.headers.get("Date")) - Date.now() || 0;
  return answer;
}

/** The JSON of a path; an Error's message is the sentence to show. */
export const get = (path, signal = after(GET_WITHIN)) => ask(path, signal).then(resultOf).catch(unanswered);

/** The file of a path: its name and its bytes. It may take any time, unless none of its bytes comes for 15 s. */
export async function getFile(path) {
  const stalled = new AbortController(), late = new DOMException("", "TimeoutError"), pieces = [];
  let timer;
  const goOn = () => {
    clearTimeout(timer);
    timer = setTimeout(() => stalled.abort(late), 1000 * GET_WITHIN);
  };
  goOn();
  try {
    const answer = await ask(path, stalled.signal);
    if (!answer.ok) await resultOf(answer); // throws
    const name = /filename="([^"]+)"/.exec(answer.headers.get("Content-Disposition"))?.[1] ?? "adit";
    const reader = answer.body.getReader();
    for (let piece; !(piece = await reader.read()).done; goOn()) pieces.push(piece.value);
    return { name, blob: new Blob(pieces, { type: answer.headers.get("Content-Type") }) };
  } catch (error) {
    return unanswered(error);
  } finally {
    clearTimeout(timer);
  }
}

/** Throws what to show if a POST has no answer: the box may have done what the POST asks for. */
function unknown(path, error) {
  if (error.status) throw error;
  const what = error.name === "TimeoutError" ? `No answer came within ${POST_WITHIN} s.` : SILENT;
  if (path === "/adit/reports") throw silence(`${what} The report may have been accepted: look at the list.`);
  throw silence(what === SILENT ? what : `${what} The box may have done it.`);
}

/** A file may take any time, because the box closes a connection that stalls. */
async function send(path, body, csrf) {
  const file = body instanceof Blob;
  const headers = { "Content-Type": file ? "application/octet-stream" : "application/json" };
  if (csrf) headers["Adit-CSRF"] = csrf;
  const request = { method: "POST", headers, ...(file ? { body } : { body: JSON.stringify(body), signal: after(POST_WITHIN) }) };
  return fetch(path, request).then(resultOf).catch((error) => unknown(path, error));
}

/** The JSON of an answer; throws the Error of one that is none. */
export async function resultOf(answer) {
  if (answer.ok) return answer.json();
  const said = await answer.json().catch(() => null);
  const sentence = typeof said === "string" ? said : `The box answered ${answer.status}.`;
  throw Object.assign(new Error(sentence), { status: answer.status, isBusy: answer.headers.has("Retry-After") });
}

/** Shows the role in `node`, which has a `.text` and a button to log out. */
export async function showWho(node) {
  const { role, csrf } = await session().catch(() => ({}));
  if (!role || !csrf) return;
  node.querySelector(".text").textContent = `Logged in as ${role}`;
  node.querySelector("button").addEventListener("click", async () => {
    await post("/adit/logout").catch(() => {}); // if that fails, the login says so
    toLogin();
  });
  node.hidden = false;
}
