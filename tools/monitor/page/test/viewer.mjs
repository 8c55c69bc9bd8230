// A viewer without a screen, as a process of its own: takes all that a page takes and says at once that each picture was
// drawn. Usage: node viewer.mjs PORT; prints what it got, once a second, as JSON.
import { WebSocket } from "ws";

const port = process.argv[2];
const got = { pictures: 0, frames: 0, bytes: 0 };
const PICTURE = 4;
const socket = new WebSocket(`ws://127.0.0.1:${port}/`, "evit-monitor.v1", { origin: `http://127.0.0.1:${port}` });
socket.on("message", (data, binary) => {
  got.frames += 1;
  got.bytes += data.length;
  if (!binary || data.readUInt32LE(0) !== PICTURE) return;
  got.pictures += 1;
  socket.send(JSON.stringify({ order: "drawn", utime: data.readDoubleLE(8) }));
});
socket.on("error", (error) => (console.error(error.message), process.exit(1)));
socket.on("close", () => process.exit(0));
setInterval(() => console.log(JSON.stringify(got)), 1000);
