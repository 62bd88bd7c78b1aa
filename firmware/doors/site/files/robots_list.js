// All robots as rows that a finger can follow, in the place of the reports: a touch anywhere on their panel opens it.
import { isShown } from "./dom.js";
import { RobotRows } from "./robot_rows.js";
import { goTab, openSide, side } from "./side.js";

const ID = "all-robots";
const panel = document.getElementById(ID);
const rows = new RobotRows(panel, panel.querySelector(".robots"), true);

let last = null;

/** `state`: as showRobots() gave it. */
export function showRobotsList(state, now) {
  last = () => rows.show(state.robots, now);
  if (side() === ID) last();
}

/** Where there are tabs, the robots have one of their own. */
export function offerRobotsList() {
  document.getElementById("maps").addEventListener("click", () => {
    if (isShown(document.querySelector(".tabs"))) return goTab("robots");
    openSide(ID);
    last?.();
  });
}
