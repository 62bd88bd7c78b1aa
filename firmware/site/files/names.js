// What a setting is called: by the label of its field, or in the words of its key.

const labels = new Map();
const LISTS = { "team.listen": "Listen address", robots: "Robot", courses: "Course" };
const UNITS = { ms: "ms", mbit: "Mbit/s", hz: "a second", bytes: "bytes", metres: "m", seconds: "s" };

const KNOWN = new Set(["command_post", "team", "robots", "courses", "network", "reports", "queues", "runs", "alarms", "rules", "panel"]);

/** A field's label is what its setting is called everywhere. */
export const label = (path, text) => labels.set(path, text);

const capital = (text) => text && text[0].toUpperCase() + text.slice(1);

/** "answer_within_ms": "answer within (ms)" */
function worded(part) {
  const words = part.split("_"), unit = words.length > 1 && UNITS[words.at(-1)];
  return unit ? `${words.slice(0, -1).join(" ")} (${unit})` : words.join(" ");
}

/** Of "robots[ugv1].alias" or "robots[0].alias", a whole item included: "Robot ugv1: alias"; counted from 1.
 *  @param {string[]} match */
function ofItem([, path, item, rest]) {
  const which = /^\d+$/.test(item) ? Number(item) + 1 : item;
  return `${LISTS[path]} ${which}${rest ? `: ${rest.split(".").map(worded).join(" ")}` : ""}`;
}

/** What people call the setting at `path`. */
export function nameOf(path) {
  if (labels.has(path)) return labels.get(path);
  const item = /^(team\.listen|robots|courses)\[([^\]]+)\]\.?(.*)$/.exec(path);
  if (item) return ofItem(item);
  const [group, ...rest] = path.split(".");
  if (!KNOWN.has(group)) return path; // of a file: it means nothing here
  const name = group === "command_post" ? "Command Post" : capital(worded(group));
  return rest.length ? `${name}: ${rest.map(worded).join(", ")}` : name;
}

const KEY = new RegExp(`\\b(?:${[...KNOWN].join("|")})(?:\\[[\\w-]+\\])?(?:\\.[a-z_]+(?:\\[\\d+\\])?)+|\\b(?:robots|courses)\\[[\\w-]+\\]`, "g");

/** A sentence of the box with what people call the settings in it. */
export const spoken = (sentence) => sentence.replace(KEY, (path) => `“${nameOf(path)}”`);

/** A refusal of the box, "path: what; path: what", with what people call these settings; `within`: where its paths begin. */
export const named = (sentence, within = "") =>
  sentence.replace(/(^|; )([a-z_]+(?:[.[][\w.[\]-]*)?): /g, (all, before, path) => `${before}${nameOf(within + path)}: `);
