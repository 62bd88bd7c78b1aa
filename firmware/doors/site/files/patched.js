// What a patch makes of a value that is known: README.md of the API says what a patch is.

const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);

/** Rows that moved with their neighbours, and then what changed, by places. */
function patchedList(list, { length, kept, rows = {} }) {
  const next = kept ? [] : [...list];
  for (const [to, from, count] of kept ?? []) for (let i = 0; i < count; ++i) next[to + i] = list[from + i];
  if (length !== undefined) next.length = length;
  for (const [place, row] of Object.entries(rows)) next[place] = patched(next[place], row);
  return next;
}

/** A new value: what did not change is the same object in both. */
export function patched(value, patch) {
  if (!isObject(patch)) return patch;
  if (Array.isArray(value)) return patchedList(value, patch);
  const next = isObject(value) ? { ...value } : {};
  for (const [name, each] of Object.entries(patch)) next[name] = patched(next[name], each);
  return next;
}
