// Changes the events that a page receives, for views that are hard to reach with a real box.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { FILES } from "./stage.js";

const patched = readFileSync(join(FILES, "patched.js"), "utf8").replace(/^export /gm, "");

/** Replaces each view of the run. `make(...given)` returns a function that gets the view, may change it, and returns it; if it returns
 *  undefined, the event is dropped. All of it runs in the page. */
export const retell = (page, make, ...given) => page.addInitScript(`{
  ${patched}
  const change = (${make})(...${JSON.stringify(given)});
  delete globalThis.SharedWorker; // it would receive the events instead of the page
  const Heard = globalThis.EventSource;
  globalThis.EventSource = class extends Heard {
    #view = null;
    constructor(...words) {
      super(...words);
      for (const type of ["message", "patch"]) this.addEventListener(type, (event) => event.isTrusted && this.#hear(event, type));
    }
    #hear(event, type) {
      event.stopImmediatePropagation();
      const said = JSON.parse(event.data);
      this.#view = type === "patch" ? patched(this.#view, said) : said;
      const view = change(structuredClone(this.#view));
      if (view) this.dispatchEvent(new MessageEvent("message", { data: JSON.stringify(view) }));
    }
  };
}`);

/** While `globalThis.deaf` is set, the page receives the last view again and again. After 4.5 s of silence it would call the box lost. */
export const canBeDeaf = (page) =>
  retell(page, () => {
    let last = null;
    return (view) => (globalThis.deaf ? last : (last = view));
  });
