// Where an alarm's action leads on this page: /#report=7, /#reports, /#robot=uav5, /#rejected.
import { reveal } from "./reports.js";
import { closeSide, goTab, openSide } from "./side.js";

const find = (selector, key) => [...document.querySelectorAll(selector)].find(({ dataset }) => dataset.key === key);

function show(node) {
  node?.scrollIntoView({ block: "nearest" });
  (node?.querySelector("button:enabled") ?? node)?.focus({ preventScroll: true });
}

const WAYS = {
  report: (number) => reveal(Number(number)), // however far down the list it is
  reports: () => {
    closeSide();
    goTab("reports");
    show(document.querySelector("#reports .rows > li"));
  },
  robot: (name) => {
    closeSide();
    goTab("robots");
    show(find("#robots > li", name));
  },
  rejected: () => openSide("more", document.querySelector("#rejected button") ?? undefined),
};

function go() {
  const [what, ...rest] = location.hash.slice(1).split("=");
  if (!Object.hasOwn(WAYS, what)) return;
  history.replaceState(null, "", location.pathname + location.search); // so that the next press leads there again
  WAYS[what](decodeURIComponent(rest.join("=")));
}

/** From now on; and to where the page was opened. */
export function followWays() {
  addEventListener("hashchange", go);
  go();
}
