// Makes the pictures of the monitor in docs/how-to: node pictures.mjs pictures BINARIES SOURCES CHROMIUM FOLDER
// FOLDER: of scripts/demo. Started by scripts/monitor.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { chromium } from "playwright-core";
import { Pipeline, PORT, until } from "./pipeline.mjs";

const [, binaries, sources, executablePath, folder] = process.argv.slice(2);
const pipeline = new Pipeline(binaries, sources);
const sequence = (name) => join(folder, "sequence", name);
const first = readFileSync(sequence("truth.tum"), "utf8").split("\n").find((line) => /^\d/.test(line));
Object.assign(pipeline.environment, {
  EVIT_LOG: join(folder, "sequence.lcmlog"),
  EVIT_MAP: sequence("map.pcd"),
  EVIT_RIG: sequence("rig.textproto"),
  EVIT_START: first.trim().split(/\s+/).slice(1).join(" "),
});
const browser = await chromium.launch({
  executablePath,
  args: ["--no-sandbox", "--disable-gpu-compositing", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-dev-shm-usage"],
});
const seconds = (page) => page.textContent("#place").then((place) => Number(/^([\d.]+) of/.exec(place)?.[1] ?? NaN));
const wait = (time) => new Promise((done) => setTimeout(done, 1000 * time));

async function open(colorScheme) {
  const page = await browser.newPage({ viewport: { width: 1440, height: 900 }, colorScheme });
  await page.goto(`http://127.0.0.1:${PORT}/?points=all`);
  await until("the page", async () => (await page.textContent("#mode-name")) !== "connecting");
  return page;
}
async function take(page, name, selector) {
  const path = join(sources, "docs/how-to", name);
  await (selector ? page.locator(selector).screenshot({ path, timeout: 120_000 }) : page.screenshot({ path, timeout: 120_000 }));
  console.log(`${path}: ${await page.textContent("#mode-name")}, ${await page.textContent("#place")}`);
}
async function end(child) {
  const ended = new Promise((done) => child.on("exit", done));
  child.kill("SIGTERM");
  await ended;
}
const seek = (page, share) =>
  page.evaluate((value) => {
    const slider = document.querySelector("#seek");
    slider.value = String(1000 * value);
    slider.dispatchEvent(new Event("change"));
  }, share);
const headline = (page, name) => until(name, async () => (await page.textContent("#mode-name")) === name, 150);

async function pictures() {
  pipeline.monitor();
  await until("the server", () => fetch(`http://127.0.0.1:${PORT}/`).then((answer) => answer.ok).catch(() => false));
  const page = await open("light");
  await take(page, "monitor-empty.png");
  let up = pipeline.up();
  await headline(page, "tracking");
  // Slowly: a picture takes a while.
  await page.selectOption("#replay-speed", "0.25");
  await until("four seconds", async () => (await seconds(page)) > 4, 150);
  await page.selectOption("#replay-speed", "0.1");
  // A busy host saw that late, when little of the recording was left.
  await seek(page, 0.35);
  await until("five seconds", async () => Math.abs((await seconds(page)) - 5) < 0.4, 150);
  await headline(page, "tracking");
  await take(page, "monitor.png");
  const dark = await open("dark");
  await dark.click('[data-view="follow"]');
  await wait(3);
  await take(dark, "monitor-dark.png");
  await dark.close();
  await page.click('[data-view="camera"]');
  await wait(2);
  await take(page, "monitor-camera.png", "#map-panel");
  await page.click("#play");
  await headline(page, "paused");
  await page.click('[data-view="orbit"]');
  await page.click("#hint");
  await page.click("#hint-draw");
  const box = await page.locator("#map").boundingBox();
  await page.mouse.move(box.x + 0.42 * box.width, box.y + 0.62 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.62 * box.width, box.y + 0.6 * box.height, { steps: 5 });
  await page.mouse.up();
  await wait(1);
  await take(page, "monitor-hint.png");
  await page.click("#hint-cancel");
  await end(up);

  // Without a start pose: it looks for its place.
  delete pipeline.environment.EVIT_START;
  up = pipeline.up();
  await until("candidates", () => page.isVisible("#candidates"), 150);
  await take(page, "monitor-search.png");
  await end(up);
}

let failed = true;
try {
  await pictures();
  failed = false;
} catch (error) {
  console.log(error.stack, `\noutput of the programs:\n${pipeline.output.slice(-4000)}`);
} finally {
  await browser.close();
  await pipeline.end();
}
process.exit(failed ? 1 : 0);
