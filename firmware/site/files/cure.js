// The setting that would have a refused message taken: the box names it in its sentence.
import { get } from "./session.js";

let keys = null; // of all settings, asked for once there is a refusal

async function learn() {
  keys = [];
  try {
    const said = await get("/adit/settings");
    keys = said.keys.map(({ path }) => path).filter((path) => /^\w+(\[\])?(\.\w+)+$/.test(path)); // a lone word says nothing
  } catch {
    keys = null; // asked for again with the next event
  }
}

/** The key that a sentence names, or "". What it quotes is its sender's word, not the box's. */
export function cureOf(sentence) {
  if (!keys) {
    learn();
    return "";
  }
  const words = sentence.replace(/"(\\.|[^"\\])*"?/g, " ").split(/[^\w.[\]]+/).map((word) => word.replace(/\.+$/, ""));
  return keys.find((key) => words.includes(key)) ?? "";
}

/** A list has a step of its own. */
export const wayTo = (key) => (key.includes("[") ? `/setup#${key.split("[")[0]}` : `/setup?setting=${key}#all`);
