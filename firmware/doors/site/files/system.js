// The box itself: log, sessions, passwords, support bundle, list of parts.
import "./presses.js";
import { followAddress, tellCard } from "./card.js";
import { offerHttps } from "./certificate.js";
import { offerClock, showClock } from "./clock.js";
import { badge } from "./dom.js";
import { followLog } from "./log.js";
import { offerBundle, offerReset, showAbout } from "./box.js";
import { watchSessions } from "./logins.js";
import { offerPasswords } from "./passwords.js";
import { followNetwork } from "./pending.js";
import { portsLine, showPorts } from "./ports.js";
import { isFault, session, showWho, toLogin } from "./session.js";
import { offerSpare } from "./spare.js";
import { offerUpdate } from "./update.js";

const link = document.getElementById("link");
const RETRY = 2000;

function linkIs(lost) {
  badge(link, lost ? "bad" : "good", lost ? "Box lost" : "Live");
}

async function begin() {
  const { role } = await session();
  if (!role) return toLogin();
  const operator = role === "operator";
  for (const section of document.querySelectorAll("[data-operator]")) section.hidden = !operator;
  document.getElementById("looks").hidden = operator;
  showWho(document.getElementById("who"));
  followLog(linkIs);
  const ports = document.getElementById("network");
  followNetwork((network) => {
    if (!network) return;
    showPorts(ports.querySelector(".ports"), network);
    tellCard(ports, ...portsLine(network));
  });
  showAbout();
  offerHttps(operator);
  showClock(operator);
  offerUpdate(operator);
  followAddress();
  if (!operator) return;
  offerClock().catch(() => {}); // the alarm says that the time is not set
  watchSessions();
  offerPasswords();
  offerBundle();
  offerSpare();
  offerReset();
}

begin().catch((error) => {
  if (isFault(error)) return;
  linkIs(true);
  setTimeout(() => location.reload(), RETRY);
});
