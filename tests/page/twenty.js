// Twenty robots, as an init script for a page of a scene: they replace the robots in each view.

import { retell } from "./retold.js";

/** `silent`: names of robots that were silent for 94 s; `late`: names of those whose grid is queued for 12 s. */
export const twenty = (page, { silent = ["uav5"], late = ["uav6"] } = {}) => retell(page, (silent, late) => {
  const names = [..."12345678"].map((n) => `ugv${n}`).concat([..."123456"].flatMap((n) => [`spot${n}`, `uav${n}`]));
  const began = Date.now() / 1000;
  globalThis.told = { silent, late };  // a test may change it
  const row = (view, kind, robot, since) => ({ ...view.activities.find((each) => each.kind === "grid" && !each.robot), kind, robot, age: since, heard: since });
  return (view) => {
    if (!view.activities.length) return view;
    const robots = names.flatMap((name, i) => {
      const turn = 1 + (i % 9), since = (view.now - began + i) % turn;
      const [grid, cloud] = [row(view, "grid", name, since), row(view, "cloud", name, since / 2)];
      if (globalThis.told.silent.includes(name)) for (const each of [grid, cloud]) Object.assign(each, { age: null, heard: view.now - began + 94, level: "bad", word: "silent" });
      if (globalThis.told.late.includes(name)) Object.assign(grid, { age: view.now - began + 13, queued: 3, level: "wait", word: `${Math.floor(view.now - began + 12)} s behind` });
      return [grid, cloud, row(view, "state", name, 0.4)];
    });
    const standings = names.map((name) => ({ ...robots.find(({ robot }) => robot === name), name, silent: globalThis.told.silent.includes(name), has_map: true }));
    return { ...view, activities: [...view.activities.filter(({ robot }) => !robot), ...robots], standings };
  };
}, silent, late);
