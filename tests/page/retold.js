// What a page hears of the box, changed on its way: for views that no box is easily brought to.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { FILES } from "./stage.js";

const patched = readFileSync(join(FILES, "patched.js"), "utf8").replace(/^export /gm, "");

/** The page hears, in the place of each view of the run, what `make(...given)` makes of it: make gives a function of the view,
 *  which it may change; nothing: it hears nothing. All of it runs in the page. */
export const retell = (page, make, ...given) => page.addInitScript(`{
  ${patched}
  const change = (${make})(...${JSON.stringify(given)});
  delete globalThis.SharedWorker; // which would hear it in the page's place
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

/** While `globalThis.deaf`, the page hears the last view from before again and again. In silence it would call the box lost after 4.5 s. */
export const canBeDeaf = (page) =>
  retell(page, () => {
    let last = null;
    return (view) => (globalThis.deaf ? last : (last = view));
  });
