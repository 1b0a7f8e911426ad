// A client of CNCjs's socket API: node cncjs_relay.mjs PORT
// Each line of its stdin, a list in JSON, is an event for the server; each event of the server that
// says something of the machine is a line of JSON.
import { createRequire } from "node:module";
import { createInterface } from "node:readline";
const require = createRequire(process.cwd() + "/");
const connect = require("socket.io-client");

const address = `http://127.0.0.1:${process.argv[2]}`;
const signed = await fetch(`${address}/api/signin`, {
  method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify({ token: "" }) });
const { token } = await signed.json();
const socket = connect(address, { query: `token=${token}` });
const tell = (...message) => process.stdout.write(JSON.stringify(message) + "\n");

for (const event of ["connect", "serialport:open", "serialport:error", "serialport:read",
  "controller:state", "sender:status", "workflow:state"])
  socket.on(event, (...told) => tell(event, ...told));
const input = createInterface({ input: process.stdin });
input.on("line", (line) => socket.emit(...JSON.parse(line)));
input.on("close", () => process.exit(0));
