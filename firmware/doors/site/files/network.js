// The box's own addresses: changed for now, and for good only once that is confirmed from the new one.
import { fromTo, insist, reviewed } from "./apply.js";
import { make, say } from "./dom.js";
import { blame, labelled, reveal } from "./field.js";
import { atThisScheme } from "./https.js";
import { label, nameOf, spoken } from "./names.js";
import { left, told } from "./pending.js";
import { post } from "./session.js";

const PAUSE = 300; // ms without a key
const form = document.getElementById("addresses");
const state = form.querySelector(".state"), outcome = form.querySelector(".outcome"), warned = form.querySelector(".warnings");
const pendingPlace = document.getElementById("pending"), change = form.querySelector(".try");
const MODE = "team.mode";
const FIELDS = [
  [MODE, "Mode", "With dhcp or link-local, find the box by its name: adit.local on the appliance."],
  ["team.address", "Address", "Robots and stations post to this address, such as 10.0.0.1/24."],
  ["command_post.addresses", "Addresses", "The box’s own addresses, not an endpoint’s, such as 10.100.1.10/24. Commas separate them."],
  ["command_post.gateway", "Gateway", "The router to endpoints outside these subnets. Empty: no gateway."],
];
const fields = new Map();
let isTyped = false, asked = 0, timer = 0;

const text = ({ address, prefix }) => (address ? `${address}/${prefix}` : "");
const host = (typed) => {
  const [address, prefix = ""] = typed.trim().split("/");
  return { address, prefix: /^\d{1,3}$/.test(prefix) ? Number(prefix) : prefix };
};
/** What the fields show of a network, and the network that they show. */
const shown = ({ team, command_post: post }) => [team.mode, text(team), post.addresses.map(text).join(", "), post.gateway];
function wanted() {
  const [mode, address, addresses, gateway] = [...fields.values()].map(({ control }) => control.value.trim());
  return {
    team: { mode, ...(mode === "static" && host(address)) },
    command_post: { addresses: addresses ? addresses.split(",").map(host) : [], gateway },
  };
}
const fieldAt = (path) => [...fields].find(([own]) => path.replace("prefix", "address").startsWith(own))?.[1];

function report(text, bad = false) {
  outcome.dataset.bad = bad;
  say(outcome, text);
}

async function check() {
  const mine = ++asked;
  const findings = await insist(() => post("/adit/network/check", wanted()));
  if (mine !== asked) return null;
  const left = findings.errors.filter(({ path }) => !fieldAt(path));
  for (const field of fields.values()) {
    const errors = findings.errors.filter(({ path }) => fieldAt(path) === field);
    blame(field, errors.map(({ what }) => what).join(". "));
  }
  const sentences = [...left.map(({ path, what }) => `${nameOf(path)}: ${what}`), ...findings.warnings.map(spoken)];
  warned.replaceChildren(...sentences.map((sentence) => make("li", sentence)));
  return findings;
}

function typed() {
  isTyped = true;
  showMode();
  report("");
  clearTimeout(timer);
  timer = setTimeout(() => check().catch((error) => report(`${error.message} Your changes are kept.`, true)), PAUSE);
}

async function tryIt() {
  clearTimeout(timer);
  const findings = await check();
  if (!findings) return;
  for (const field of fields.values()) reveal(field);
  if (findings.errors.length) {
    return fieldAt(findings.errors[0].path)?.control.focus();
  }
  if (!findings.changes.length) return report("The box already has these addresses.");
  const yes = await reviewed({
    title: "Change the addresses for now?",
    text: "The box returns to the old addresses unless you confirm in time from the new address.",
    changes: fromTo(findings.changes),
    warnings: findings.warnings,
    word: "Change for now",
  });
  if (!yes) return;
  told(await post("/adit/network", wanted()));
  isTyped = false;
  warned.replaceChildren();
  report("");
}

/** Does what a button says, and says what came of it. */
function on(button, action) {
  button.addEventListener("click", async (event) => {
    event.preventDefault();
    button.disabled = true;
    await action().catch((error) => report(error.message, true));
    button.disabled = false;
  });
}

function showPending(network) {
  const { pending } = network;
  pendingPlace.hidden = !pending;
  if (!pending) return;
  say(pendingPlace.querySelector(".left"), left(network));
  const url = atThisScheme(`${pending.page}/setup#network`), where = pendingPlace.querySelector(".where"), isHere = new URL(url).host === location.host;
  const words = isHere ? "You are at the new address. Confirm to keep it." : "Open the page at the new address and confirm there: ";
  if (where.dataset.url === url) return;
  where.dataset.url = url;
  where.replaceChildren(words, ...(isHere ? [] : [Object.assign(make("a", url), { href: url })]));
}

/** How the last change ended. */
function lastOf({ last, last_why: why }) {
  if (!last) return "";
  return last === "confirmed" ? "The last change was confirmed." : `The last change was reverted${why ? `: ${why}` : ""}.`;
}

/** Shows what the box says of its network. */
export function showNetwork(network) {
  const isOperator = document.body.dataset.role === "operator";
  const why = network.runs_here ? `This page cannot change the addresses: ${spoken(network.why)}` : "This machine’s own settings have its addresses.";
  say(state, network.managed ? lastOf(network) : why);
  for (const part of document.querySelectorAll("#addresses fieldset, #step-network [data-fields]")) part.hidden = !network.runs_here;
  showPending(network);
  const barred = !network.managed || !isOperator || network.pending !== null;
  change.hidden = !network.managed || !isOperator;
  change.disabled = barred;
  for (const button of pendingPlace.querySelectorAll("button")) button.hidden = !isOperator;
  [...fields.values()].forEach(({ control }, at) => {
    control.disabled = barred;
    if (!isTyped && document.activeElement !== control) control.value = shown(network)[at];
  });
  showMode();
}

const showMode = () => (fields.get("team.address").hidden = fields.get(MODE).control.value !== "static");

export function offerNetwork() {
  for (const [path, name, hint] of FIELDS) {
    label(path, `${path.startsWith("team") ? "Team’s side" : "Command Post’s side"}: ${name.toLowerCase()}`);
    const control = path === MODE ? make("select", ...["static", "dhcp", "link-local"].map((mode) => make("option", mode)))
      : Object.assign(make("input"), { type: "text", autocomplete: "off", spellcheck: false });
    const field = labelled(name, control, hint);
    field.dataset.path = path;
    control.addEventListener("input", typed);
    fields.set(path, field);
    form.querySelector(`[data-side=${path.split(".")[0]}]`).append(field);
  }
  form.noValidate = true;
  form.addEventListener("submit", (event) => event.preventDefault());
  on(change, tryIt);
  on(pendingPlace.querySelector(".confirm"), async () => told(await post("/adit/network/confirm")));
  on(pendingPlace.querySelector(".back"), async () => told(await post("/adit/network/revert")));
}
