// The support bundle, the factory reset, and what the box is made of.
import { confirmed, open } from "./dialog.js";
import { make } from "./dom.js";
import { get, getFile, post, sitOutReset } from "./session.js";
import { age, bytes, clip } from "./words.js";

function save({ name, blob }) {
  const link = make("a");
  link.download = name;
  link.href = URL.createObjectURL(blob);
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

export function offerBundle() {
  const section = document.getElementById("bundle");
  const button = section.querySelector("button"), outcome = section.querySelector(".outcome");
  button.addEventListener("click", async () => {
    button.disabled = true;
    outcome.dataset.bad = false;
    outcome.textContent = "It is being packed.";
    try {
      const file = await getFile("/adit/bundle");
      save(file);
      outcome.textContent = `${file.name}, ${bytes(file.blob.size)}`;
    } catch (error) {
      outcome.textContent = error.message;
      outcome.dataset.bad = true;
    }
    button.disabled = false;
  });
}

export function offerReset() {
  const dialog = document.getElementById("wipe"), form = dialog.querySelector("form");
  const trouble = form.querySelector(".trouble"), button = form.querySelector(".main");
  document.querySelector("#reset button").addEventListener("click", () => {
    form.reset();
    trouble.textContent = "";
    open(dialog);
  });
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    trouble.textContent = "";
    button.disabled = true;
    try {
      await post("/adit/reset", Object.fromEntries(new FormData(form)));
      button.textContent = "The box restarts";
      await sitOutReset();
    } catch (error) {
      trouble.textContent = error.message;
      button.disabled = false;
    }
  });
}

const fact = (name, value) => make("div", make("dt", name), make("dd", clip(value, 120)));

const part = ({ name, version, licence }) => {
  const title = make("th", name);
  title.scope = "row";
  return make("tr", title, make("td", version), make("td", licence));
};

export async function showAbout() {
  const section = document.getElementById("about");
  try {
    const { version, build, licence, uptime, kernel, model, board, parts } = await get("/adit/about");
    const facts = [["Version", version], ["Build", build], ["Licence", licence], ["Running for", age(uptime)], ["Kernel", kernel], ["Machine", model], ["Board", board?.title]];
    section.querySelector("dl").replaceChildren(...facts.filter(([, value]) => value).map(([name, value]) => fact(name, value)));
    section.querySelector("tbody").replaceChildren(...parts.map(part));
  } catch (error) {
    section.querySelector(".trouble").textContent = error.message;
  }
}

const restartPlace = document.getElementById("restart");
const [restartNote, restarted] = restartPlace.querySelectorAll("p"), restart = restartPlace.querySelector("button");
const MEANING = "It takes about a minute. Robots that post meanwhile have to post again; what the box has taken is kept.";

/** Where the box cannot restart itself it says why, and what to do. */
function showRestart({ managed, why, doing }, operator) {
  restartNote.textContent = managed ? MEANING : `This page cannot restart the box (${why.split(":")[0]}). Switch it off and on.`;
  restart.hidden = !operator || !managed;
  restart.disabled = Boolean(doing);
  if (doing === "restarting") restarted.textContent = "The box is restarting.";
}

/** Asks first, and again where a report is under way: what the box says of it is what is asked. */
async function restartIt() {
  const sure = (text) => confirmed({ title: "Restart the box?", text, word: "Restart" });
  restarted.textContent = "";
  restarted.dataset.bad = false;
  if (!(await sure(MEANING))) return;
  try {
    await post("/adit/update/restart").catch(async (error) => {
      if (error.status !== 409) throw error;
      if (await sure(`${error.message}.`)) return post("/adit/update/restart", { anyway: true });
      throw new Error("The box was not restarted.");
    });
    restarted.textContent = "The box is restarting.";
  } catch (error) {
    restarted.textContent = error.message;
    restarted.dataset.bad = true;
  }
}

const STAGES = { installed: "waits for a restart", good: "came up healthy" };

export async function offerUpdate(operator) {
  const section = document.getElementById("update"), bar = section.querySelector("progress");
  const [file, install, stick] = section.querySelectorAll("input, button");
  const [told, outcome] = section.querySelectorAll("p");
  let timer;
  function show({ managed, why, version, slot, doing, progress, refusal, trial, last, stick: offer, stick_why: unfit }) {
    const end = last && `${last.version} ${trial ? "is on trial" : STAGES[last.stage] ?? last.stage}${last.why && `: ${last.why}`}`;
    told.textContent = managed ? [`${version}, slot ${slot}`, end, unfit].filter(Boolean).join(". ") : why;
    outcome.textContent = doing ? `The box is ${doing}.` : refusal ?? "";
    outcome.dataset.bad = !doing && Boolean(refusal);
    bar.hidden = !doing;
    if (progress !== null) bar.value = progress;
    for (const node of [file, install, stick]) node.hidden = !operator || !managed || Boolean(doing);
    stick.hidden ||= !offer;
    if (offer) stick.textContent = `Install ${offer.version} from the stick`;
    showRestart({ managed, why, doing }, operator);
  }
  async function look() {
    clearTimeout(timer);
    await get("/adit/update").then(show, () => {});
    timer = setTimeout(look, 2000);
  }
  function act(action) {
    look();
    action().then(look, (error) => {
      clearTimeout(timer);
      timer = setTimeout(look, 9000);
      outcome.textContent = error.message;
      outcome.dataset.bad = true;
    });
  }
  install.addEventListener("click", () => file.files[0] && act(() => post("/adit/update", file.files[0])));
  stick.addEventListener("click", () => act(() => post("/adit/update/stick")));
  restart.addEventListener("click", restartIt);
  look();
}
