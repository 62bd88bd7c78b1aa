// A change of the network that waits to be confirmed: told beside the ways to the pages, on each of them.
import { make, mark, say } from "./dom.js";
import { boxNow, get } from "./session.js";

const EVERY = 4000, PENDING = 1000; // ms
const nav = document.querySelector("header nav");
let sign = null;

function show(network) {
  const pending = network?.pending;
  if (!pending) {
    sign?.remove();
    sign = null;
    return;
  }
  if (!sign) {
    sign = Object.assign(make("a.sign", make("span", "Network change: "), make("span")), { href: "/setup#network" });
    mark(sign, "level", "wait");
    nav.append(sign);
  }
  say(sign.lastChild, `${secondsLeft(network)} s to confirm`);
}

/** Until the box takes it back. */
export const secondsLeft = ({ pending }) => Math.max(0, Math.ceil(pending.until - boxNow()));

/** Calls `hear(network)`, or `hear(null, error)` where it is not told. */
export function followNetwork(hear = () => {}) {
  const follow = async () => {
    let isPending = false;
    if (!document.hidden) {
      try {
        const network = await get("/adit/network");
        isPending = network.pending !== null;
        show(network);
        hear(network);
      } catch (error) {
        hear(null, error);
        isPending = !error.status;
      }
    }
    setTimeout(follow, isPending ? PENDING : EVERY);
  };
  follow();
}
