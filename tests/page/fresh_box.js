// A box as delivered: aditd with an empty state directory and without tokens, and a rehearsal Command Post.
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before } from "node:test";
import { freePort, ONCE, until } from "./box.js";
import { BIN, launch, leave, visit } from "./stage.js";

export { freePort, until };

export const TOKENS = { scoring: "flux230{showroom", mapping: "rust871}backdoor", team: "team-own-token-1" };
export const PASSWORD = "a long cave password", LOOKING = "look, do not touch";

class FreshBox {
  folder = mkdtempSync(join(tmpdir(), "adit-setup-"));
  state = join(this.folder, "state");
  #programs = {};

  get url() {
    return `http://127.0.0.1:${this.port}/`;
  }

  start(name, ...words) {
    const program = spawn(join(BIN, name), words, { stdio: ["ignore", "pipe", "pipe"] });
    program.said = "";
    for (const stream of [program.stdout, program.stderr]) stream.on("data", (piece) => (program.said += piece));
    return (this.#programs[name] = program);
  }

  async end(name, signal = "SIGTERM") {
    const program = this.#programs[name];
    if (!program || program.exitCode !== null || program.signalCode !== null) return;
    program.kill(signal);
    await once(program, "exit");
  }

  /** Stops aditd, as a box that falls silent; or continues it. */
  freeze = () => this.#programs.aditd.kill("SIGSTOP");
  thaw = () => this.#programs.aditd.kill("SIGCONT");

  async begin({ settings = {}, secrets = [] } = {}) {
    const held = join(this.folder, "held"), given = join(this.folder, "secrets");
    for (const folder of [held, given]) mkdirSync(folder, { mode: 0o700 });
    const keep = (folder, name) => writeFileSync(join(folder, `${name}.token`), TOKENS[name], { mode: 0o600 });
    for (const name of Object.keys(TOKENS)) keep(held, name);
    for (const name of secrets) keep(given, name);
    const truth = join(this.folder, "artifacts.csv");
    await once(this.start("adit-robots", "--seed", "7", "--generate-only", "--truth", truth), "exit");
    const post = this.start("adit-rehearsal", "--scoring", "127.0.0.1:0", "--mapping", "127.0.0.1:0", "--control", "127.0.0.1:0", "--secrets", held, "--artifacts", truth);
    const ports = await until(() => /scoring \S+:(\d+),? mapping \S+:(\d+),? control \S+:(\d+)/.exec(post.said), "the rehearsal");
    [this.scoring, this.mapping, this.control] = ports.slice(1).map(Number);
    this.port = await freePort();
    const at = (port) => ({ address: "127.0.0.1", port });
    this.settings = { version: 1, command_post: { scoring: at(1), mapping: at(2) }, team: { listen: [at(this.port)] }, ...settings };
    writeFileSync(join(this.folder, "settings.json"), JSON.stringify(this.settings));
    await this.startAditd();
    return this;
  }

  async startAditd() {
    const aditd = this.start("aditd", "--settings", join(this.folder, "settings.json"), "--secrets", join(this.folder, "secrets"), "--state", this.state);
    await until(() => fetch(this.url).then(({ ok }) => ok, () => aditd.exitCode !== null && Promise.reject(new Error(aditd.said))), "aditd");
  }

  code = () => readFileSync(join(this.state, "first-start.code"), "utf8").trim();

  /** An operator's own session, by password. `ask(path, body)` returns {status, said}; with a body it posts. */
  async operator() {
    const post = (path, body, headers = ONCE) =>
      fetch(this.url.slice(0, -1) + path, { method: "POST", headers: { "Content-Type": "application/json", ...headers }, body: JSON.stringify(body) });
    const answer = await post("/adit/login", { password: PASSWORD });
    const { csrf } = await answer.json();
    const headers = { ...ONCE, Cookie: answer.headers.get("Set-Cookie").split(";")[0], "Adit-CSRF": csrf };
    return async (path, body) => {
      const said = body === undefined ? await fetch(this.url.slice(0, -1) + path, { headers }) : await post(path, body, headers);
      return { status: said.status, said: await said.json().catch(() => null) };
    };
  }

  /** Sets the passwords as the first start does, and returns an operator's session. */
  async settle() {
    const first = { role: "operator", code: this.code(), password: PASSWORD };
    await fetch(`${this.url}adit/password`, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(first) });
    const ask = await this.operator();
    await ask("/adit/password", { role: "viewer", current: PASSWORD, password: LOOKING });
    return ask;
  }

  async close() {
    for (const name of Object.keys(this.#programs)) await this.end(name, "SIGKILL");
    rmSync(this.folder, { recursive: true, force: true, maxRetries: 20, retryDelay: 50 });
  }
}

let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

/** A box for one test. */
export async function freshBox(t, options) {
  const box = new FreshBox();
  t.after(() => box.close());
  return box.begin(options);
}

/** A page of the box for one test; with a password: logged in, at `path`. */
export async function come(t, box, path, password, options = {}) {
  const page = await visit(browser, box.url + path, options);
  t.after(() => leave(page));
  if (!password) return page;
  await page.locator("#login").getByLabel("Password").fill(password);
  await page.keyboard.press("Enter");
  await page.waitForURL((url) => !url.pathname.includes("login"));
  return page;
}
