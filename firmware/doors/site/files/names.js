// What a setting is called: by the label of its field, or in the words of its key.

import { grouped } from "./grouped.js";

const labels = new Map();
const LISTS = { "team.listen": "Listen address", robots: "Robot", courses: "Course" };
const UNITS = { ms: "ms", mbit: "Mbit/s", hz: "a second", bytes: "bytes", metres: "m", seconds: "s" };

const KNOWN = new Set(["command_post", "team", "robots", "courses", "network", "page", "clock", "reports", "queues", "runs", "alarms", "rules", "panel"]);

/** A field's label is what its setting is called everywhere. */
export const label = (path, text) => labels.set(path, text);

const capital = (text) => text && text[0].toUpperCase() + text.slice(1);

/** "answer_within_ms": "answer within (ms)" */
export function worded(part) {
  const words = part.split("_"), unit = words.length > 1 && UNITS[words.at(-1)];
  return unit ? `${words.slice(0, -1).join(" ")} (${unit})` : words.join(" ");
}

/** "scoring.address": "scoring address" */
export const partsOf = (path) => path.split(".").map(worded).join(" ");

/** Of "robots[ugv1].alias" or "robots[0].alias", a whole item included: "Robot ugv1: alias"; counted from 1.
 *  @param {string[]} match */
function ofItem([, path, item, rest]) {
  const which = /^\d+$/.test(item) ? ` ${Number(item) + 1}` : item && ` ${item}`;
  return `${LISTS[path]}${which}${rest ? `: ${partsOf(rest)}` : ""}`;
}

/** What people call the setting at `path`. */
export function nameOf(path) {
  if (labels.has(path)) return labels.get(path);
  const item = /^(team\.listen|robots|courses)\[([^\]]*)\]\.?(.*)$/.exec(path);
  if (item) return ofItem(item);
  const [group, ...rest] = path.split(".");
  if (!KNOWN.has(group)) return path; // of a file: it means nothing here
  const name = group === "command_post" ? "Command Post" : capital(worded(group));
  return rest.length ? `${name}: ${rest.map(worded).join(", ")}` : name;
}

const ITEM = /^((?:team\.listen|robots|courses)\[[^\]]+\])\.(.+)$/;

/** Changes [path, value, ...] with one row for an item that is not in all of the compared lists: its values that differ from `usual(path)`,
 *  and null for a list without it. */
export function inShort(rows, usual) {
  const items = grouped(rows, ([path]) => ITEM.exec(path)?.[1] ?? path);
  return [...items].flatMap(([item, its]) => {
    const columns = its[0].slice(1).map((_, i) => its.map((row) => ({ path: row[0], value: row[i + 1] ?? null })));
    const isAbsent = (column) => column.every(({ value }) => value === null);
    if (item === its[0][0] || !columns.some(isAbsent)) return its;
    const words = (column) => column.filter(({ path, value }) => !path.endsWith(".name") && value !== usual(path))
      .map(({ path, value }) => `${partsOf(ITEM.exec(path)[2])} ${value}`);
    return [[item, ...columns.map((column) => (isAbsent(column) ? null : ["in the list", ...words(column)].join(", ")))]];
  });
}

const KEY = new RegExp(`\\b(?:${[...KNOWN].join("|")})(?:\\[[\\w-]*\\])?(?:\\.[a-z_]+(?:\\[\\d+\\])?)+|\\b(?:robots|courses)\\[[\\w-]+\\]`, "g");

/** A sentence of the box with what people call the settings in it. */
export const spoken = (sentence) => sentence.replace(KEY, (path) => `“${nameOf(path)}”`);

/** A refusal of the box, "path: what; path: what", with what people call these settings; `within`: where its paths begin. */
export const named = (sentence, within = "") =>
  sentence.replace(/(^|; )([a-z_]+(?:[.[][\w.[\]-]*)?): /g, (all, before, path) => `${before}${nameOf(within + path)}: `);
