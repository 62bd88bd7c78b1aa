// Compares the API description that a real aditd serves with that aditd: every path and method in it.
import assert from "node:assert/strict";
import { test } from "node:test";
import Ajv from "ajv/dist/2020.js";
import { OPERATOR, box, play, until } from "./box.js";

/** The description that the box serves. */
async function described() {
  const ends = [];
  const { ask } = await box({ after: (end) => ends.push(end) });
  const answer = await ask("GET", "/adit/openapi.json", { role: "nobody" });
  const description = await answer.json();
  for (const end of ends) await end();
  return description;
}

const api = await described();
const operations = Object.entries(api.paths).flatMap(([path, methods]) =>
  Object.entries(methods).map(([method, operation]) => ({ path, method: method.toUpperCase(), operation })));
const named = (operation, where) => (operation.parameters ?? []).filter((each) => each.in === where);

const ajv = new Ajv({ strict: true, allErrors: true, validateFormats: false, strictTypes: false, keywords: ["x-event", "example"] });
const refersByName = (schema) => JSON.parse(JSON.stringify(schema).replaceAll("#/components/schemas/", ""));
for (const [name, schema] of Object.entries(api.components.schemas)) ajv.addSchema({ $id: name, ...refersByName(schema) });

/** The violations of a schema of the description by a value. */
function faults(schema, value) {
  const check = ajv.compile(refersByName(schema));
  return check(value) ? [] : check.errors.map(({ instancePath, message, params }) => `${instancePath} ${message} ${JSON.stringify(params)}`);
}

const resolved = (response) => (response.$ref ? api.components.responses[response.$ref.split("/").at(-1)] : response);

/** Fails unless the description has this answer for the operation. */
async function isAsDescribed({ path, method, operation }, answer) {
  const what = `${method} ${path} ${answer.status}`;
  const response = operation.responses[answer.status];
  if (!response) assert.fail(`${what} is not described: ${await answer.text()}`);
  const [[type, content]] = Object.entries(resolved(response).content);
  assert.equal(answer.headers.get("Content-Type"), type, what);
  if (content.schema) assert.deepEqual(faults(content.schema, await answer.json()), [], what);
  if (content["x-event"]) assert.deepEqual(faults(content["x-event"], await firstEvent(answer)), [], what);
  if (!content.schema && !content["x-event"]) assert.ok((await answer.arrayBuffer()).byteLength > 0, what);
}

async function firstEvent(answer) {
  let text = "";
  for await (const bytes of answer.body) {
    text += Buffer.from(bytes).toString();
    const event = /^data: (.*)\n\n/m.exec(text);
    if (event) return JSON.parse(event[1]);
  }
}

/** A path with the description's examples, or with the values in `known`. */
function pathOf({ path, operation }, known = {}) {
  const value = (each) => String(known[each.name] ?? each.example);
  const filled = named(operation, "path").reduce((sum, each) => sum.replace(`{${each.name}}`, value(each)), path);
  const query = new URLSearchParams(named(operation, "query").filter((each) => "example" in each).map((each) => [each.name, value(each)]));
  return query.size ? `${filled}?${query}` : filled;
}

/** The description's example of a body; any bytes if the body is not JSON. */
const bodyOf = ({ operation }) => {
  const content = operation.requestBody?.content;
  return content && (content["application/json"]?.example ?? Buffer.from("no bundle"));
};

test("describes the answers to a body that is too long or invalid, wherever a body is read", () => {
  const taking = operations.filter(({ operation }) => operation.requestBody);
  assert.ok(taking.length > 20);
  const without = (status) => taking.filter(({ operation }) => !operation.responses[status]).map(({ path }) => path);
  assert.deepEqual([without(413), without(422)], [[], []]);
});

test("describes the answers to unauthenticated requests", () => {
  const guarded = operations.filter(({ operation }) => operation["x-adit-role"]);
  assert.ok(guarded.length > 20);
  assert.deepEqual(guarded.filter(({ operation }) => !operation.responses[401] || !operation.responses[403]).map(({ path }) => path), []);
});

