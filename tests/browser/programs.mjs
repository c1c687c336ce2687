// Our programs as child processes that never outlive the test that started them.
import { spawn, spawnSync } from "node:child_process";
import path from "node:path";

/** Where the programs are: --test has no arguments of its own, so ctest says it by the environment. */
const bin = process.env.BIOTOMY_BIN;
if (!bin) throw new Error("BIOTOMY_BIN must name the folder of biotomy, biotomyd and biotomy-sim");

const tool = path.join(bin, "biotomy");
const wholeOutput = 64 * 1024 * 1024; // bytes
const patience_s = 60; // a machine that is busy is not a program that hangs

/** What spawnSync may be told of any program, so that one that hangs fails its test and no more. */
export const limited = { encoding: "utf8", timeout: 2 * patience_s * 1000 };

/** Runs the tool `biotomy` to its end. */
export function biotomy(...words) {
  const { status, stdout, stderr } = spawnSync(tool, words, {
    ...limited,
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
  async says(text, seconds = patience_s) {
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

  /** Sends `signal` and waits for the end: its exit code, or the signal that ended it. One that does
   * not end is killed, which is an error. */
  async end(signal = "SIGTERM", seconds = patience_s) {
    if (this.runs) this.#child.kill(signal);
    let hangs = false;
    const limit = setTimeout(() => {
      hangs = true;
      this.#child.kill("SIGKILL");
    }, seconds * 1000);
    const end = await this.#ended.finally(() => clearTimeout(limit));
    if (hangs) throw new Error(`${this.name} did not end by ${signal}: ${this.output}`);
    return end;
  }
}
