import { test } from "node:test";
import { serve } from "./stage.js";
import { visitor, watch } from "./watch.js";

/** The first answer to each of `names` is lost, as where the network changes under the browser. */
const losesFirst = (...names) => async (page) => {
  for (const name of names) await page.route(`**/${name}`, (route) => route.abort("connectionaborted"), { times: 1 });
};

test("is loaded again where a part of it did not come", async (t) => {
  for (const [path, ...lost] of [["", "page.css"], ["", "words.js"], ["", "page.js", "map.js"], ["display", "display.js"]]) {
    await watch(t, "calm", { path, prepare: losesFirst(...lost) }); // which waits for the link
  }
});

test("lets somebody log in, though a part of the login did not come at first", async (t) => {
  const stage = await serve("calm");
  t.after(() => stage.end());
  const page = await visitor(t, `${stage.url}login.html`, {}, losesFirst("session.js"));
  await page.locator("#login").getByLabel("Password").waitFor();
});
