// How old each robot's map at the Command Post was over the last three minutes: sampled by this page, and before it was opened by
// the box.

const EVERY = 2, SPAN = 90; // seconds; samples
const LEAST = 10; // seconds

const values = new Map(); // by robot: the newest last; null: not known
const paths = new Map(); // of these values
let last = null; // when, in steps of EVERY

/** Once each EVERY seconds of the box's time, however often it is called. What this page slept through is not known. */
export function sampleAges(robots, time) {
  const step = Math.floor(time / EVERY);
  if (step === last) return;
  const missed = last === null ? 0 : step - last - 1;
  if (missed < 0 || missed >= SPAN) values.clear(); // the box's clock was set
  last = step;
  paths.clear();
  for (const name of values.keys()) if (!robots.some((robot) => robot.name === name)) values.delete(name);
  for (const { name, level, silent, age } of robots) {
    const its = values.get(name) ?? [];
    if (its.length) for (let i = 0; i < missed; ++i) its.push(null);
    its.push(age ?? (silent || level === "quiet" ? null : 0));
    values.set(name, its.slice(-SPAN));
  }
}

/** From before this page was opened, as the box has it: its History. */
export function fillAges({ at, robots }, time) {
  const step = Math.floor(time / EVERY);
  for (const { robot, ages } of robots) {
    const own = values.get(robot) ?? [], earlier = Array(SPAN - own.length).fill(null);
    at.forEach((when, i) => {
      const place = SPAN - 1 - (step - Math.floor(when / EVERY));
      if (place >= 0 && place < earlier.length) earlier[place] = ages[i];
    });
    const first = earlier.findIndex((age) => age !== null);
    if (first >= 0) values.set(robot, [...gapless(earlier.slice(first)), ...own]);
  }
  paths.clear();
}

/** A step without a sample of its own, between two that have one, is as the one before. */
const gapless = (ages) => ages.map((age, i) => age ?? (i > 0 && i + 1 < ages.length ? ages[i - 1] : null));

/** A path of 0 to SPAN by 0 to 20, now at the right; as high as LEAST seconds, or more where it was more. */
export function pathOf(name) {
  if (!paths.has(name)) paths.set(name, drawn(name));
  return paths.get(name);
}

function drawn(name) {
  const its = values.get(name) ?? [], top = Math.max(LEAST, ...its), from = SPAN - its.length;
  let isGap = true;
  return its.map((age, i) => {
    if (age === null) return (isGap = true) && "";
    const point = `${isGap ? "M" : "L"}${from + i} ${(19 - (age / top) * 18).toFixed(1)}`;
    isGap = false;
    return point;
  }).join("");
}
export const BOX = `0 0 ${SPAN} 20`;
