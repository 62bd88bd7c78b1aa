// The page's address over HTTPS, and why to use it.
import { make } from "./dom.js";
import { session } from "./session.js";

/** The box's page `url`, by HTTPS if this page uses it: at its own port, whatever the settings name. */
export function atThisScheme(url) {
  const there = new URL(url);
  if (location.protocol !== "https:") return url;
  [there.protocol, there.port] = ["https:", location.port];
  return there.href;
}

/** A link to this page over HTTPS. */
export function linkToHttps() {
  const link = make("a", `https://${location.hostname}`);
  link.href = link.textContent + location.pathname + location.search;
  return link;
}

/** What to know before a password is typed on a page without HTTPS. */
export async function warnOfClearText(place) {
  const { secure, https } = await session();
  if (secure || !https) return;
  place.append(
    "Without HTTPS, others in this network can read the password. Log in at ", linkToHttps(),
    ": the browser warns if the box made its certificate itself.");
  place.hidden = false;
}
