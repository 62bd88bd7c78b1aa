// A box with two interfaces and adit-network, and a station on the team's network, each in a network namespace (../alone).
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { once } from "node:events";
import { chmodSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { fileURLToPath } from "node:url";
import { until } from "./box.js";
import { BIN, CHROMIUM, launch, visit } from "./stage.js";

const STAND_IN = fileURLToPath(new URL("../wire/stand_in_networkctl", import.meta.url));
const BOX = `aditbox${process.pid}`, STATION = `aditsta${process.pid}`;
const AS_IT_COMES = { team0: "192.168.7.11/24", darpa0: "10.100.1.10/24" };
const ASKED = ["wanted.json", "word.json", "probe.json", "endpoints.json", "forget.json"];

const ip = (...words) => execFileSync("ip", words, { stdio: "pipe" });

/** Connects team0 of the box with the station, which has an address in each tested subnet, and darpa0 with an unused end. */
function connect() {
  for (const name of [BOX, STATION]) {
    ip("netns", "add", name);
    ip("-n", name, "link", "set", "lo", "up");
  }
  ip("-n", BOX, "link", "add", "team0", "type", "veth", "peer", "name", "lan0", "netns", STATION);
  ip("-n", BOX, "link", "add", "darpa0", "type", "veth", "peer", "name", "wan0", "netns", STATION);
  // Chromium cancels its requests when the machine gets an address, as IPv6 would add one by itself. again.test.js covers that.
  for (const link of ["lan0", "wan0"]) ip("-n", STATION, "link", "set", link, "addrgenmode", "none");
  for (const [name, link] of [[BOX, "team0"], [BOX, "darpa0"], [STATION, "lan0"], [STATION, "wan0"]]) ip("-n", name, "link", "set", link, "up");
  for (const address of ["192.168.7.2/24", "192.168.8.2/24"]) ip("-n", STATION, "address", "add", address, "dev", "lan0");
  for (const [name, address] of Object.entries(AS_IT_COMES)) ip("-n", BOX, "address", "add", address, "dev", name);
}

export class NetworkedBox {
  folder = mkdtempSync(join(tmpdir(), "adit-network-page-"));
  state = join(this.folder, "state");
  #running = new Set();
  #isOpen = true;
  #isChanging = false;

  #start(space, ...words) {
    const program = spawn("ip", ["netns", "exec", space, ...words], { stdio: ["ignore", "pipe", "pipe"] });
    this.#running.add(program);
    program.said = "";
    for (const stream of [program.stdout, program.stderr]) stream.on("data", (piece) => (program.said += piece));
    program.once("exit", () => this.#running.delete(program));
    return program;
  }

  /** Runs adit-network as its units do: once per request, one at a time. */
  async #serveNetwork() {
    const networkctl = join(this.folder, "networkctl");
    writeFileSync(networkctl, `#!/bin/sh\nexec ${STAND_IN} ${this.folder}/files "$@"\n`);
    chmodSync(networkctl, 0o755);
    const folders = ["status", "networkd", "files"].map((name) => join(this.folder, name));
    for (const folder of [this.state, ...folders]) mkdirSync(folder);
    const [status, state, files] = folders;
    for (const [name, address] of Object.entries(AS_IT_COMES)) {
      writeFileSync(join(files, `60-${name}.network`), `[Match]\nName=${name}\n[Address]\nAddress=${address}\n`);
    }
    const run = () => once(this.#start(BOX, join(BIN, "adit-network"), "--networkctl", networkctl, "--wanted", this.state,
      "--status", status, "--state", state, "--networkd", files, "--factory", join(this.folder, "none")), "exit");
    await run();
    const follow = async () => {
      while (this.#isOpen) {
        this.#isChanging = this.#isAsked();
        if (this.#isChanging) await run();
        else await sleep(50);
      }
    };
    follow();
  }

  async begin(confirmWithin) {
    connect();
    chmodSync(this.folder, 0o755);
    const at = (address) => ({ address, port: 8000 });
    const settings = {
      version: 1,
      command_post: { scoring: at("10.100.1.200"), mapping: at("10.100.1.201"), interface: "darpa0" },
      team: { listen: [at("0.0.0.0")], interface: "team0" },
      network: { confirm_within_ms: confirmWithin },
    };
    writeFileSync(join(this.folder, "settings.json"), JSON.stringify(settings));
    mkdirSync(join(this.folder, "secrets"), { mode: 0o700 });
    await this.#serveNetwork();
    const aditd = this.#start(BOX, join(BIN, "aditd"), "--settings", join(this.folder, "settings.json"), "--secrets", join(this.folder, "secrets"),
      "--state", this.state, "--network", join(this.folder, "status"));
    const failed = () => aditd.exitCode !== null && Promise.reject(new Error(`aditd: ${aditd.said}`));
    await until(() => aditd.said.includes("listening") || failed(), "aditd");
    const chromium = join(this.folder, "chromium");
    writeFileSync(chromium, `#!/bin/sh\nexec ip netns exec ${STATION} ${CHROMIUM} "$@"\n`);
    chmodSync(chromium, 0o755);
    this.browser = await launch(chromium);
    return this;
  }

  #isAsked = () => ASKED.some((name) => existsSync(join(this.state, name)));
  /** Whether no request is pending and adit-network, which reverts unconfirmed changes, has ended. */
  isAtRest = () => !this.#isAsked() && !this.#isChanging;

  code = () => readFileSync(join(this.state, "first-start.code"), "utf8").trim();
  /** The address of team0: "192.168.7.11/24". */
  address() {
    const [link] = JSON.parse(ip("-n", BOX, "-4", "-j", "address", "show", "dev", "team0"));
    return (link?.addr_info ?? []).map(({ local, prefixlen }) => `${local}/${prefixlen}`).join(" ");
  }
  /** Plugs the station's end of a cable in, or out. */
  plug = (link, isIn) => ip("-n", STATION, "link", "set", link, isIn ? "up" : "down");
  visit = (url) => visit(this.browser, url);

  async close() {
    this.#isOpen = false;
    await this.browser?.close();
    for (const program of this.#running) {
      program.kill("SIGKILL");
      await once(program, "exit");
    }
    for (const name of [BOX, STATION]) spawnSync("ip", ["netns", "delete", name]);
    rmSync(this.folder, { recursive: true, force: true, maxRetries: 20, retryDelay: 50 });
  }
}
