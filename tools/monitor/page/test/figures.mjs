// What the monitor costs and how fast its page is: node figures.mjs WHAT BINARIES SOURCES CHROMIUM FOLDER [MINUTES [SPEED]]
// WHAT: points, latency, viewers, or soak; FOLDER: of scripts/demo. Started by scripts/monitor.
import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { loadavg, tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { Pipeline, PORT, until } from "./pipeline.mjs";

const [what, binaries, sources, executablePath, folder, minutes = "30", speed = "1"] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));
const SEQUENCE_S = 12; // length of the demo's sequence
const pipeline = new Pipeline(binaries, sources);
const log = join(folder, "sequence.lcmlog");
const sequence = (name) => join(folder, "sequence", name);
const out = mkdtempSync(join(tmpdir(), "evit_monitor_figures_"));
const wait = (seconds) => new Promise((done) => setTimeout(done, 1000 * seconds));
const say = (text) => console.log(text);
const browserArguments = ["--no-sandbox", "--disable-gpu-compositing", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-dev-shm-usage"];
const launch = (...more) => chromium.launch({ executablePath, args: [...browserArguments, ...more] });

const figure = (x, digits = 0) => (x === undefined || Number.isNaN(x) ? "-" : x.toFixed(digits));
const quantile = (values, share) => [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(share * values.length))];

async function serving() {
  await until("the server", () => fetch(`http://127.0.0.1:${PORT}/`).then((answer) => answer.ok).catch(() => false));
}
// A run in real time; its report.
async function run(name, loops = 1) {
  const result = join(out, name);
  const child = pipeline.run("run", "--log", log, "--map", sequence("map.pcd"), "--rig", sequence("rig.textproto"),
    "--initial-from", sequence("truth.tum"), "--realtime", "--speed", speed, "--loops", String(loops), "--out", result);
  const code = await new Promise((done) => child.on("exit", done));
  if (code !== 0) throw new Error(`evit run ended with ${code}:\n${pipeline.output}`);
  return JSON.parse(readFileSync(join(result, "report.json"), "utf8"));
}
// CPU seconds and resident MB of the worker below a monitor.
function costOf(monitor) {
  const pid = Pipeline.childrenOf(monitor.pid)[0];
  const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
  const pages = Number(readFileSync(`/proc/${pid}/statm`, "utf8").split(" ")[1]);
  return { cpu: (Number(fields[11]) + Number(fields[12])) / 100, memory: (pages * 4096) / 2 ** 20 };
}

// 500,000 points on the edges of boxes in a room, as PCD.
function writeLargeMap(path, n) {
  let state = 1;
  const random = () => (state = (state * 48271) % 2147483647) / 2147483647;
  const data = Buffer.alloc(12 * n);
  for (let i = 0; i < n; ++i) {
    const box = Math.floor(random() * 60);
    const size = 0.3 + ((box * 37) % 10) / 10;
    const corner = [((box * 7) % 10) - 5, ((box * 3) % 8) - 4, (box % 4) * 0.7];
    const axis = Math.floor(random() * 3);
    for (let k = 0; k < 3; ++k) {
      const along = k === axis ? random() : Math.round(random());
      data.writeFloatLE(corner[k] + size * along + 0.004 * (random() - 0.5), 12 * i + 4 * k);
    }
  }
  const head = `# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH ${n}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS ${n}\nDATA binary\n`;
  writeFileSync(path, Buffer.concat([Buffer.from(head), data]));
}

// Frames of the screen while the view moves (the wheel turns to and fro): how many a second, and how long apart.
async function moving(page, seconds) {
  const { stamps, data } = await page.evaluate(
    (milliseconds) =>
      new Promise((done) => {
        const canvas = document.querySelector("#map");
        const stamps = [];
        const tick = (now) => {
          stamps.push(now);
          canvas.dispatchEvent(new WheelEvent("wheel", { deltaY: stamps.length % 40 < 20 ? 4 : -4, cancelable: true }));
          if (now - stamps[0] < milliseconds) requestAnimationFrame(tick);
          else setTimeout(() => done({ stamps, data: { ...canvas.dataset } }), 0);
        };
        requestAnimationFrame(tick);
      }),
    1000 * seconds,
  );
  const apart = stamps.slice(1).map((stamp, i) => stamp - stamps[i]);
  return { ...data, frames: apart.length, rate: (1000 * apart.length) / (stamps.at(-1) - stamps[0]), p50: quantile(apart, 0.5), p99: quantile(apart, 0.99) };
}

