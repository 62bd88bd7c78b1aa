// The search of the help, as one types. Without a script the page is whole, and has no search.
const find = document.querySelector(".find"), field = find.querySelector("input"), told = find.querySelector("p");
const entries = [...document.querySelectorAll("main dl")];

/** A title is shown if an entry between it and the next one is. */
function showTitles() {
  for (const title of document.querySelectorAll(".troubles > .note ~ h2")) {
    let next = title.nextElementSibling;
    while (next?.localName === "dl" && next.hidden) next = next.nextElementSibling;
    title.hidden = next?.localName !== "dl";
  }
  for (const section of document.querySelectorAll("section")) section.hidden = !section.querySelector("dl:not([hidden])");
}

function search() {
  const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
  for (const entry of entries) {
    const text = entry.textContent.toLowerCase();
    entry.hidden = !words.every((word) => text.includes(word));
  }
  showTitles();
  const found = entries.filter(({ hidden }) => !hidden).length;
  told.textContent = words.length === 0 ? "" : found ? `${found} found.` : "Nothing matches.";
}

field.addEventListener("input", search);
find.hidden = false;
search(); // what the browser kept
export {};
