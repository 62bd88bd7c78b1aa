// Settings from a file: checked by the box, shown, and only then applied.
import { fromTo, reviewed, save } from "./apply.js";
import { make, say } from "./dom.js";
import { differs } from "./draft.js";
import { post } from "./session.js";

const section = document.getElementById("step-file");
const input = section.querySelector("input"), outcome = section.querySelector(".outcome"), wrong = section.querySelector(".warnings");
const MOST = 250_000; // bytes; the box takes a little more

function report(text, errors = []) {
  outcome.dataset.bad = text !== "Applied.";
  say(outcome, text);
  wrong.replaceChildren(...errors.map(({ path, what }) => make("li", `${path}: ${what}`)));
}

async function read(file) {
  if (file.size > MOST) throw new Error("That is too long for a file of settings.");
  try {
    return JSON.parse(await file.text());
  } catch {
    throw new Error("That is no JSON, and so no file of settings.");
  }
}

async function take(file) {
  const settings = await read(file);
  const { errors, changes, warnings } = await post("/adit/settings/check", { settings });
  if (errors.length) return report("Nothing was applied: the file has errors.", errors);
  if (!changes.length) return report("Nothing to apply: the box runs with the same settings.");
  const text = differs() ? "What you typed and did not apply is dropped." : "";
  if (!(await reviewed({ title: `Apply ${file.name}?`, text, changes: fromTo(changes), warnings, word: "Apply" }))) return report("Nothing was applied.");
  report("");
  if (await save(settings)) report("Applied.");
}

export function offerImport() {
  input.addEventListener("change", async () => {
    const [file] = input.files;
    if (!file) return;
    report("");
    await take(file).catch((error) => report(error.message));
    input.value = "";
  });
}
