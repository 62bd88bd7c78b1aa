// A scene behind the box's TLS server.
import { execFileSync, spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { connect, createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { serve } from "./stage.js";

async function freePort() {
  const server = createServer().listen(0, "127.0.0.1");
  await once(server, "listening");
  const { port } = server.address();
  server.close();
  await once(server, "close");
  return port;
}

async function untilOpen(port) {
  for (;;) {
    const socket = connect(port, "127.0.0.1");
    const isOpen = await Promise.race([once(socket, "connect").then(() => true), once(socket, "error").then(() => false)]).catch(() => false);
    socket.destroy();
    if (isOpen) return;
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
}

/** A key and a certificate that signs itself, in one file. */
export function makePem(folder) {
  const key = join(folder, "key"), certificate = join(folder, "certificate");
  execFileSync("openssl", ["req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-noenc", "-days", "9", "-subj", "/CN=adit.local",
    "-keyout", key, "-out", certificate], { stdio: "ignore" });
  const pem = join(folder, "tls.pem");
  writeFileSync(pem, readFileSync(key, "utf8") + readFileSync(certificate, "utf8"), { mode: 0o600 });
  return pem;
}

/** As serve(), for a page over HTTPS; `pem`: the server's file. */
export async function serveByTls(scene, ...more) {
  const stage = await serve(scene, 0, "by-tls", ...more), port = await freePort();
  const folder = mkdtempSync(join(tmpdir(), "adit-tls-")), pem = makePem(folder), settings = join(folder, "tls.conf");
  writeFileSync(settings, `foreground = yes\npid =\n[page]\naccept = 127.0.0.1:${port}\nconnect = 127.0.0.1:${stage.port}\nprotocol = proxy\ncert = ${pem}\n`);
  const server = spawn("stunnel4", [settings], { stdio: "ignore" });
  await untilOpen(port);
  return {
    ...stage, pem, folder, url: `https://127.0.0.1:${port}/`,
    async end() {
      server.kill();
      await once(server, "exit");
      await stage.end();
      rmSync(folder, { recursive: true });
    },
  };
}
