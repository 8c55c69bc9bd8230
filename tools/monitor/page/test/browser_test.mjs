// The page in a real browser, with a real pipeline. Usage: node browser_test.mjs BINARIES SOURCES CHROMIUM
import assert from "node:assert/strict";
import { chromium } from "playwright-core";
import { Pipeline, PORT, until } from "./pipeline.mjs";

const [binaries, sources, executablePath] = process.argv.slice(2);
const pipeline = new Pipeline(binaries, sources);
const browser = await chromium.launch({
  executablePath,
  args: ["--no-sandbox", "--disable-gpu-compositing", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-dev-shm-usage"],
});
const errors = [];
let page;

const text = (id) => page.textContent(`#${id}`);
const step = (name) => console.log(`${((performance.now()) / 1000).toFixed(1)} s: ${name}`);
const pidOf = (service) => page.getAttribute(`tr[data-service="${service}"]`, "data-pid").then(Number);
const seek = (share) =>
  page.evaluate((value) => {
    const slider = document.querySelector("#seek");
    slider.value = String(1000 * value);
    slider.dispatchEvent(new Event("change"));
  }, share);
const placeOf = async () => Number(/^([\d.]+) of/.exec(await text("place"))?.[1] ?? NaN);

const open = async (viewport, colorScheme = "light") => {
  const opened = await browser.newPage({ viewport, colorScheme });
  opened.setDefaultTimeout(0); // a busy host; CTest ends what never comes
  opened.on("pageerror", (error) => errors.push(error.message));
  return opened;
};

// Gives the pose at which the recording begins, as a viewer of its own.
const hintStart = () => {
  const [x, y, z, qx, qy, qz, qw] = pipeline.start.split(" ").map(Number);
  return page.evaluate(
    (order) =>
      new Promise((done) => {
        const socket = new WebSocket(`ws://${location.host}/`, "evit-monitor.v1");
        socket.onopen = () => socket.send(JSON.stringify(order));
        socket.onmessage = (event) => typeof event.data === "string" && event.data.includes('"answer"') && (socket.close(), done());
      }),
    { order: "hint", position: [x, y, z], orientation: [qx, qy, qz, qw] },
  );
};

async function test() {
  let monitor = pipeline.monitor();
  page = await open({ width: 800, height: 520 });
  // Between page and server, so that this test can say what a server says seldom.
  let line;
  await page.routeWebSocket(/./, (socket) => {
    socket.connectToServer();
    line = socket;
  });
  await until("the server", () => page.goto(`http://127.0.0.1:${PORT}/`).catch(() => null));
  await until("the page to say that nothing runs", async () => (await text("reason")).includes("waiting for"));
  assert.equal(await text("mode-name"), "no pipeline");
  assert.match(await text("map-empty"), /No pipeline is running.*evit run --log LOG/s);
  step("the page is open, nothing runs, and it says what starts a pipeline");

  // Candidates of a search, as the server sends them.
  const place = (x, significance) => ({ position: [x, 0, 1], orientation: [0, 0, 0, 1], significance });
  line.send(JSON.stringify({ type: "places", places: [place(1, 7.5), place(2, 3.1)] }));
  await until("the candidates", async () => (await page.locator("#candidates tr").count()) === 2);
  assert.match(await text("candidates"), /1\.00 +0\.00 +1\.00 m.*7\.5 σ/s);
  await page.click("#candidates tr:first-child button");
  await until("that nobody takes a pose yet", async () => (await text("answer")).includes("no pipeline is running"));
  line.send(JSON.stringify({ type: "places", places: [] }));
  await until("no candidates", () => page.isHidden("#candidates"));
  step("candidates of a search are listed, and one was given");

  // Every position that is shown, from now on.
  await page.evaluate(() => {
    window.positions = new Set();
    const place = document.querySelector("#position");
    new MutationObserver(() => window.positions.add(place.textContent)).observe(place, { childList: true, characterData: true, subtree: true });
  });
  const up = pipeline.up();
  await until("poses", async () => {
    if (await page.evaluate(() => window.positions.size >= 10)) return true;
    if ((await text("play")) === "Pause") return false;
    // A busy host: the recording was over before all services had started.
    await seek(0);
    await hintStart();
    return false;
  }, 150);
  await until("the whole map", async () => /^24,060 map points/.test(await text("about")));
  await until("the picture", async () => /\d ms/.test(await text("decay")));
  assert.equal(await text("map-empty"), "");
  step("connected during a run: the pose moves");

  await until("the end", async () => (await text("mode-name")) === "ended");
  assert.equal(await text("play"), "Play");
  assert.match(await text("reason"), /^the recording is over/);

  // One who comes late sees what has happened.
  const late = await open({ width: 800, height: 520 }, "dark");
  await late.goto(`http://127.0.0.1:${PORT}/`);
  await until("the past", async () => /mm/.test(await late.textContent("#sigma")));
  await until("the last picture", async () => /\d ms/.test(await late.textContent("#decay")));
  await until("the plots", async () => (await late.textContent("#plots-empty")) === "");
  await until("all points of the map drawn", async () => (await late.getAttribute("#map", "data-drawn")) === "24060");
  const calls = Number(await late.getAttribute("#map", "data-calls"));
  assert.ok(calls > 0 && calls < 30, `${calls} draw calls`);
  await late.close();
  step("a page that was opened after the end shows the last minute");

  assert.equal(await page.inputValue("#replay-speed"), "1");
  await page.selectOption("#replay-speed", "0.1"); // slow: on a busy host it would be over before the pause
  await page.click("#play"); // from the beginning
  await until("the first second again", async () => (await placeOf()) < 2.5);
  await page.click("#play");
  await until("the pause", async () => (await page.getAttribute('tr[data-service="log_replay"] .state', "data-kind")) === "wait");
  assert.equal(await text("mode-name"), "paused");
  await page.selectOption("#replay-speed", "1");
  const held = await placeOf();
  await seek(0.5);
  await until("the place sought", async () => Math.abs((await placeOf()) - 1.5) < 0.1);
  assert.notEqual(held, 1.5);
  step("paused and sought");

  // A pose by mouse: press, drag, send.
  await page.click("#hint");
  await page.keyboard.press("Escape");
  assert.ok(await page.isHidden("#hint-form"));
  await page.click("#hint");
  const before = await page.inputValue("#hint-x");
  await page.click("#hint-view"); // the map from where it is looked at
  assert.notEqual(await page.inputValue("#hint-x"), before);
  // The form is moved out of the way.
  const grip = await page.locator("#hint-grip").boundingBox();
  await page.mouse.move(grip.x + 20, grip.y + 5);
  await page.mouse.down();
  await page.mouse.move(grip.x - 380, grip.y + 5, { steps: 3 });
  await page.mouse.up();
  assert.ok((await page.locator("#hint-grip").boundingBox()).x < grip.x - 300);
  await page.click("#hint-draw");
  const box = await page.locator("#map").boundingBox();
  await page.mouse.move(box.x + 0.7 * box.width, box.y + 0.7 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.9 * box.width, box.y + 0.5 * box.height, { steps: 4 });
  await page.mouse.up();
  assert.notEqual(await page.inputValue("#hint-x"), before);
  await page.click("#hint-send");
  await until("the answer to a hint", async () => (await text("answer")).includes("pose sent"));
  assert.match(await text("map-legend"), /pose sent/); // until the tracker has tried it, which it cannot while paused
  step("gave a pose by mouse");

  // Figures of a body that is not tracked are none; a tracker that tries the pose and is lost has refused it.
  // Said again and again: what the tracker said before the pause may still be on its way.
  const say = (mode, reason) => line.send(JSON.stringify({ type: "mode", mode, reason }));
  await until("no figures", async () => {
    say("bootstrapping", "restarting from a pose hint");
    return (await text("sigma")) === "–" && (await text("speed")) === "–";
  });
  assert.ok(await page.locator("#position[data-stale]").count());
  assert.match(await text("map-legend"), /where it was last/);
  await until("the refusal", async () => {
    say("lost", "the map does not lie on the events");
    return (await text("answer")).includes("does not find the map around the pose sent");
  });
  assert.doesNotMatch(await text("map-legend"), /pose sent/);
  step("a pose was refused, and no figure is shown as if it held");

  // From the beginning: it tracks again, though nobody gives it the pose.
  await seek(0);
  await until("what was done", async () => (await text("answer")).includes("where the body was then"));
  await page.click("#play");
  await until("tracking again", async () => (await text("mode-name")) === "tracking" || (await placeOf()) >= 3);
  await until("figures", async () => /mm/.test(await text("sigma")));
  await hintStart();
  step("the replay went back and was tracked again; a second viewer came and went");

  for (const service of ["map_server", "frame_builder", "window_optimizer", "log_replay"]) {
    const pid = await until(`the process of ${service}`, () => pidOf(service));
    process.kill(pid, "SIGKILL");
    await until(`${service} again`, async () => ![0, pid].includes(await pidOf(service)));
  }
  step("each service died and was seen again");
  const pid = await pidOf("map_server");
  await page.click('tr[data-service="map_server"] button');
  await until("the restart that was ordered", async () => ![0, pid].includes(await pidOf("map_server")));
  step("restarted a service by its button");

  process.kill(Pipeline.childrenOf(monitor.pid)[0], "SIGKILL");
  await until("the page to notice", async () => (await text("reason")).includes("does not answer"));
  assert.equal(await text("mode-name"), "no monitor");
  await until("the page again", async () => !(await text("reason")).includes("does not answer"));
  monitor.kill("SIGTERM");
  await until("the page to notice", async () => (await text("reason")).includes("does not answer"));
  assert.equal(await new Promise((done) => (monitor.exitCode !== null ? done(monitor.exitCode) : monitor.on("exit", done))), 0);
  monitor = pipeline.monitor("--read-only");
  await until("the page again", async () => (await text("about")).includes("read-only"));
  assert.ok(await page.isDisabled("#play"));
  step("the monitor's worker died, the monitor was stopped and started again");
  up.kill("SIGTERM");
  await until("the end of the pipeline", () => up.exitCode !== null);
  await pauseARun();
}

// evit run tells the replay to begin; a pause after that is the viewer's, and holds. Slow: a minute, for a busy host.
async function pauseARun() {
  const run = pipeline.run("run", "--realtime", "--speed", "0.05", "--log", pipeline.environment.EVIT_LOG, "--map", pipeline.environment.EVIT_MAP, "--rig",
    pipeline.environment.EVIT_RIG, "--initial-pose", pipeline.start, "--out", "result", "--monitor", "--monitor-port", String(PORT + 1));
  const other = await open({ width: 800, height: 520 });
  const read = (id) => other.textContent(`#${id}`);
  await until("the run's page", () => other.goto(`http://127.0.0.1:${PORT + 1}/`).catch(() => null));
  await until("the run", async () => parseFloat(await read("place")) > 0.1);
  assert.equal(await other.inputValue("#replay-speed"), "0.05");
  let clicked = 0;
  await until("the pause", async () => {
    if (Date.now() - clicked > 15000) { // on a busy host the order may get lost, as any datagram: a viewer clicks again
      await other.click("#play");
      clicked = Date.now();
    }
    return (await read("mode-name")) === "paused";
  });
  const place = await read("place");
  await new Promise((done) => setTimeout(done, 2000)); // orders to begin came every half second
  assert.equal(await read("place"), place);
  assert.equal(await read("mode-name"), "paused");
  await other.click("#play");
  await until("it goes on", async () => (await read("place")) !== place);
  run.kill("SIGINT");
  await until("the run's end", () => run.exitCode !== null);
  step("a run was paused and went on");
}

let failed = true;
try {
  await test();
  assert.deepEqual(errors, []);
  failed = false;
} catch (error) {
  console.log(error.stack, errors, `\noutput of the programs:\n${pipeline.output}`);
} finally {
  await browser.close();
  await pipeline.end();
}
process.exit(failed ? 1 : 0);
