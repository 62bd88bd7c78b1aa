// A script's error is an alarm on its page. The first one stays until it is closed, because the next ones mostly follow from it.
(() => {
  let alarm = null;
  const button = (word, press) => Object.assign(document.createElement("button"), { type: "button", textContent: word, onclick: press });
  const show = (error) => {
    if (!error || alarm) return;
    alarm = document.createElement("p");
    alarm.className = "fault";
    alarm.setAttribute("role", "alert");
    const what = String(error).slice(0, 300).replace(/\.$/, "");
    const close = () => {
      alarm.remove();
      alarm = null;
    };
    alarm.append(`This page failed: ${what}. Reload it. If the alarm returns, report this sentence. `,
      button("Reload", () => location.reload()), " ", button("Close", close));
    document.body.append(alarm);
  };
  addEventListener("error", ({ error }) => show(error)); // a notice of the browser (ResizeObserver) has no error
  addEventListener("unhandledrejection", ({ reason }) => show(reason));
})();
