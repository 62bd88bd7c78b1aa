import { test } from "node:test";
import { serve } from "./stage.js";
import { visitor, watch } from "./watch.js";

/** The first answer to each of `names` is lost, as if the network changes under the browser. */
const losesFirst = (...names) => async (page) => {
  for (const name of names) await page.route(`**/${name}`, (route) => route.abort("connectionaborted"), { times: 1 });
};

/** The page is from an earlier version of the box, which was updated meanwhile, so the page names files that are gone. */
const isOld = async (page) => {
  const old = async (route) => {
    const answer = await route.fetch();
    await route.fulfill({ response: answer, body: (await answer.text()).replaceAll(/(?<!first)\.[0-9a-f]{12}\.(?=js|css)/g, ".0123456789ab.") });
  };
  await page.route(({ pathname }) => pathname === "/", old, { times: 1 });
};

test("is loaded again if a part of it was lost", async (t) => {
  for (const [path, ...lost] of [["", "index.*.css"], ["", "index.*.js"], ["", "index.*.css", "index.*.js"], ["display", "display.*.js"]]) {
    await watch(t, "calm", { path, prepare: losesFirst(...lost) });  // waits for the link
  }
});

test("is loaded again if the box has another version by now", async (t) => {
  await watch(t, "calm", { prepare: isOld });
});

test("logs in although a part of the login page was lost at first", async (t) => {
  const stage = await serve("calm");
  t.after(() => stage.end());
  const page = await visitor(t, `${stage.url}login.html`, {}, losesFirst("login.*.js"));
  await page.locator("#login").getByLabel("Password").waitFor();
});
