// A proxy before the rehearsal's mapping endpoint. It rejects messages that name certain robots and passes on all others.
import { once } from "node:events";
import { createServer, request } from "node:http";
import { gunzipSync } from "node:zlib";

class PickyPost {
  refuses = new Map();  // a robot's name and the status for its messages
  taken = [];  // names of robots whose messages the rehearsal answered 200
  #server = createServer((asked, answer) => this.#hear(asked, answer));

  async begin() {
    this.#server.listen(0, "127.0.0.1");
    await once(this.#server, "listening");
    this.port = this.#server.address().port;
    return this;
  }
  end() {
    this.#server.closeAllConnections();
    this.#server.close();
  }

  async #hear(asked, answer) {
    const pieces = [];
    for await (const piece of asked) pieces.push(piece);
    const body = Buffer.concat(pieces);
    const said = (asked.headers["content-encoding"] === "gzip" ? gunzipSync(body) : body).toString("latin1");
    const name = /robot_\d+/.exec(said)?.[0], status = this.refuses.get(name);
    if (!status) return this.#passOn(asked, body, name, answer);
    answer.writeHead(status, { "Content-Type": "application/json" });
    answer.end(JSON.stringify(`${name} is not to my taste`));
  }

  #passOn({ method, url, headers }, body, name, answer) {
    const on = request({ host: "127.0.0.1", port: this.behind, method, path: url, headers, agent: false }, (back) => {
      if (back.statusCode === 200) this.taken.push(name);
      answer.writeHead(back.statusCode, back.headers);
      back.pipe(answer);
    });
    on.on("error", () => answer.destroy());
    on.end(body);
  }
}

/** For one test; `behind` is the port of the rehearsal's mapping endpoint. */
export async function pickyPost(t) {
  const post = await new PickyPost().begin();
  t.after(() => post.end());
  return post;
}
