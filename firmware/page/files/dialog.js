// The page's dialogs: <dialog> keeps the focus inside, closes on Escape, and gives the focus back.

export function open(dialog) {
  if (!dialog.open) dialog.showModal();
}

for (const button of document.querySelectorAll("dialog button.close")) {
  button.addEventListener("click", () => button.closest("dialog").close());
}

const dialog = document.getElementById("confirm");
const [no, yes] = dialog.querySelectorAll("button");

/** Asks before something that cannot be taken back; gives whether the answer was yes. */
export function confirmed({ title, text, word }) {
  dialog.querySelector("h2").textContent = title;
  dialog.querySelector("p").textContent = text;
  yes.textContent = word;
  open(dialog);
  no.focus();
  return new Promise((resolve) => {
    let answer = false;
    yes.onclick = () => {
      answer = true;
      dialog.close();
    };
    no.onclick = () => dialog.close();
    dialog.onclose = () => resolve(answer);
  });
}
