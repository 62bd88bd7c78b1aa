// Lists by a key.

/** A Map from keyOf(item) to the items of that key, in their order (the floor has no Map.groupBy). */
export function grouped(items, keyOf) {
  const groups = new Map();
  for (const item of items) {
    const key = keyOf(item);
    if (groups.has(key)) groups.get(key).push(item);
    else groups.set(key, [item]);
  }
  return groups;
}
