"""Controls Chromium's headless shell over its DevTools pipe: null-terminated JSON on descriptors 3 and 4. For the one story of the page
that needs no npm; all others use Playwright."""

import json
import os
import subprocess
import tempfile

from patience import wait_until

CHROMIUM = os.environ.get("CHROMIUM", "/usr/bin/chromium-headless-shell")
# Finds an element as a user does: a field by its label, a button by its text. If a dialog is open, searches only there.
FIND = """(kind, words) => {
  const top = [...document.querySelectorAll("dialog[open]")].at(-1) ?? document;
  const textOf = (node) => (node?.innerText ?? node?.textContent ?? "").trim();
  const all = kind === "button" ? [...top.querySelectorAll("button")].filter((each) => (each.getAttribute("aria-label") ?? textOf(each)) === words)
    : kind === "field" ? [...top.querySelectorAll("input, select")].filter((each) => [...(each.labels ?? [])].some((label) => textOf(label) === words) || each.getAttribute("aria-label") === words)
    : [...top.querySelectorAll(words)];
  return all.find((each) => each.checkVisibility() && each.getBoundingClientRect().width);
}"""
# The centre of the element if a press there reaches it: it is enabled, still (presses.js) and on top. Otherwise null.
PLACE = f"""async (kind, words) => {{
  const found = ({FIND})(kind, words);
  if (!found || found.disabled) return null;
  found.scrollIntoView({{ block: "center", behavior: "instant" }});
  const middle = () => {{ const {{ x, y, width, height }} = found.getBoundingClientRect(); return [x + width / 2, y + height / 2]; }};
  const before = middle();
  for (let frame = 0; frame < 3; ++frame) await new Promise(requestAnimationFrame);
  const at = middle(), stood = String(at) === String(before) && !found.closest("[data-moving]");
  return stood && found.contains(document.elementFromPoint(...at)) ? at : null;
}}"""


class Refused(AssertionError):
    """Chromium did not do what it was asked to."""


class Browser:
    """One page. `complaints` are the errors and warnings of its console."""

    def __enter__(self):
        self.folder = tempfile.TemporaryDirectory(prefix="adit-browser-", ignore_cleanup_errors=True)
        asked, self._out = os.pipe()
        self._in, answers = os.pipe()

        def as_three_and_four():
            high = os.dup(asked), os.dup(answers)
            os.dup2(high[0], 3)
            os.dup2(high[1], 4)

        self.process = subprocess.Popen(
            [CHROMIUM, "--headless", "--disable-gpu", "--no-first-run", "--disable-background-networking", "--disable-sync",
             "--disable-component-update", f"--user-data-dir={self.folder.name}", "--remote-debugging-pipe",
             *(["--no-sandbox"] if os.geteuid() == 0 else [])],
            close_fds=False, preexec_fn=as_three_and_four, stderr=subprocess.DEVNULL)
        os.close(asked)
        os.close(answers)
        self._answers = os.fdopen(self._in, "rb")
        self._number, self._session, self._rest, self.complaints = 0, None, b"", []
        target = self._call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self._call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in "Page", "Runtime", "Log":
            self._call(f"{domain}.enable")
        self._call("Emulation.setDeviceMetricsOverride", width=1280, height=720, deviceScaleFactor=1, mobile=False)
        return self

    def __exit__(self, *_):
        os.close(self._out)  # at which it ends
        self.process.wait()
        self._answers.close()
        self.folder.cleanup()

    def _next(self):
        while b"\0" not in self._rest:
            piece = self._answers.read1(65536)
            if not piece:
                raise AssertionError(f"{CHROMIUM} ended")
            self._rest += piece
        message, self._rest = self._rest.split(b"\0", 1)
        return json.loads(message)

    def _call(self, method, **parameters):
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._out, json.dumps(message).encode() + b"\0")
        while (answer := self._next()).get("id") != self._number:
            self._hear(answer)
        if "error" in answer:
            raise Refused(f"{method}: {answer['error']['message']}")
        return answer["result"]

    def _hear(self, event):
        said = event.get("params", {})
        if event["method"] == "Runtime.exceptionThrown":
            self.complaints.append(str(said["exceptionDetails"]))
        elif event["method"] == "Runtime.consoleAPICalled" and said["type"] in ("error", "warning"):
            self.complaints.append(str(said["args"]))
        elif event["method"] == "Log.entryAdded" and said["entry"]["level"] in ("error", "warning"):
            self.complaints.append(f"{said['entry']['text']} {said['entry'].get('url', '')}")

    def run(self, script, *arguments):
        """What the page's JavaScript function `script` gives; None if the page is being replaced by the next one."""
        try:
            made = self._call("Runtime.evaluate", expression=f"({script})(...{json.dumps(arguments)})", returnByValue=True, awaitPromise=True)
        except Refused as refused:
            if "navigated" in str(refused) or "context" in str(refused):
                return None
            raise
        if "exceptionDetails" in made:
            raise AssertionError(f"{script}: {made['exceptionDetails']['exception'].get('description')}")
        return made["result"].get("value")

    def open(self, url):
        self._call("Page.navigate", url=url)

    def has(self, selector, words=""):
        """Waits for a visible element whose text contains `words`."""
        wait_until(lambda: self.run("(selector, words) => [...document.querySelectorAll(selector)]"
                                    ".some((each) => each.checkVisibility() && each.innerText.includes(words))", selector, words),
                   f"{selector} with '{words}'", within=60)

    def press(self, words, kind="button"):
        """Presses with the mouse what a user would, once it takes presses: press("Log in"), press(".send", "selector")."""
        x, y = wait_until(lambda: self.run(PLACE, kind, words), f"the {kind} '{words}' to take presses", within=60)
        for what in "mousePressed", "mouseReleased":
            self._call("Input.dispatchMouseEvent", type=what, x=x, y=y, button="left", clickCount=1)

    def type(self, label, text, kind="field"):
        """Replaces what stands in a field."""
        self.press(label, kind)
        self.run(f"(kind, words) => ({FIND})(kind, words).select()", kind, label)
        self._call("Input.insertText", text=text)
