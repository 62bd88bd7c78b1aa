// The box's own two addresses: changed for now, and for good only once that is confirmed from the new one.
import { fromTo, reviewed } from "./apply.js";
import { make, say } from "./dom.js";
import { blame, labelled } from "./field.js";
import { left, told } from "./pending.js";
import { post } from "./session.js";

const PAUSE = 300; // ms without a key
const form = document.getElementById("addresses");
const state = form.querySelector(".state"), outcome = form.querySelector(".outcome"), warned = form.querySelector(".warnings");
const pendingPlace = document.getElementById("pending"), change = form.querySelector(".try");
const FIELDS = [
  ["team.address", "Address", "Robots and stations post here."],
  ["team.prefix", "Prefix length", "24 stands for 255.255.255.0."],
  ["command_post.address", "Address", "The box’s own on the Command Post’s network, not an endpoint’s."],
  ["command_post.prefix", "Prefix length", "16 stands for 255.255.0.0."],
  ["command_post.gateway", "Gateway", "The way to endpoints outside of that subnet; empty: none."],
];
const fields = new Map();
let isTyped = false, asked = 0, timer = 0;

const valueAt = (network, path) => path.split(".").reduce((value, name) => value?.[name], network) ?? "";

/** What is typed, as the box takes it. */
function wanted() {
  const of = (path) => fields.get(path).control.value.trim();
  const whole = (path) => (/^\d{1,3}$/.test(of(path)) ? Number(of(path)) : of(path));
  return {
    team: { address: of("team.address"), prefix: whole("team.prefix") },
    command_post: { address: of("command_post.address"), prefix: whole("command_post.prefix"), gateway: of("command_post.gateway") },
  };
}

function report(text, bad = false) {
  outcome.dataset.bad = bad;
  say(outcome, text);
}

async function check() {
  const mine = ++asked;
  const verdict = await post("/adit/network/check", wanted());
  if (mine !== asked) return null;
  const left = verdict.errors.filter(({ path }) => !fields.has(path));
  for (const [path, field] of fields) blame(field, verdict.errors.filter((error) => error.path === path).map(({ what }) => what).join("; "));
  warned.replaceChildren(...left.map(({ path, what }) => make("li", `${path}: ${what}`)), ...verdict.warnings.map((warning) => make("li", warning)));
  return verdict;
}

function typed() {
  isTyped = true;
  report("");
  clearTimeout(timer);
  timer = setTimeout(() => check().catch((error) => report(`${error.message} What you typed is kept.`, true)), PAUSE);
}

async function tryIt() {
  clearTimeout(timer);
  const verdict = await check();
  if (!verdict) return;
  if (verdict.errors.length) {
    const field = fields.get(verdict.errors[0].path);
    return field?.control.focus();
  }
  if (!verdict.changes.length) return report("The box has these addresses already.");
  const yes = await reviewed({
    title: "Change the addresses for now?",
    text: "It takes itself back unless it is confirmed in time, from the new address.",
    changes: fromTo(verdict.changes),
    warnings: verdict.warnings,
    word: "Change for now",
  });
  if (!yes) return;
  told(await post("/adit/network", wanted()));
  isTyped = false;
  warned.replaceChildren();
  report("");
}

/** Does what a button says, and says what came of it. */
function on(button, deed) {
  button.addEventListener("click", async (event) => {
    event.preventDefault();
    button.disabled = true;
    await deed().catch((error) => report(error.message, true));
    button.disabled = false;
  });
}

function showPending(network) {
  const { pending } = network;
  pendingPlace.hidden = !pending;
  if (!pending) return;
  say(pendingPlace.querySelector(".left"), left(network));
  const url = `${pending.page}/setup#network`, where = pendingPlace.querySelector(".where"), isHere = new URL(url).host === location.host;
  const words = isHere ? "You are at the new address: confirm, and it is kept." : "Open the page at its new address and confirm it there: ";
  if (where.dataset.url === url) return;
  where.dataset.url = url;
  where.replaceChildren(words, ...(isHere ? [] : [Object.assign(make("a", url), { href: url })]));
}

/** How the last change ended. */
function lastOf({ last, last_why: why }) {
  if (!last) return "";
  return last === "confirmed" ? "The last change was confirmed." : `The last change was taken back${why ? `: ${why}` : ""}.`;
}

/** Shows what the box says of its network. */
export function showNetwork(network) {
  const isOperator = document.body.dataset.role === "operator";
  say(state, network.managed ? lastOf(network) : `The addresses are not set by this page: ${network.why}`);
  showPending(network);
  const barred = !network.managed || !isOperator || network.pending !== null;
  change.hidden = !network.managed || !isOperator;
  change.disabled = barred;
  for (const button of pendingPlace.querySelectorAll("button")) button.hidden = !isOperator;
  for (const [path, { control }] of fields) {
    control.readOnly = barred;
    if (!isTyped && document.activeElement !== control) control.value = valueAt(network, path);
  }
}

export function offerNetwork() {
  for (const [path, label, hint] of FIELDS) {
    const field = labelled(label, Object.assign(make("input"), { type: "text", inputMode: "decimal", autocomplete: "off", spellcheck: false }), hint);
    field.dataset.path = path;
    field.control.addEventListener("input", typed);
    fields.set(path, field);
    form.querySelector(`[data-side=${path.split(".")[0]}]`).append(field);
  }
  form.noValidate = true;
  form.addEventListener("submit", (event) => event.preventDefault());
  on(change, tryIt);
  on(pendingPlace.querySelector(".confirm"), async () => told(await post("/adit/network/confirm")));
  on(pendingPlace.querySelector(".back"), async () => told(await post("/adit/network/back")));
}