// Counts what comes over the page's WebSockets: `window.received` (bytes) and `window.told` (ms, of pictures).
const countReceived = (page) =>
  page.addInitScript(() => {
    window.received = 0;
    window.told = [];
    const Original = window.WebSocket;
    window.WebSocket = class extends Original {
      constructor(...all) {
        super(...all);
        this.addEventListener("message", ({ data }) => {
          window.received += data.byteLength ?? data.length;
          if (typeof data === "string" && data.startsWith('{"picture_ms"')) window.told.push(JSON.parse(data).picture_ms);
        });
      }
    };
  });

async function points() {
  const n = 500_000;
  writeLargeMap(join(out, "large.pcd"), n);
  pipeline.monitor("--lcm-url", "udpm://239.255.76.67:7667?ttl=0", "--map", join(out, "large.pcd"));
  await serving();
  say(`host: load ${loadavg()[0].toFixed(1)}; graphics in software (SwiftShader), 1440 x 900`);
  say("| points | sent | until all are there | longest pause of the page | draw calls | drawn while it moves | frames/s | p50 ms | p99 ms | CPU ms a frame: graphics, page |\n|---|---|---|---|---|---|---|---|---|---|");
  const browser = await launch();
  for (const query of ["", "?points=all"]) {
    const page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
    await countReceived(page);
    await page.addInitScript(() => {
      window.longest = 0;
      let before = performance.now();
      const tick = (now) => ((window.longest = Math.max(window.longest, now - before)), (before = now), requestAnimationFrame(tick));
      requestAnimationFrame(tick);
    });
    const begun = performance.now();
    await page.goto(`http://127.0.0.1:${PORT}/${query}`);
    await page.waitForFunction((all) => document.querySelector("#map").dataset.points === String(all), n, { timeout: 60_000 });
    const seconds = (performance.now() - begun) / 1000;
    const longest = await page.evaluate(() => window.longest);
    const sent = await page.evaluate(() => window.received);
    await moving(page, 4); // until the share has settled
    const before = browserCost();
    const f = await moving(page, 6);
    const after = browserCost();
    const each = (kind) => figure((1000 * (after[kind] - before[kind])) / f.frames, 1);
    say(`| ${n.toLocaleString("en")} | ${figure(sent / 1e6, 2)} MB | ${figure(seconds, 1)} s | ${figure(longest)} ms | ${f.calls} | ${Number(f.drawn).toLocaleString("en")} | ${figure(f.rate, 1)} | ${figure(f.p50)} | ${figure(f.p99)} | ${each("gpu")}, ${each("page")} |`);
    await page.close();
  }
  await browser.close();
}

async function latency() {
  pipeline.monitor();
  await serving();
  const browser = await launch();
  say(`host: load ${loadavg()[0].toFixed(1)}; one page in Chromium, graphics in software, 1440 x 900`);
  const page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
  await countReceived(page);
  await page.goto(`http://127.0.0.1:${PORT}/`);
  const report = await run("latency");
  const told = await page.evaluate(() => window.told);
  await browser.close();
  say("| from the instant of a picture | n | p50 | p90 | p99 |\n|---|---|---|---|---|");
  say(`| until it is on the screen and the monitor has heard so, ms | ${told.length} | ${[0.5, 0.9, 0.99].map((share) => figure(quantile(told, share))).join(" | ")} |`);
  say(`of it, until WINDOW_STATE is there: p50 ${figure(report.pose_after_stamp?.p50_ms)} ms; p99 ${figure(report.pose_after_stamp?.p99_ms)} ms`);
}

