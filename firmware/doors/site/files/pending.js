// A change of the network that waits to be confirmed: told beside the ways to the pages, on each of them.
import { make, mark, say } from "./dom.js";
import { after, boxNow, get } from "./session.js";

const EVERY = 4000, PENDING = 1000; // ms
const nav = document.querySelector("header nav");
const strip = document.querySelector("header.strip");
let sign = null, last = null, hear = (_network, _error = undefined) => {};

/** Until the box takes it back: "73 s left". */
export function left({ pending }) {
  const seconds = Math.ceil(pending.until - boxNow());
  return seconds > 0 ? `${seconds} s left` : "taking it back";
}

function show() {
  if (!last?.pending) {
    sign?.remove();
    sign = null;
    return;
  }
  if (!sign) {
    sign = Object.assign(make("a.sign", make("span", "Network change: "), make("span")), { href: "/setup#network" });
    mark(sign, "level", "wait");
    if (strip) strip.insertBefore(sign, strip.querySelector(".ends"));
    else nav.append(sign);
  }
  say(sign.lastChild, left(last));
}

/** Shows what the box said of its network. */
export function told(network) {
  last = network;
  show();
  hear(network, null);
}

/** Calls `heard(network, null)` as the box tells it, `heard(null, error)` where it does not, `heard(network)` as time passes. */
export function followNetwork(heard = hear) {
  hear = heard;
  const follow = async () => {
    if (!document.hidden) await get("/adit/network", after(EVERY / 1000)).then(told, (error) => hear(null, error));
    setTimeout(follow, last?.pending ? PENDING : EVERY);
  };
  follow();
  setInterval(() => last?.pending && (show(), hear(last)), PENDING); // it counts down where the box cannot be reached, too
}
