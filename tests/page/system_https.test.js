// The page over HTTPS by a real TLS server, and the card that offers it.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { serve, shoot } from "./stage.js";
import { come, VIEWER } from "./system_page.js";
import { serveByTls } from "./tls.js";
import { axeFindsNothing, visitor } from "./watch.js";

const card = (page) => page.locator("#https .body");
const says = (page, words) => page.locator("#https .state", { hasText: words }).waitFor();

async function overHttps(t, password) {
  const stage = await serveByTls("calm");
  t.after(() => stage.end());
  return come(t, password, { stage, ignoreHTTPSErrors: true, bypassCSP: true });
}

async function overHttp(t, password, options = {}) {
  const stage = await serve("calm", 0, "https");
  t.after(() => stage.end());
  return come(t, password, { stage, ...options });
}

test("the login over HTTPS gets a session that HTTP never carries", async (t) => {
  const { page, stage } = await overHttps(t);
  await says(page, "This page uses HTTPS");
  const cookies = await page.context().cookies();
  const { port } = new URL(stage.url);
  for (const name of [`__Host-adit-${port}`, `__Host-adit-device-${port}`]) {
    const cookie = cookies.find((each) => each.name === name);
    assert.ok(cookie?.secure && cookie.httpOnly && cookie.sameSite === "Strict", name);
  }
  assert.equal(cookies.length, 2);
  await page.goto(stage.url);
  await page.waitForSelector("body[data-link=live]");
  assert.deepEqual(page.complaints, []);
});

test("the card shows the fingerprint and takes another certificate over HTTPS", async (t) => {
  const { page, stage } = await overHttps(t);
  await card(page).getByText(/^90(:[0-9A-F]{2}){31}$/).waitFor();
  await card(page).getByText("2036-11-28").waitFor();
  const file = card(page).getByLabel("File with key and certificates"), upload = card(page).getByRole("button", { name: "Upload a certificate" });
  const rubbish = join(stage.folder, "rubbish.pem");
  writeFileSync(rubbish, "rubbish");
  await file.setInputFiles(rubbish);
  await upload.click();
  await card(page).getByText("there is no certificate in the file").waitFor();
  await file.setInputFiles(stage.pem);
  await upload.click();
  await card(page).getByText("The certificate is in use").waitFor();
  await card(page).getByText(/^10(:[0-9A-F]{2}){31}$/).waitFor();
  for (const theme of ["dark", "light", "red"]) {
    await page.evaluate((theme) => (document.documentElement.dataset.theme = theme), theme);
    await axeFindsNothing(page, theme);
  }
});

test("the box makes a new certificate, once that is confirmed", async (t) => {
  const { page } = await overHttp(t);
  await card(page).getByText(/^90:/).waitFor();
  await card(page).getByRole("button", { name: "Make a new certificate" }).click();
  await page.locator("#confirm").getByRole("button", { name: "Make", exact: true }).click();
  await card(page).getByText(/^10:/).waitFor();
});

test("without HTTPS, the card offers it and takes no key", async (t) => {
  const { page } = await overHttp(t, undefined, { bypassCSP: true });
  await says(page, "Offered; this page is without it");
  assert.equal(await card(page).getByRole("link").getAttribute("href"), "https://127.0.0.1/system");
  await card(page).getByRole("button", { name: "Make a new certificate" }).waitFor();
  assert.equal(await card(page).getByRole("button", { name: "Upload a certificate" }).isVisible(), false);
  for (const [width, height] of [[390, 844], [1280, 720]]) {
    await page.setViewportSize({ width, height });
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${width}`);
    for (const colorScheme of ["dark", "light"]) {
      await page.emulateMedia({ colorScheme });
      await axeFindsNothing(page, colorScheme);
      await page.locator("#https").scrollIntoViewIfNeeded();
      await shoot(page, `https-card-${width}-${colorScheme}`);
    }
  }
});

test("a viewer sees the fingerprint and changes nothing", async (t) => {
  const { page } = await overHttp(t, VIEWER);
  await card(page).getByText(/^90:/).waitFor();
  assert.equal(await card(page).getByRole("button").count(), 0);
});

test("where there is no HTTPS, the card says why, and nothing offers it", async (t) => {
  const { page } = await come(t);
  await says(page, "Not offered");
  await card(page).getByText("HTTPS is not offered: Adit has no TLS server here").waitFor();
  assert.equal(await card(page).getByRole("link").count() + (await card(page).getByRole("button").count()), 0);
});

test("the login says that the password crosses the network in clear text, and where it does not", async (t) => {
  const stage = await serve("calm", 0, "https");
  t.after(() => stage.end());
  const page = await visitor(t, `${stage.url}login.html?next=%2Fsystem`, { bypassCSP: true });
  await page.getByText("others in this network can read the password").waitFor();
  assert.equal(await page.getByRole("link").getAttribute("href"), "https://127.0.0.1/login.html?next=%2Fsystem");
  for (const [width, height] of [[390, 844], [1280, 720]]) {
    await page.setViewportSize({ width, height });
    for (const colorScheme of ["dark", "light"]) {
      await page.emulateMedia({ colorScheme });
      await axeFindsNothing(page, colorScheme);
      await shoot(page, `https-login-${width}-${colorScheme}`);
    }
  }
});

test("the login over HTTPS, or where there is none, warns of nothing", async (t) => {
  const [none, tls] = [await serve("calm"), await serveByTls("calm")];
  for (const { url, end } of [none, tls]) {
    t.after(end);
    const page = await visitor(t, `${url}login.html`, { ignoreHTTPSErrors: true });
    await page.locator("#login").waitFor();
    assert.equal(await page.locator("#clear").isVisible(), false, url);
  }
});
