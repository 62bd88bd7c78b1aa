// The support bundle, the factory reset, and what the box is made of.
import { tellCard } from "./card.js";
import { open } from "./dialog.js";
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
    outcome.textContent = "The box packs the bundle.";
    try {
      const file = await getFile("/adit/bundle");
      save(file);
      outcome.textContent = `Downloaded ${file.name}, ${bytes(file.blob.size)}.`;
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
    const facts = [
      ["Version", version],
      ["Build", build],
      ["Licence", licence],
      ["Running for", age(uptime)],
      ["Kernel", kernel],
      ["Machine", model],
      ["Board", board?.title],
    ];
    section.querySelector("dl").replaceChildren(...facts.filter(([, value]) => value).map(([name, value]) => fact(name, value)));
    tellCard(section, [`Adit ${version}`, model].filter(Boolean).map((each) => clip(each, 60)).join(", "));
    section.querySelector("tbody").replaceChildren(...parts.map(part));
  } catch (error) {
    section.querySelector(".trouble").textContent = error.message;
    tellCard(section, "Not known", "bad");
  }
}
