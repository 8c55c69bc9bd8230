// For tests: a pipeline on the sample log and a monitor, each a process of its own, in this network namespace.
import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

export const PORT = 8080;

export class Pipeline {
  constructor(binaries, sources) {
    this.binaries = binaries;
    this.folder = mkdtempSync(join(tmpdir(), "evit_monitor_"));
    const first = readFileSync(join(sources, "logs/sample_truth.tum"), "utf8").split("\n").find((line) => /^\d/.test(line));
    this.start = first.trim().split(/\s+/).slice(1).join(" ");
    this.environment = {
      ...process.env,
      // What others find a pipeline by is this test's own.
      XDG_RUNTIME_DIR: this.folder,
      EVIT_LOG: join(sources, "logs/sample.lcmlog"),
      EVIT_MAP: join(sources, "logs/sample_map.pcd"),
      EVIT_RIG: join(sources, "logs/rig.textproto"),
      EVIT_START: this.start,
    };
    this.output = "";
    this.children = new Set();
  }

  run(...words) {
    const child = spawn(join(this.binaries, "evit"), words, { cwd: this.folder, env: this.environment });
    for (const stream of [child.stdout, child.stderr]) stream.on("data", (text) => (this.output += text));
    this.children.add(child);
    child.on("exit", () => this.children.delete(child));
    return child;
  }
  up() {
    return this.run("up", "evit.procman", "replay");
  }
  monitor(...more) {
    return this.run("monitor", "--port", String(PORT), ...more);
  }
  // Process ids of a process's children.
  static childrenOf(pid) {
    return readdirSync("/proc").filter((name) => /^\d+$/.test(name)).map(Number).filter((child) => {
      try {
        const stat = readFileSync(`/proc/${child}/stat`, "utf8");
        return Number(stat.slice(stat.lastIndexOf(")") + 4).split(" ")[0]) === pid;
      } catch {
        return false; // it has just ended
      }
    });
  }
  async end() {
    const ended = [...this.children].map((child) => new Promise((done) => child.on("exit", done)));
    for (const child of this.children) child.kill("SIGTERM");
    await Promise.all(ended);
    rmSync(this.folder, { recursive: true, force: true });
  }
}

// Waits until it holds. Long: a busy host is slow, and only what never comes is an error.
export async function until(what, holds, seconds = 180) {
  const end = Date.now() + 1000 * seconds;
  for (;;) {
    const value = await holds();
    if (value) return value;
    if (Date.now() > end) throw new Error(`waited in vain for: ${what}`);
    await new Promise((done) => setTimeout(done, 100));
  }
}