async function viewers() {
  say(`host: load ${loadavg()[0].toFixed(1)}; viewers without a screen, each a process, that acknowledge every picture`);
  say("| viewers | monitor CPU, % of a core | monitor MB | pictures/s a viewer | keyframes dropped | pose p50 ms | pose p99 ms | solve ms | position error cm |\n|---|---|---|---|---|---|---|---|---|");
  const cases = [["no monitor", 0, false], ["0", 0, false], ["1", 1, false], ["8", 8, false], ["8, one stopped", 8, true], ["no monitor, again", 0, false]];
  for (const [name, n, stopped] of cases) {
    const monitor = name.startsWith("no monitor") ? null : pipeline.monitor();
    if (monitor) await serving();
    const children = Array.from({ length: n }, () => spawn(process.execPath, [join(here, "viewer.mjs"), String(PORT)]));
    const newest = new Map();
    for (const child of children) child.stdout.on("data", (text) => newest.set(child, JSON.parse(String(text).trim().split("\n").at(-1))));
    if (n) await until("the viewers", () => newest.size === n);
    if (stopped) children[0].kill("SIGSTOP");
    let cost = null;
    let before = null;
    // A monitor's worker is another one once it has found the pipeline.
    const sample = setInterval(() => {
      try {
        cost = costOf(monitor);
        before ??= { ...cost, at: performance.now(), pictures: newest.get(children.at(-1))?.pictures ?? 0 };
        cost.at = performance.now();
        cost.pictures = newest.get(children.at(-1))?.pictures ?? 0;
      } catch {
        before = null;
      }
    }, 500);
    const report = await run(name.replace(/\W/g, "_"));
    clearInterval(sample);
    for (const child of children) child.kill("SIGKILL");
    if (monitor) {
      const ended = new Promise((done) => monitor.on("exit", done));
      monitor.kill("SIGTERM");
      await ended;
    }
    const optimizer = report.services.find((service) => service.name === "window_optimizer");
    const seconds = before ? (cost.at - before.at) / 1000 : NaN;
    const stamp = report.pose_after_stamp ?? {};
    say(`| ${name} | ${monitor ? figure((100 * (cost.cpu - before.cpu)) / seconds, 1) : "-"} | ${monitor ? figure(cost.memory) : "-"} | ${n ? figure((cost.pictures - before.pictures) / seconds, 1) : "-"} | ${optimizer.counters["KEYFRAME.dropped"] ?? 0} | ${figure(stamp.p50_ms, 1)} | ${figure(stamp.p99_ms, 1)} | ${figure(report.mean_solve_ms, 2)} | ${figure(report.ate?.[0]?.all?.position_rmse_cm, 2)} |`);
  }
}

async function soak() {
  const monitor = pipeline.monitor();
  await serving();
  const browser = await launch("--js-flags=--expose-gc", "--enable-precise-memory-info");
  const page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
  page.setDefaultTimeout(0); // a busy host
  await page.goto(`http://127.0.0.1:${PORT}/`);
  let over = false;
  const begun = Date.now();
  // One run, as a monitor begins again with each; on a busy host it may end LOST, which is no matter here.
  const loops = Math.ceil((60 * Number(minutes) * Number(speed)) / SEQUENCE_S);
  const running = run("soak", loops)
    .catch((error) => say(error.message.split("\n")[0]))
    .finally(() => (over = true));
  say("| minute | monitor MB | page's JavaScript heap MB | page's process MB | pictures' latency p50 ms | headline |\n|---|---|---|---|---|---|");
  while (!over) {
    const heap = await page.evaluate(() => (window.gc?.(), performance.memory.usedJSHeapSize / 2 ** 20));
    const headline = await page.textContent("#mode-name");
    const p50 = await page.getAttribute("#latency", "data-picture-p50");
    let memory = NaN;
    try {
      memory = costOf(monitor).memory;
    } catch {
      // between two workers
    }
    say(`| ${((Date.now() - begun) / 60_000).toFixed(1)} | ${figure(memory, 1)} | ${figure(heap, 1)} | ${figure(browserCost().memory)} | ${figure(Number(p50 || NaN))} | ${headline} |`);
    for (let i = 0; i < 30 && !over; ++i) await wait(1);
  }
  await running;
  await browser.close();
}

// The processes of this test's browser: CPU seconds by kind, and MB of the largest that runs a page.
function browserCost() {
  const cost = { gpu: 0, page: 0, memory: 0 };
  const visit = (pid) => {
    for (const child of Pipeline.childrenOf(pid)) {
      visit(child);
      try {
        const words = readFileSync(`/proc/${child}/cmdline`, "utf8");
        const fields = readFileSync(`/proc/${child}/stat`, "utf8").split(") ")[1].split(" ");
        const cpu = (Number(fields[11]) + Number(fields[12])) / 100;
        if (words.includes("--type=gpu-process")) cost.gpu += cpu;
        if (!words.includes("--type=renderer")) continue;
        cost.page += cpu;
        cost.memory = Math.max(cost.memory, (Number(readFileSync(`/proc/${child}/statm`, "utf8").split(" ")[1]) * 4096) / 2 ** 20);
      } catch {
        // it has just ended
      }
    }
  };
  visit(process.pid);
  return cost;
}

let failed = true;
try {
  await { points, latency, viewers, soak }[what]();
  failed = false;
} catch (error) {
  console.log(error.stack, `\noutput of the programs:\n${pipeline.output.slice(-4000)}`);
} finally {
  await pipeline.end();
}
process.exit(failed ? 1 : 0);
