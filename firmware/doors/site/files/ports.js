// The box's two ports as the kernel has them now: cable, addresses, name and MAC.
import { badge, list, make, mark, say } from "./dom.js";

const SIDES = { team: "Team’s side", command_post: "Command Post’s side" };
/** @type {[string, (port: any) => string][]} */
const FACTS = [
  ["Addresses", ({ addresses }) => addresses.join(", ") || "none"],
  ["Name", ({ side, name }) => name || (side === "team" ? "none" : "none: the box does not listen on this side")],
  ["MAC", ({ mac }) => mac || "none"],
];

/** How its cable is: a level and words. */
function linkOf({ carrier, mbit, duplex }) {
  if (carrier === null) return ["bad", "no such interface"];
  if (!carrier) return ["bad", "no cable"];
  const speed = mbit === null ? "" : mbit >= 1000 ? `${mbit / 1000} Gbit/s` : `${mbit} Mbit/s`;
  return ["good", ["cable in", speed, duplex && `${duplex} duplex`].filter(Boolean).join(", ")];
}

function create() {
  return make("li", make("span.name"), make("span.badge"), make("dl", ...FACTS.map(([name]) => make("div", make("dt", name), make("dd")))));
}

function update(node, port) {
  const [name, link, facts] = node.children, [level, word] = linkOf(port);
  say(name, `${SIDES[port.side] ?? port.side}: ${port.interface}`);
  mark(node, "level", level);
  badge(link, level, word);
  FACTS.forEach(([, of], at) => say(facts.children[at].lastChild, of(port)));
}

/** Both in one line, and the worst level. */
export function portsLine({ ports, pending }) {
  if (pending) return ["A change is pending", "ask"];
  const links = ports.map((port) => [SIDES[port.side] ?? port.side, ...linkOf(port)]), bad = links.filter(([, level]) => level === "bad");
  return bad.length ? [bad.map(([side, , word]) => `${side}: ${word}`).join("; "), "bad"] : [links.length > 1 ? "Both cables in" : "Cable in"];
}

/** Shows both in a list with the class `ports`. */
export function showPorts(place, { ports }) {
  if (place.closest("#network")) place.closest("#network").hidden = ports.length === 0; // the settings name none
  list(place, ports, ({ side }) => side, create, update);
}
