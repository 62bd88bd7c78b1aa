// The real thing: aditd with a rehearsal Command Post, on loopback, for the length of one test.
import { spawn } from "node:child_process";
import { once } from "node:events";
import { createServer } from "node:net";
import { chmodSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { inspect } from "node:util";
import { patient } from "./patience.js";
import { BIN } from "./stage.js";

export const TOKENS = { scoring: "scoring-token-1", mapping: "mapping-token-1", team: "team-token-1" };
export const OPERATOR = "correct horse battery", VIEWER = "look, do not touch";

/** A connection of its own for a request: a box that restarts, after a reset, closes those that are kept. */
export const ONCE = { Connection: "close" };

/** The first true value of `look()`. After `within` ms times ADIT_PATIENCE: an Error with `what` and the value seen last. */
export async function until(look, what, within = 60_000) {
  for (const end = Date.now() + patient(within); ; await sleep(50)) {
    const found = await look();
    if (found) return found;
    if (Date.now() >= end) throw new Error(`waited ${patient(within) / 1000} s in vain for ${what}; seen last: ${inspect(found)}`);
  }
}

class Program {
  log = "";
  constructor(name, ...args) {
    this.process = spawn(join(BIN, name), args, { stdio: ["ignore", "pipe", "pipe"] });
    for (const output of [this.process.stdout, this.process.stderr]) output.on("data", (bytes) => (this.log += bytes));
  }
  /** The first group of `pattern` in what it printed. */
  said = (pattern) => until(() => pattern.exec(this.log)?.[1], `${pattern} in:\n${this.log}`);
  async end() {
    if (this.process.exitCode !== null || this.process.signalCode !== null) return;
    this.process.kill("SIGTERM");
    await once(this.process, "exit");
  }
}

/** One that nobody listens at, where a program is to be found however often it restarts. Below those that the kernel gives
 *  to whoever asks for any, or it might give this one away meanwhile. */
export async function freePort() {
  for (;;) {
    const port = 11_000 + Math.floor(Math.random() * 21_000), server = createServer().listen(port, "127.0.0.1");
    const isFree = await once(server, "listening").then(() => true, () => false);
    await new Promise((closed) => server.close(closed));
    if (isFree) return port;
  }
}

function secretsIn(folder) {
  mkdirSync(folder, { mode: 0o700 });
  for (const [name, token] of Object.entries(TOKENS)) {
    writeFileSync(join(folder, `${name}.token`), `${token}\n`);
    chmodSync(join(folder, `${name}.token`), 0o600);
  }
  return folder;
}

/** aditd at work, both passwords set; `ask(method, path, {role, body, headers})` asks as an operator's script by default. */
export async function box(t, rates = {}) {
  const folder = mkdtempSync(join(tmpdir(), "adit-page-"));
  const programs = [];
  const start = (...words) => programs[programs.push(new Program(...words)) - 1];
  t.after(async () => {
    for (const program of programs.reverse()) await program.end();
    rmSync(folder, { recursive: true }); // only now: a box at work writes to it
  });
  const secrets = secretsIn(join(folder, "secrets"));
  const post = start("adit-rehearsal", "--scoring", "127.0.0.1:0", "--mapping", "127.0.0.1:0", "--secrets", secrets, "--verbose");
  const address = async (name) => ({ address: "127.0.0.1", port: Number(await post.said(new RegExp(`${name} 127\\.0\\.0\\.1:(\\d+)`))) });
  const settings = {
    version: 1,
    command_post: { scoring: await address("scoring"), mapping: await address("mapping"), rates },
    team: { listen: [{ address: "127.0.0.1", port: await freePort() }] },
  };
  writeFileSync(join(folder, "settings.json"), JSON.stringify(settings));
  const state = join(folder, "state");
  const aditd = start("aditd", "--settings", join(folder, "settings.json"), "--secrets", secrets, "--state", state);
  const url = `http://127.0.0.1:${await aditd.said(/listening .*port=(\d+)/)}`;

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
  const code = readFileSync(join(state, "first-start.code"), "utf8").trim();
  await ask("POST", "/adit/password", { role: "nobody", body: { role: "operator", code, password: OPERATOR } });
  await ask("POST", "/adit/password", { body: { role: "viewer", current: OPERATOR, password: VIEWER } });
  who.viewer = await logIn(VIEWER);
  let listened = 1;
  /** After a reset. */
  const restarted = () => until(() => (aditd.log.match(/: listening /g) ?? []).length > listened && ++listened, "the box to restart");
  return { url, ask, logIn, code, restarted };
}

/** A team at work: one of every kind of message, and one that is refused. */
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
