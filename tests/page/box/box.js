// The real programs for one test: aditd, a rehearsal Command Post, and robots if wanted.
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { freePort, until } from "../box.js";
import { BIN } from "../stage.js";

export const TOKENS = { scoring: "flux230{showroom", mapping: "rust871}backdoor", team: "team-own-token-1" };
export const PASSWORD = "correct horse battery";  // as in the examples of openapi.json

async function stop(program, signal = "SIGTERM") {
  if (!program || program.exitCode !== null || program.signalCode !== null) return;
  program.kill(signal);
  await once(program, "exit");
}

class Box {
  folder = mkdtempSync(join(tmpdir(), "adit-page-"));
  #programs = {};

  get url() {
    return `http://127.0.0.1:${this.port}/`;
  }
  get pid() {
    return this.#programs.aditd.pid;
  }

  #start(name, ...words) {
    const program = spawn(join(BIN, name), words, { stdio: ["ignore", "pipe", "pipe"] });
    let log = "";
    for (const stream of [program.stdout, program.stderr]) stream.on("data", (piece) => (log += piece));
    program.log = () => log;
    this.#programs[name] = program;
    return program;
  }

  async begin({ settings = {}, robots = 0, post = [] }) {
    mkdirSync(join(this.folder, "secrets"), { mode: 0o700 });
    for (const [name, token] of Object.entries(TOKENS)) writeFileSync(join(this.folder, `secrets/${name}.token`), token, { mode: 0o600 });
    const secrets = join(this.folder, "secrets"), truth = join(this.folder, "artifacts.csv");
    await once(this.#start("adit-robots", "--seed", "7", "--generate-only", "--truth", truth), "exit");
    const rehearsal = this.#start("adit-rehearsal", "--scoring", "127.0.0.1:0", "--mapping", "127.0.0.1:0", "--control", "127.0.0.1:0",
      "--secrets", secrets, "--artifacts", truth, ...post);
    const line = await until(() => /scoring \S+:(\d+) mapping \S+:(\d+) control \S+:(\d+)/.exec(rehearsal.log().replaceAll(",", "")), "the rehearsal");
    const [scoring, mapping, control] = line.slice(1).map(Number);
    this.mapping = mapping;
    this.control = `http://127.0.0.1:${control}`;
    this.port = await freePort();
    const at = (port) => ({ address: "127.0.0.1", port });
    const { command_post, ...others } = settings;
    writeFileSync(join(this.folder, "settings.json"), JSON.stringify({
      version: 1, command_post: { scoring: at(scoring), mapping: at(mapping), ...command_post }, team: { listen: [at(this.port)], connections: 256, connections_per_address: 256 }, ...others,
    }));
    await this.startAditd();
    this.code = readFileSync(join(this.folder, "state/first-start.code"), "utf8").trim();
    await this.ask("/adit/password", { role: "operator", code: this.code, password: PASSWORD });
    if (robots) {
      this.#start("adit-robots", "--post", this.url.slice(0, -1), "--secrets", secrets, "--seed", "7", "--robots", String(robots), "--speed", "2", "--quiet");
    }
    return this;
  }

  async startAditd() {
    const aditd = this.#start("aditd", "--settings", join(this.folder, "settings.json"), "--secrets", join(this.folder, "secrets"), "--state", join(this.folder, "state"));
    await until(() => fetch(this.url).then(({ ok }) => ok, () => aditd.exitCode !== null && Promise.reject(new Error(aditd.log()))), "aditd");
  }
  log = () => this.#programs.aditd.log();
  /** Stops the robots' programs; or continues them. */
  freezeRobots = () => this.#programs["adit-robots"].kill("SIGSTOP");
  thawRobots = () => this.#programs["adit-robots"].kill("SIGCONT");
  /** Kills the Command Post. */
  endPost = () => stop(this.#programs["adit-rehearsal"], "SIGKILL");
  killAditd = () => stop(this.#programs.aditd, "SIGKILL");

  /** Sends a request as the team's script does: {status, said}. With a body: POST. */
  async ask(path, body) {
    const headers = { Authorization: `Bearer ${TOKENS.team}` };
    const request = body === undefined ? { headers } : { method: "POST", headers: { ...headers, "Content-Type": "application/json" }, body: typeof body === "string" ? body : JSON.stringify(body) };
    const answer = await fetch(this.url.slice(0, -1) + path, request);
    return { status: answer.status, said: await answer.json().catch(() => null) };
  }
  run = async () => (await this.ask("/adit/run")).said;
  /** Composes a report as the operator and returns its number. */
  compose = async (type, x, y = 0, z = 0) => (await this.ask("/adit/reports", { type, x, y, z })).said.report;
  state = async (number) => (await this.ask(`/adit/reports/${number}`)).said.state;
  becomes = (number, state) => until(async () => (await this.state(number)) === state, `report ${number} to be ${state}`);

  /** The Command Post's record of requests; or sets its behaviour. */
  record = async () => (await fetch(`${this.control}/record`)).json();
  misbehave = (faults) => fetch(`${this.control}/faults`, { method: "POST", body: JSON.stringify(faults) });
  behave = () => fetch(`${this.control}/faults`, { method: "DELETE" });

  /** The lights of the simulated panel now: {health: true, ...}. */
  lights() {
    const lines = readFileSync(join(this.folder, "state/panel"), "utf8").trim().split("\n");
    return Object.fromEntries(lines.map((line) => line.split(" ")).map(([name, lit]) => [name, lit === "on"]));
  }

  async end() {
    for (const program of Object.values(this.#programs).reverse()) await stop(program, "SIGKILL");
    rmSync(this.folder, { recursive: true, force: true, maxRetries: 20, retryDelay: 50 });
  }
}

export const begin = (options = {}) => new Box().begin(options);