test("every example fits its schema", () => {
  for (const each of operations) {
    for (const parameter of each.operation.parameters ?? []) {
      if ("example" in parameter) assert.deepEqual(faults(parameter.schema, parameter.example), [], `${each.path} ${parameter.name}`);
      else assert.equal(parameter.in, "query", `${each.path} ${parameter.name}`);
    }
    const body = each.operation.requestBody?.content["application/json"];
    if (body) assert.deepEqual(faults(body.schema, body.example), [], each.path);
    const bytes = each.operation.requestBody?.content["application/octet-stream"];
    if (each.method === "POST") assert.ok(body ?? bytes, `${each.path} has an example`);
  }
});

test("every path and method answers an operator as described", async (t) => {
  const { ask, logIn } = await box(t, { reports_hz: 0.001 });  // all reports except the first stay queued
  await play(ask);
  const map = await until(async () => (await (await ask("GET", "/adit/map")).json()).layers[0], "a picture of a map");
  const [tile] = map.tiles;
  const session = async () => {
    await logIn(OPERATOR);
    return (await (await ask("GET", "/adit/sessions")).json())[0].number;
  };
  const report = async (type) => (await (await ask("POST", "/adit/reports", { body: { type, x: 1, y: 2, z: 3 } })).json()).report;
  const state = async (number) => (await (await ask("GET", `/adit/reports/${number}`)).json()).state;
  const settled = async (number) => (await until(async () => /answered|settled/.test(await state(number)), `report ${number} to be answered, not ${await state(number)}`)) && number;
  const first = await settled(await report("Drill"));
  const withdrawn = await report("Helmet");
  const known = {
    "GET /adit/map/{kind}/{robot}/{level}/{x}/{y}.png": () => ({ kind: map.kind, robot: map.robot || "-", ...tile }),
    "GET /adit/runs/{key}/map/{kind}/{robot}/{level}/{x}/{y}.png": async () => {
      const kept = await until(async () => (await (await ask("GET", "/adit/runs/1/map")).json()).layers[0], "the run to be kept");
      return { key: "1", kind: kept.kind, robot: kept.robot || "-", ...kept.tiles[0] };
    },
    "POST /adit/sessions/{session}/end": async () => ({ session: await session() }),
    "POST /adit/reports/{number}/withdraw": () => ({ number: withdrawn }),
    "POST /adit/reports/{number}/hold": async () => ({ number: await report("Cube") }),
    "POST /adit/reports/{number}/send": () => ({ number: withdrawn }),
    "POST /adit/reports/{number}/correct": async () => {
      const number = await report("Rope");
      await ask("POST", `/adit/reports/${number}/hold`, { body: {} });
      return { number };
    },
    "POST /adit/reports/{number}/resubmit": () => ({ number: first }),
  };
  const current = async () => (await ask("GET", "/adit/settings")).json();
  const bodies = { "POST /adit/settings": async () => (({ settings, tag }) => ({ settings, base: tag }))(await current()) };
  const never = ["POST /adit/alarms/acknowledge",  // no alarm can be acknowledged
    "POST /adit/reports/{number}/settle", // no report is in doubt: 409
    "POST /adit/rejected/{number}/send", "POST /adit/rejected/{number}/discard",  // no message is rejected
    "POST /adit/network", "POST /adit/network/confirm", "POST /adit/network/revert",  // networks cannot be changed here
    "POST /adit/update", "POST /adit/update/stick", "POST /adit/update/restart", "POST /adit/update/back", "POST /adit/update/stay",  // the box cannot be updated here
    "POST /adit/spare/resume", "GET /adit/spare/export", "POST /adit/spare/to-stick",  // the box is not on standby
    "POST /adit/spare/from-stick",  // no stick is plugged in
    "POST /adit/spare/take", "POST /adit/spare/open", "POST /adit/spare/take-over",  // and no other box
    "POST /adit/ledger/new", // the ledger can be read
    "POST /adit/certificate", "POST /adit/certificate/new", // nothing makes certificates here
    "POST /adit/clock"];  // clocks are not set here
  for (const each of operations) {
    const name = `${each.method} ${each.path}`;
    if (name === "POST /adit/spare/standby") continue; // on standby the box rejects the next requests: box/spare.test.js
    const answer = await ask(each.method, pathOf(each, await known[name]?.()), { body: (await bodies[name]?.()) ?? bodyOf(each) });
    assert.equal(answer.ok, !never.includes(name), `${name}: ${answer.status}`);
    await isAsDescribed(each, answer);
    await until(async () => (await current()).applying === false, `${name} to be applied`);
  }
});
