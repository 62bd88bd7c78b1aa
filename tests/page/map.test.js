import assert from "node:assert/strict";
import { test } from "node:test";
import { robotRgb } from "../../firmware/doors/site/files/robot_colour.js";
import { until } from "./box.js";
import { becomes, box, canvas, changed, picture } from "./pictures.js";
import { serve } from "./stage.js";
import { hears, settled, toTab, watch } from "./watch.js";

const asked = (page, part) => page.requests.filter((url) => url.includes(part)).length;
const tiles = (page) => page.requests.filter((url) => url.includes("/tiles?")).flatMap((url) => new URL(url).searchParams.get("tiles").split(",")).length;
/** Whether more pixels have about this colour than the rims of letters have. */
const shows = (page, [red, green, blue, most]) =>
  page.$eval(canvas, (node, [red, green, blue, most]) => {
    let count = 0;
    const { data } = node.getContext("2d").getImageData(0, 0, node.width, node.height);
    for (let i = 0; i < data.length; i += 4) {
      if (data[i + 3] > 200 && Math.abs(data[i] - red) + Math.abs(data[i + 1] - green) + Math.abs(data[i + 2] - blue) < 24) ++count;
    }
    return count > most;
  }, [red, green, blue, most]);

const WALL = [0x6b, 0x78, 0x80, 200], ROBOT = [...robotRgb(1, "dark"), 10], SCORED = [0x43, 0xd8, 0x93, 10], MARKER = [0xff, 0x33, 0xff, 10];
async function hide(page, ...names) {
  for (const name of names) await box(page, name).uncheck();
  await settled(page);
}

const appears = (page, colour, what) => until(() => shows(page, colour), what);
const goes = (page, colour, what) => until(async () => !(await shows(page, colour)), `${what} to go`);

/** The time slider, which exists once there is a map. */
async function sliderOf(page) {
  await page.waitForSelector("#map input[type=range]:enabled");
  return page.getByRole("slider");
}

test("shows the maps, the robots on them and the reports, each by its own checkbox", async (t) => {
  const { page } = await watch(t, "calm", { colorScheme: "dark" });
  await hide(page, "Tracks");  // they have the robots' colours
  for (const [name, colour] of [["Grids", WALL], ["Robots", ROBOT], ["Reports", SCORED], ["Markers", MARKER], ["merged", WALL]]) {
    await appears(page, colour, name);
    await box(page, name).uncheck();
    await goes(page, colour, name);
    await box(page, name).check();
    await appears(page, colour, `${name}, again`);
  }
  await hide(page, "Robots"); // they move
  const before = await picture(page);
  await box(page, "Clouds").uncheck();
  await changed(page, before, "the clouds to go");
  assert.match(await page.textContent("#map .legend"), /Height\s+0\.0 m\s+\d\.0 m/);
  assert.deepEqual(page.complaints.filter((text) => !text.includes("getImageData")), []);  // from this test's own reading
});

test("shows robots, tracks and markers as they were at a time", async (t) => {
  const { page } = await watch(t, "calm", { colorScheme: "dark" });
  const slider = await sliderOf(page);
  await hide(page, "Clouds", "Reports", "Tracks");
  await appears(page, MARKER, "the markers");
  await page.locator("#map .leftout", { hasText: "The map shows the newest 13 markers and leaves out 3. Only some points of one marker are drawn." }).waitFor();
  await slider.press("Home");
  await slider.press("ArrowRight");
  await goes(page, MARKER, "the markers, none of which had come");
  assert.ok(await shows(page, ROBOT), "as they were ten minutes ago");
  await box(page, "Robots").uncheck();
  await goes(page, ROBOT, "the robots");
  await hide(page, "Markers", "Grids");
  const without = await picture(page);
  await box(page, "Tracks").check();
  const begun = await changed(page, without, "the beginning of the tracks");
  await slider.press("End");
  await changed(page, begun, "the tracks as far as they have come now");
});

test("hides the newest part of the tracks with the tracks", async (t) => {
  const { stage, page } = await watch(t, "calm");
  await hide(page, "Robots");
  await hears(page, 4);  // they move
  await settled(page);
  stage.freeze();
  await hide(page, "Tracks");
  const without = await picture(page);
  await hide(page, "Reports");
  await changed(page, without, "the reports to go");
  await box(page, "Reports").check();
  await becomes(page, without, "the same map, drawn again", 0);
});

test("moves by hand, wheel, keys and buttons, and fits again", async (t) => {
  const { page } = await watch(t, "empty");
  await settled(page);
  const moves = {
    wheel: async () => {
      const before = await picture(page);
      await page.locator(canvas).hover();  // once the page is still
      await until(async () => {
        await page.mouse.wheel(0, -240);  // again, as a user does, because a busy browser may lose one
        return (await picture(page)) !== before;
      }, "the wheel to be heard");
    },
    "zoom in": () => page.getByRole("button", { name: "Zoom in" }).click(),
    "zoom out": () => page.getByRole("button", { name: "Zoom out" }).click(),
    plus: () => page.locator(canvas).press("+"),
    minus: () => page.locator(canvas).press("-"),
  };
  for (const [name, move] of Object.entries(moves)) {
    const before = await picture(page);
    await move();
    await changed(page, before, name);
    await settled(page);
  }
});

