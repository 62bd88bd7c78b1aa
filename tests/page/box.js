// The real programs for one test: aditd with a rehearsal Command Post, on loopback.
import { once } from "node:events";
import { createServer } from "node:net";
import { setTimeout as sleep } from "node:timers/promises";
import { inspect } from "node:util";
import { begin, PASSWORD as OPERATOR, TOKENS } from "./box/box.js";
import { patient } from "./patience.js";

export { OPERATOR, TOKENS };
export const VIEWER = "look, do not touch";

/** Uses a new connection for each request, because a restarting box closes open ones. */
export const ONCE = { Connection: "close" };

/** The first true value of `look()`. After `within` ms times ADIT_PATIENCE: an Error with `what` and the last value. */
export async function until(look, what, within = 60_000) {
  for (const end = Date.now() + patient(within); ; await sleep(50)) {
    const found = await look();
    if (found) return found;
    if (Date.now() >= end) throw new Error(`waited ${patient(within) / 1000} s in vain for ${what}; seen last: ${inspect(found)}`);
  }
}

/** A free port at which a program can listen again after a restart. It is below the ephemeral ports, so the kernel does not give it to
 *  others meanwhile. */
export async function freePort() {
  for (;;) {
    const port = 11_000 + Math.floor(Math.random() * 21_000), server = createServer().listen(port, "127.0.0.1");
    const isFree = await once(server, "listening").then(() => true, () => false);
    await new Promise((closed) => server.close(closed));
    if (isFree) return port;
  }
}

/** A running aditd with both passwords set. `ask(method, path, {role, body, headers})` sends a request, by default as an operator's
 *  script. */
export async function box(t, rates = {}) {
  const it = await begin({ settings: { command_post: { rates } } });
  t.after(() => it.end());
  const url = it.url.slice(0, -1);
  const who = { operator: { Authorization: `Bearer ${TOKENS.team}` }, nobody: {} };
  const ask = (method, path, { role = "operator", body, headers = {} } = {}) => {
    const bytes = Buffer.isBuffer(body);
    const type = bytes ? "application/octet-stream" : "application/json";
    return fetch(url + path, {
      method,
      headers: { ...ONCE, ...(method === "POST" && { "Content-Type": type }), ...who[role], ...headers },
      body: body === undefined || bytes ? body : JSON.stringify(body),
    });
  };
  const logIn = async (password) => {
    const answer = await ask("POST", "/adit/login", { role: "nobody", body: { password } });
    const { csrf } = await answer.json();
    return { Cookie: answer.headers.get("Set-Cookie").split(";")[0], "Adit-CSRF": csrf };
  };
  await ask("POST", "/adit/password", { body: { role: "viewer", current: OPERATOR, password: VIEWER } });
  who.viewer = await logIn(VIEWER);
  let listened = 1;
  /** Waits for the restart after a reset. */
  const restarted = () => until(() => (it.log().match(/: listening /g) ?? []).length > listened && ++listened, "the box to restart");
  return { url, ask, logIn, code: it.code, restarted };
}

/** Posts one message of every kind, and one that is rejected. */
export async function play(ask, name = "ugv1") {
  const header = { stamp: Date.now() / 1000, frame_id: "darpa" };
  const pose = { position: { x: 1, y: 2, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
  const data = Buffer.from([0, 100, 0, 100]).toString("base64");
  const grid = { info: { resolution: 0.2, width: 2, height: 2, origin: pose }, data };
  const map = { type: "OccupancyGrid", name, msg: { header, ...grid } };
  const marker = { header, ns: "a", id: 1, type: 1, action: 0, pose, scale: { x: 1, y: 1, z: 1 }, color: { r: 1, g: 0, b: 0, a: 1 } };
  const posts = [
    ["/map/update", map],
    ["/state/update", { header, poses: [{ name, ...pose }] }],
    ["/markers/update", { markers: [marker] }],
  ];
  for (const [path, body] of posts) {
    const answer = await ask("POST", path, { body });
    if (!answer.ok) throw new Error(`${path}: ${answer.status} ${await answer.text()}`);
  }
  await ask("POST", "/state/update", { body: { poses: "none" } });
}
