// The spare box: this one standby and is exported, or takes over from another by its export.
import { tellCard } from "./card.js";
import { confirmed } from "./dialog.js";
import { make } from "./dom.js";
import { get, getFile, oneAtATime, post } from "./session.js";
import { showStick } from "./spare_stick.js";

const section = document.getElementById("spare");
const [note, outcome] = section.querySelectorAll(".body > p"), facts = section.querySelector("dl");
const form = section.querySelector("form"), file = section.querySelector("input[type=file]");
const buttons = Object.fromEntries([...section.querySelectorAll("[data-does]")].map((button) => [button.dataset.does, button]));
const EVERY = 2000, EVERY_OF_STICK = 300;
let timer, next = null; // where the page goes once the take-over moves it

function say(text, bad = false) {
  outcome.textContent = text;
  outcome.dataset.bad = bad;
}

const AT_WORK = "A spare box can take over from this one with all reports. Start standby on this box, carry its export to the spare, and unplug this box. A spare takes in the export here.";

function noteOf({ standby, why, asks_code: asksCode, taken_in: taken, takes_over: takesOver }) {
  if (takesOver) return "This box is taking over.";
  if (taken) return "Unplug the box that made this export before this box takes over.";
  if (asksCode) return "An export was imported. The box that made it shows the code during its standby.";
  if (standby) return `This box is on standby: ${why}. It accepts and sends no messages until you end the standby.`;
  return AT_WORK;
}

/** The card's line, and its level. */
function stateOf({ standby, asks_code: asksCode, taken_in: taken, takes_over: takesOver, stick }) {
  if (takesOver) return ["Taking over", "wait"];
  if (taken || asksCode) return ["An export was imported", "ask"];
  if (standby) return ["On standby", "wait"];
  return [stick?.exports.length ? "An export is on the stick" : "Not on standby"];
}

const whenOf = (seconds) => new Date(seconds * 1000).toLocaleString();

/** What is in an export, or the code of this box's own. */
function factsOf({ standby, code, taken_in: taken, takes_over: takesOver }) {
  if (takesOver) return [];
  if (taken) {
    const { name, version, at, reports, open, post: where, run, left_out: leftOut } = taken;
    return [
      ["Box", name],
      ["Adit", version],
      ["Standby since", `${whenOf(at)}, by its clock`],
      ["Reports", `${reports}, ${open} of them not finished`],
      ["Command Post", where],
      ["Score", run ? `${run.score}, ${run.remaining_reports} reports left` : "not known"],
      ...(leftOut.length ? [["Left out", `settings unknown to this box: ${leftOut.join(", ")}`]] : []),
    ];
  }
  return standby && code ? [["Code", code]] : [];
}

/** Nothing moves under a finger: what is there stays as it is, where it says the same. */
function showFacts(rows) {
  const key = JSON.stringify(rows);
  if (facts.dataset.key === key) return;
  facts.dataset.key = key;
  facts.hidden = !rows.length;
  facts.replaceChildren(...rows.flatMap(([name, value]) => {
    const pair = [make("dt"), make("dd")];
    [pair[0].textContent, pair[1].textContent] = [name, value];
    return pair;
  }));
}

function show(view) {
  const { standby, code, asks_code: asksCode, taken_in: taken, takes_over: takesOver, stick } = view;
  section.hidden = false;
  note.textContent = noteOf(view);
  tellCard(section, ...stateOf(view));
  showFacts(factsOf(view));
  const takes = Boolean(taken || asksCode);
  form.hidden = !asksCode || takesOver;
  file.hidden = takes || takesOver;
  showStick(view, takes, (name) => act(() => takeFromStick(name)));
  const free = stick && !stick.doing;
  const isServing = !standby && !takes, isOnStandby = standby && !takes, isExported = isOnStandby && code;
  const shown = {
    standby: isServing,
    standbyToStick: free && isServing,
    toStick: free && isExported,
    download: isExported,
    resume: isOnStandby,
    take: !takes,
    over: taken,
    forget: takes,
  };
  for (const [does, button] of Object.entries(buttons)) button.hidden = takesOver || !shown[does];
}

async function look() {
  clearTimeout(timer);
  const view = await get("/adit/spare").catch(() => null);
  if (view) show(view);
  else if (next && !next.isConnected) outcome.append(" The page moves to ", next);
  timer = setTimeout(look, view?.stick?.doing ? EVERY_OF_STICK : EVERY);
  return view;
}

async function download() {
  const { name, blob } = await getFile("/adit/spare/export");
  const link = make("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
  say("The export is downloaded. Note its code, and unplug this box before the spare takes over.");
}

/** The box ends what is under way, and is there again. */
async function untilOnStandby() {
  for (const end = performance.now() + 60_000; performance.now() < end; ) {
    const view = await look();
    if (view?.standby && view.code) return;
    await new Promise((resolve) => setTimeout(resolve, 300));
  }
  throw new Error("The box is not on standby yet.");
}

const sure = (title, text, word) => confirmed({ title, text, word });

/** Whether the box is on standby. */
async function startStandby() {
  const text = "On standby this box accepts and sends no messages, even after a power cut, until you end the standby. The export contains queued reports. Queued maps, states and markers stay here.";
  if (!(await sure("Start standby?", text, "Start and export"))) return false;
  say("Standby begins when the messages in flight are answered.");
  await post("/adit/spare/standby");
  await untilOnStandby();
  return true;
}

async function toStick() {
  await post("/adit/spare/to-stick");
  say("");
}

async function takeFromStick(name) {
  await post("/adit/spare/from-stick", { name });
  say("");
}

const DOES = {
  async standby() {
    if (await startStandby()) await download();
  },
  /** Not where nothing could be written: it would rest for nothing. */
  async standbyToStick() {
    const { stick } = await get("/adit/spare");
    if (stick.hindrance) return say(`The box does not start standby: ${stick.hindrance}.`, true);
    if (await startStandby()) await toStick();
  },
  toStick,
  download,
  async resume() {
    const text = "Only do this if no spare took over from this box. Otherwise a report may be sent twice.";
    if (!(await sure("End the standby?", text, "End standby"))) return;
    await post("/adit/spare/resume");
    say("The standby has ended.");
  },
  async take() {
    if (!file.files[0]) return say("Choose the export first.", true);
    await post("/adit/spare/take", file.files[0]);
    file.value = "";
    say("");
  },
  async over() {
    const text = "If the box that made the export is still plugged in, or its standby was ended since, a report may be sent twice.";
    if (!(await sure("Is the first box unplugged?", text, "It is: take over"))) return;
    const { taken_in: taken } = await post("/adit/spare/take-over", { unplugged: true });
    if (taken?.port && taken.port !== Number(location.port || 80)) next = Object.assign(make("a"), { href: location.href, port: taken.port });
    if (next) next.textContent = next.href;
    say("This box takes over with the settings of the first box. Then give it the first box’s addresses and cables.");
  },
  async forget() {
    await post("/adit/spare/forget");
    say("");
  },
};

const act = oneAtATime(async (does) => {
  try {
    await does();
  } catch (error) {
    say(error.message, true);
  }
  await look();
});

/** Where the box has no such thing, the section is not shown. */
export async function offerSpare() {
  for (const [does, button] of Object.entries(buttons)) button.addEventListener("click", () => act(DOES[does]));
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    act(async () => {
      await post("/adit/spare/open", { code: form.elements.code.value });
      form.reset();
      say("");
    });
  });
  look();
}
