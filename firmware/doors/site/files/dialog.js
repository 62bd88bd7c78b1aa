// The page's dialogs: <dialog> keeps the focus inside, closes on Escape, and gives the focus back. That none is pressed by
// the finger that opened it is presses.js' work.

export function open(dialog) {
  if (!dialog.open) dialog.showModal();
}

for (const button of document.querySelectorAll("dialog button.close")) {
  button.addEventListener("click", () => button.closest("dialog").close());
}

/** Opens a question; gives the value of the button that was pressed, or null where the dialog was left. `answers`: [[button, value]],
 *  first the one that does nothing. */
export function answered(dialog, answers) {
  open(dialog);
  answers[0][0].focus();
  return new Promise((resolve) => {
    let answer = null;
    for (const [button, value] of answers) {
      button.onclick = () => {
        answer = value;
        dialog.close();
      };
    }
    dialog.onclose = () => resolve(answer);
  });
}

/** Asks before something that cannot be undone; gives whether the answer was yes. */
export async function confirmed({ title, text, word }) {
  const dialog = document.getElementById("confirm");
  const [no, yes] = dialog.querySelectorAll("button");
  dialog.querySelector("h2").textContent = title;
  dialog.querySelector("p").textContent = text;
  yes.textContent = word;
  return (await answered(dialog, [[no, false], [yes, true]])) === true;
}
