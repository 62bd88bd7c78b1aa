// Set-up: the box's addresses, the Command Post's, tokens, robots, courses and all else, in steps.
import { offerApply } from "./apply.js";
import { showCourses } from "./courses.js";
import { badge } from "./dom.js";
import { checkAsTyped, refresh } from "./draft.js";
import { fillIn, listOf, onlyShow, showAll } from "./field.js";
import { offerImport } from "./file.js";
import { offerNetwork, showNetwork } from "./network.js";
import { followNetwork } from "./pending.js";
import { session, showWho, toLogin } from "./session.js";
import { leadThrough } from "./steps.js";
import { showTokens } from "./tokens.js";
import { offerTest } from "./trial.js";

const RETRY = 2000; // ms
const link = document.getElementById("link");

function linkIs(lost) {
  badge(link, lost ? "bad" : "good", lost ? "Box lost" : "Live");
}

async function begin() {
  const { role } = await session();
  if (!role) return toLogin();
  const isViewer = role !== "operator";
  document.body.dataset.role = role;
  document.getElementById("looks").hidden = !isViewer;
  showWho(document.getElementById("who"));
  await refresh();
  if (isViewer) onlyShow();
  else checkAsTyped();
  offerNetwork();
  fillIn();
  for (const place of document.querySelectorAll("[data-list]")) listOf(place);
  showAll();
  showTokens(isViewer);
  showCourses();
  offerTest();
  offerImport();
  document.querySelector(".choose").hidden = isViewer;
  leadThrough();
  offerApply();
  followNetwork((network, error) => {
    linkIs(Boolean(error && !error.status));
    if (network) showNetwork(network);
  });
}

begin().catch((error) => {
  linkIs(true);
  if (error.status) throw error;
  setTimeout(() => location.reload(), RETRY);
});
