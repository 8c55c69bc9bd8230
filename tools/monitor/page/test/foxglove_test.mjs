// The Foxglove protocol, with its own client: node foxglove_test.mjs BINARIES SOURCES
import assert from "node:assert/strict";
import foxglove from "@foxglove/ws-protocol";
import protobuf from "protobufjs";
import descriptor from "protobufjs/ext/descriptor.js";
import { WebSocket } from "ws";
import { Pipeline, PORT, until } from "./pipeline.mjs";

const { FoxgloveClient } = foxglove;
const [binaries, sources] = process.argv.slice(2);
const pipeline = new Pipeline(binaries, sources);
const channels = new Map();
const messages = new Map(); // by topic
const topics = new Map(); // by subscription

function decoderOf(channel) {
  assert.equal(channel.encoding, "protobuf");
  assert.equal(channel.schemaEncoding, "protobuf");
  const files = descriptor.FileDescriptorSet.decode(Buffer.from(channel.schema, "base64"));
  return protobuf.Root.fromDescriptor(files).lookupType(channel.schemaName);
}

// Nothing is told twice: the client listens before the line is open.
async function test() {
  pipeline.monitor();
  await until("the server", () => fetch(`http://127.0.0.1:${PORT}/`).then((answer) => answer.ok).catch(() => false));
  const socket = new WebSocket(`ws://127.0.0.1:${PORT}/`, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]);
  const client = new FoxgloveClient({ ws: socket });
  let info = null;
  client.on("error", (error) => assert.fail(error));
  client.on("serverInfo", (message) => (info = message));
  client.on("advertise", (advertised) => {
    for (const channel of advertised) {
      channels.set(channel.topic, decoderOf(channel));
      topics.set(client.subscribe(channel.id), channel.topic);
    }
  });
  client.on("message", ({ subscriptionId, timestamp, data }) => {
    const topic = topics.get(subscriptionId);
    const bytes = new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
    const list = messages.get(topic) ?? [];
    list.push({ timestamp, content: channels.get(topic).decode(bytes) });
    messages.set(topic, list);
  });
  pipeline.up();
  for (const topic of ["/pose", "/tf", "/truth", "/map", "/surface", "/diagnostics"]) {
    await until(`a message on ${topic}`, () => messages.has(topic));
  }
  await until("poses that move", () => messages.get("/pose").length > 10);
  assert.equal(info?.name, "evit monitor");
  const [first, last] = [messages.get("/pose").at(0), messages.get("/pose").at(-1)];
  assert.ok(last.timestamp > first.timestamp);
  assert.equal(first.content.frame_id, "map");
  const { x, y, z, w } = last.content.pose.orientation;
  assert.ok(Math.abs(Math.hypot(x, y, z, w) - 1) < 1e-6);
  // The first one holds the points seen so far; all come once map_server's file has been found.
  await until("the whole map", () => {
    const map = messages.get("/map").at(-1).content;
    return map.data.length === 24060 * map.point_stride;
  });
  const image = messages.get("/surface").at(-1).content;
  assert.equal(image.data.length, image.height * image.step);
  assert.ok(messages.get("/diagnostics").some(({ content }) => content.name === "tracker"));
  socket.close();
}

let failed = true;
try {
  await test();
  failed = false;
} catch (error) {
  console.log(error.stack, [...messages.keys()], `\noutput of the programs:\n${pipeline.output}`);
} finally {
  await pipeline.end();
}
process.exit(failed ? 1 : 0);
