// The card of HTTPS: whether the box offers it, the certificate's fingerprint, and another certificate.
import { tellCard } from "./card.js";
import { confirmed } from "./dialog.js";
import { make } from "./dom.js";
import { linkToHttps } from "./https.js";
import { get, isFault, oneAtATime, post, session } from "./session.js";

const EVERY = 5000; // ms

/** A line may end after eight bytes. */
const grouped = (fingerprint) => fingerprint.match(/.{24}|.+/g).flatMap((each) => [each, make("wbr")]);

const WORDS = { yes: "This page uses HTTPS", no: "Offered; this page is without it", off: "Not offered" };

export async function offerHttps(operator) {
  const section = document.getElementById("https"), note = section.querySelector(".note"), facts = section.querySelector("dl");
  const outcome = section.querySelector(".outcome"), file = section.querySelector("input");
  const [upload, renew] = section.querySelectorAll(".answers button");
  const { secure } = await session();
  function show({ offered, why, fingerprint, until }) {
    tellCard(section, WORDS[!offered ? "off" : secure ? "yes" : "no"]);
    if (!offered) note.textContent = `HTTPS is not offered: ${why}.`;
    else if (secure) note.textContent = "This page and its passwords cross the network encrypted.";
    else if (!note.querySelector("a"))
      note.replaceChildren("Others in this network can read this page and its passwords. Use ", linkToHttps(), ". A browser warns once of a certificate that the box made itself: compare the fingerprint.");
    for (const node of [file, upload]) node.hidden = !operator || !offered || !secure;
    renew.hidden = !operator || !offered;
    facts.hidden = !fingerprint;
    if (facts.textContent.includes(fingerprint)) return;
    if (fingerprint) facts.replaceChildren(make("div", make("dt", "SHA-256 fingerprint"), make("dd", ...grouped(fingerprint))), make("div", make("dt", "Last day"), make("dd", until)));
  }
  const look = () => get("/adit/certificate").then(show).catch((error) => isFault(error));
  const act = oneAtATime(async (action) => {
    outcome.dataset.bad = false;
    outcome.textContent = "The box checks the certificate.";
    try {
      show(await action());
      outcome.textContent = "The certificate is in use. Reload the page to see it.";
    } catch (error) {
      outcome.textContent = error.message;
      outcome.dataset.bad = true;
    }
  });
  upload.addEventListener("click", () => file.files[0] && act(() => post("/adit/certificate", file.files[0])));
  renew.addEventListener("click", async () => {
    const text = "Browsers warn again, and show the fingerprint of the new certificate.";
    if (await confirmed({ title: "Make a new certificate?", text, word: "Make" })) act(() => post("/adit/certificate/new"));
  });
  const follow = () => look().then(() => setTimeout(follow, EVERY));
  follow();
}
