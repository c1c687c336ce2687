// Our programs as child processes that never outlive the test that started them.
import { spawn, spawnSync } from "node:child_process";
import path from "node:path";

/** Where the programs are: --test has no arguments of its own, so ctest says it by the environment. */
const bin = process.env.BIOTOMY_BIN;
if (!bin) throw new Error("BIOTOMY_BIN must name the folder of biotomy, biotomyd and biotomy-sim");

const tool = path.join(bin, "biotomy");
const wholeOutput = 64 * 1024 * 1024; // bytes

/** Runs the tool `biotomy` to its end. */
export function biotomy(...words) {
  const { status, stdout, stderr } = spawnSync(tool, words, {
    encoding: "utf8",
    maxBuffer: wholeOutput,
  });
  return { status, stdout, stderr };
}

/** A program that runs until it is told to end. */
export class Program {
  #child;
  #ended;
  output = "";

  /** `name`: of one of our programs, or a path. */
  constructor(name, words, folder) {
    const file = name.includes("/") ? name : path.join(bin, name);
    // A test that is killed takes its programs with it: the kernel sees to that.
    this.#child = spawn("setpriv", ["--pdeathsig", "KILL", file, ...words], {
      cwd: folder,
      stdio: ["ignore", "pipe", "pipe"],
    });
    for (const stream of [this.#child.stdout, this.#child.stderr]) {
      stream.setEncoding("utf8").on("data", (text) => (this.output += text));
    }
    this.#ended = new Promise((resolve, reject) => {
      this.#child.on("error", reject);
      this.#child.on("close", (code, signal) => resolve(signal ?? code));
    });
    this.#ended.catch(() => {});
    this.name = path.basename(file);
  }

  get runs() {
    return this.#child.exitCode === null && this.#child.signalCode === null;
  }

  /** The rest of the line after `text`, once the program has printed it. */
  async says(text, seconds = 60) {
    const limit = Date.now() + seconds * 1000;
    for (;;) {
      const at = this.output.indexOf(text);
      const end = this.output.indexOf("\n", at);
      if (at >= 0 && end >= 0) return this.output.slice(at + text.length, end);
      if (!this.runs || Date.now() > limit) {
        throw new Error(`${this.name} did not say "${text}": ${this.output}`);
      }
      await new Promise((resolve) => setTimeout(resolve, 20));
    }
  }

  signal(name) {
    this.#child.kill(name);
  }

  /** Sends `signal` and waits for the end: its exit code, or the signal that ended it. */
  async end(signal = "SIGTERM") {
    if (this.runs) this.#child.kill(signal);
    return this.#ended;
  }
}