test("pans by dragging and by the arrow keys, and All shows the whole map again", async (t) => {
  const { page } = await watch(t, "reports");
  await settled(page);
  await hide(page, "Robots", "Tracks"); // they move by themselves
  const whole = await picture(page);
  await page.locator(canvas).scrollIntoViewIfNeeded();
  const at = await page.locator(canvas).boundingBox();
  await page.mouse.move(at.x + 100, at.y + 100);
  await page.waitForSelector("[data-moving]", { state: "detached" });
  await page.mouse.down();
  await page.mouse.move(at.x + 160, at.y + 130, { steps: 4 });
  await page.mouse.up();
  await settled(page);
  const dragged = await changed(page, whole, "the drag");
  await page.locator(canvas).press("ArrowLeft");
  await changed(page, dragged, "the arrow key");
  await page.getByRole("button", { name: "All", exact: true }).click();
  await becomes(page, whole);
});

test("looks after a move as if it were drawn again", async (t) => {
  const { page } = await watch(t, "calm", { colorScheme: "dark" });
  await settled(page);
  await hide(page, "Robots", "Tracks"); // they move by themselves
  const at = await page.locator(canvas).boundingBox(), whole = await picture(page);
  await page.mouse.move(at.x + 200, at.y + 200);
  await page.waitForSelector("[data-moving]", { state: "detached" });
  await page.mouse.down();
  await page.mouse.move(at.x + 251.4, at.y + 227.3, { steps: 5 });  // fractions of pixels, as a pen's
  await page.mouse.up();
  await hears(page, 1);  // the map has come to rest meanwhile
  const moved = await changed(page, whole, "the move");
  await page.emulateMedia({ colorScheme: "light" });
  await changed(page, moved, "the light map");
  await page.emulateMedia({ colorScheme: "dark" });
  await becomes(page, moved, "the same, drawn again", 100);
});

test("shows an earlier map by the slider, and the current one again", async (t) => {
  const { page } = await watch(t, "calm");
  const slider = await sliderOf(page);
  await hide(page, "Robots", "Tracks", "Reports");
  const whole = await picture(page);
  assert.equal(await slider.getAttribute("aria-valuetext"), "now");
  await slider.focus();
  for (let i = 0; i < 2; ++i) await page.keyboard.press("PageDown");
  for (let i = 0; i < 2; ++i) await page.keyboard.press("PageDown");
  assert.match(await slider.getAttribute("aria-valuetext"), /^as of \d\d:\d\d:\d\d$/);
  await until(() => asked(page, "at=") > 0, "tiles as they were");
  await changed(page, whole, "the map as it was");
  await page.getByRole("button", { name: "Now", exact: true }).click();
  assert.equal(await slider.getAttribute("aria-valuetext"), "now");
  await becomes(page, whole);
});

test("loads a tile only if it is visible and its version changed", async (t) => {
  const { page } = await watch(t, "calm");
  await settled(page);
  const once = tiles(page), maps = asked(page, "/adit/map?");
  assert.ok(once > 0 && once < 40, `${once} tiles`);
  await hears(page, 6);
  assert.equal(tiles(page), once);
  assert.equal(asked(page, "/adit/map?"), maps);
});

test("is drawn again only if something on it changed", async (t) => {
  const prepare = (page) => page.addInitScript(() => {
    globalThis.drawn = 0;
    const clear = CanvasRenderingContext2D.prototype.clearRect;
    CanvasRenderingContext2D.prototype.clearRect = function (...box) {
      ++globalThis.drawn;
      clear.apply(this, box);
    };
  });
  const { page } = await watch(t, "empty", { prepare });
  await settled(page);
  await hears(page, 1);  // the first events are drawn
  const before = await page.evaluate(() => globalThis.drawn);
  await hears(page, 2);
  assert.equal(await page.evaluate(() => globalThis.drawn), before);
});

test("shows the map of a restarted box", async (t) => {
  const { stage, page } = await watch(t, "calm", { colorScheme: "dark" });
  await settled(page);
  const once = tiles(page);
  await stage.end();
  await page.waitForSelector("body[data-link=lost]");
  const next = await serve("calm", stage.port);
  t.after(() => next.end());
  await page.waitForSelector("body[data-link=live]");
  await until(() => tiles(page) > once, "the tiles of the new map");
  await settled(page);
  assert.ok(await shows(page, WALL));
});

test("zooms with two fingers", async (t) => {
  const { page } = await watch(t, "calm", { hasTouch: true, viewport: { width: 390, height: 844 } });
  await toTab(page, "Map");
  await settled(page);
  await hide(page, "Robots", "Tracks"); // they move by themselves
  const before = await picture(page);
  await page.$eval(canvas, (node) => {
    const box = node.getBoundingClientRect();
    const send = (type, id, x, y) =>
      node.dispatchEvent(new PointerEvent(type, { pointerId: id, pointerType: "touch", clientX: box.x + x, clientY: box.y + y, bubbles: true }));
    node.setPointerCapture = () => {};
    send("pointerdown", 1, 100, 100);
    send("pointerdown", 2, 140, 100);
    send("pointermove", 2, 240, 100);
    send("pointerup", 1, 100, 100);
    send("pointerup", 2, 240, 100);
  });
  await changed(page, before, "the fingers' move");
});

test("loads the map's picture later if it is unavailable at first", async (t) => {
  let fails = true;
  const prepare = (page) => page.route("**/adit/map?*", (route) => (fails ? route.fulfill({ status: 503, json: "busy" }) : route.continue()));
  const { page } = await watch(t, "calm", { prepare });
  await until(() => asked(page, "/adit/map?") > 1, "the picture to be asked for again");
  assert.equal(tiles(page), 0);
  fails = false;
  await until(() => tiles(page) > 0, "the tiles");
});
