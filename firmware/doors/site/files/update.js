// The box's versions: which runs, an update of it, the way out of a slot that nobody meant, the restart.
import { tellCard } from "./card.js";
import { confirmed } from "./dialog.js";
import { get, oneAtATime, post } from "./session.js";

const restartPlace = document.getElementById("restart");
const [restartNote, restarted] = restartPlace.querySelectorAll("p"), restart = restartPlace.querySelector("button");
const MEANING = "The restart takes about a minute. Robots must post again what they post meanwhile. Reports stay; queued maps, states and markers are lost.";

/** If the box cannot restart itself, it says why, and what to do. */
function showRestart({ managed, why, doing, runs_here: runsHere }, operator) {
  restartPlace.hidden = !runsHere;
  restartNote.textContent = managed ? MEANING : `This page cannot restart the box: ${why}. To restart it now, switch the box off and on.`;
  restart.hidden = !operator || !managed;
  restart.disabled = Boolean(doing);
  if (doing === "restarting") restarted.textContent = "The box is restarting.";
  if (doing === "restarting") tellCard(restartPlace, "The box is restarting", "wait");
  else tellCard(restartPlace, managed ? "Takes about a minute" : "Not from this page");
}

/** Asks first, and again where a report is under way: what the box says of it is what is asked. `done`: what is shown then. */
async function restartBy(path, question, place, done) {
  const sure = (text) => confirmed({ ...question, text });
  place.textContent = "";
  place.dataset.bad = false;
  if (!(await sure(question.text))) return;
  try {
    await post(path).catch(async (error) => {
      if (error.status !== 409) throw error;
      if (await sure(`${error.message}.`)) return post(path, { anyway: true });
      throw new Error("The box was not restarted.");
    });
    place.textContent = done;
  } catch (error) {
    place.textContent = error.message;
    place.dataset.bad = true;
  }
}
const RESTART = { title: "Restart the box?", text: MEANING, word: "Restart" };
const restartIt = () => restartBy("/adit/update/restart", RESTART, restarted, "The box is restarting.");

const strayed = document.querySelector("#update .stray"), [whyStrayed, leaving] = strayed.querySelectorAll("p");
const [goBack, stay] = strayed.querySelectorAll("button");

/** Another slot runs than the one that was good last: why, and both ways on. */
function showStray({ stray, slot, doing }, operator) {
  strayed.hidden = !stray;
  whyStrayed.textContent = stray ? `An unexpected slot is running: ${stray}.` : "";
  for (const button of [goBack, stay]) button.hidden = !operator || Boolean(doing);
  stay.textContent = `Stay with slot ${slot}`;
}

const GO_BACK = { title: "Go back to the slot that was good last?", text: MEANING, word: "Go back" };
const goBackIt = () => restartBy("/adit/update/back", GO_BACK, leaving, "The box is restarting.");

async function stayIt() {
  const text = "The box then starts the version that runs now, and returns to it if an update fails.";
  if (!(await confirmed({ title: `${stay.textContent}?`, text, word: "Stay" }))) return;
  await post("/adit/update/stay").then(() => (leaving.textContent = ""), (error) => {
    leaving.textContent = error.message;
    leaving.dataset.bad = true;
  });
}

const STAGES = { installing: "is being installed", interrupted: "was interrupted", installed: "is used after a restart", left: "was left", good: "came up healthy" };

const lastOf = ({ last, trial }) => (last ? `${last.version} ${trial ? "is on trial" : STAGES[last.stage] ?? last.stage}` : "");

/** The card's line, and its level. */
function stateOf(view, trouble) {
  const { managed, version, slot, doing, progress, stray, stick, trial, last, newer, runs_here: runsHere } = view;
  if (stray) return ["An unexpected slot is running", "bad"];
  if (doing) return [`${doing[0].toUpperCase()}${doing.slice(1)}${progress === null ? "" : `, ${progress} %`}`, "wait"];
  if (trouble) return ["The update was rejected", "bad"];
  if (!managed) return [newer ? `apt has ${newer}` : runsHere ? "Not from this page" : "By apt"];
  const its = lastOf(view) || (stick ? `${stick.version} is on the stick` : "no update");
  return [`Slot ${slot}, ${version}; ${its}`, trial || last?.stage === "installed" ? "wait" : "quiet"];
}

export async function offerUpdate(operator) {
  const section = document.getElementById("update"), bar = section.querySelector("progress");
  const [file, install, stick] = section.querySelectorAll(".install > *, input");
  const [told, outcome] = section.querySelectorAll(".body > p");
  let timer, trouble = ""; // of the last press, until the next
  function sayOutcome(doing = null, refusal = null) {
    const bad = trouble || refusal;
    outcome.textContent = doing ? `The box is ${doing}.` : bad ?? "";
    outcome.dataset.bad = !doing && Boolean(bad);
  }
  function show(view) {
    const { managed, why, version, slot, doing, progress, refusal, last, stick: offer, stick_why: unfit, newer, newer_why: notKnown } = view;
    const ofApt = newer ? `apt has ${newer}. To install it, run "apt upgrade" on this machine.` : notKnown && `The newer version of apt is not known: ${notKnown}.`;
    section.hidden = !view.runs_here && !ofApt;
    const end = last && `${lastOf(view)}${last.why && `: ${last.why}`}`;
    told.textContent = managed ? [`${version}, slot ${slot}`, end, unfit].filter(Boolean).join(". ") : view.runs_here ? why : ofApt;
    sayOutcome(doing, refusal);
    tellCard(section, ...stateOf(view, trouble || refusal));
    bar.hidden = !doing;
    if (progress !== null) bar.value = progress;
    for (const node of [file, install, stick]) node.hidden = !operator || !managed || Boolean(doing);
    stick.hidden ||= !offer;
    if (offer) stick.textContent = `Install ${offer.version} from the stick`;
    showStray(view, operator);
    showRestart(view, operator);
  }
  async function look() {
    clearTimeout(timer);
    await get("/adit/update").then(show, () => {});
    timer = setTimeout(look, 2000);
  }
  const act = oneAtATime(async (action) => {
    trouble = "";
    look();
    await action().catch((error) => {
      trouble = error.message;
      sayOutcome();
    });
    await look();
  });
  install.addEventListener("click", () => file.files[0] && act(() => post("/adit/update", file.files[0])));
  stick.addEventListener("click", () => act(() => post("/adit/update/stick")));
  restart.addEventListener("click", restartIt);
  goBack.addEventListener("click", goBackIt);
  stay.addEventListener("click", () => stayIt().then(look));
  look();
}
