// A twin and a daemon in a folder of their own.
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { Program, limited } from "./programs.mjs";
import { until } from "./until.mjs";

const registerMap = process.env.BIOTOMY_REGISTER_MAP;
const hand = process.env.BIOTOMY_RIG_HAND;

const columnOffset = 350; // µm
const focusGuessError = 25; // µm: the operator's guess is near, not right
const firstFace = 1000; // µm
const answer_ms = 60_000; // for an answer of the daemon, on a machine that is busy

/** What a test may choose of its rig; lengths in micrometres. */
const usual = {
  sample: "sample",
  layers: 12,
  width: 240,
  height: 180,
  pixel: 20,
  thickness: 40,
  timeScale: 200,
  scenario: "", // TOML: what breaks, and when
  service: "", // more lines of rig.toml's [service], then more tables
  folder: "", // where; none: a temporary one, which is removed
};

export class Rig {
  #plan;
  #twin;
  #daemon;
  #temporary = false;
  /** What ended daemons have printed. */
  #logs = "";

  constructor(plan) {
    this.#plan = { ...usual, ...plan };
    this.#temporary = !this.#plan.folder;
    this.folder = this.#plan.folder || fs.mkdtempSync(path.join(os.tmpdir(), "biotomy-browser-"));
  }

  static async start(plan = {}) {
    const rig = new Rig(plan);
    try {
      await rig.#startTwin();
      await rig.startDaemon();
    } catch (error) {
      await rig.stop();
      throw error;
    }
    return rig;
  }

  get layers() {
    return this.#plan.layers;
  }
  get sample() {
    return path.join(this.folder, this.#plan.sample);
  }
  get token() {
    return fs.readFileSync(path.join(this.folder, "token"), "utf8").trim();
  }
  /** All that the daemon has written to its log. */
  get log() {
    return this.#logs + (this.#daemon?.output ?? "");
  }

  async #startTwin() {
    const { timeScale, width, height, pixel, scenario } = this.#plan;
    fs.writeFileSync(
      path.join(this.folder, "sim.toml"),
      `seed = 7
time_scale = ${timeScale}
state_file = "controller.json"
witness_log = "witness.jsonl"
[stage]
listen = "tcp://127.0.0.1:0"
register_map = "${registerMap}"
[rig]
socket = "unix://rig.socket"
[camera]
width = ${width}
height = ${height}
pixel = ${pixel}
column_offset = ${columnOffset}
[block]
first_face = ${firstFace}
`,
    );
    const words = ["--config", "sim.toml"];
    if (scenario) {
      fs.writeFileSync(path.join(this.folder, "scenario.toml"), scenario);
      words.push("--scenario", "scenario.toml");
    }
    this.#twin = new Program("biotomy-sim", words, this.folder);
    this.stage = (await this.#twin.says("ready, stage on ")).split(",")[0];
  }

  #writeConfiguration(listen) {
    const { sample, layers, pixel, thickness, service } = this.#plan;
    fs.writeFileSync(
      path.join(this.folder, "rig.toml"),
      `[stage]
endpoint = "${this.stage}"
register_map = "${registerMap}"
[lines]
backend = "socket"
endpoint = "unix://rig.socket"
response_timeout_ms = 5000
[camera]
backend = "socket"
endpoint = "unix://rig.socket"
exposure_us = 10000
[job]
sample = "${sample}"
layers = ${layers}
layer_thickness_um = ${thickness}
pixel_um = [${pixel}, ${pixel}]
first_face_um = ${firstFace}
clear_ms = 1500
settle_ms = 5
lamp_warm_up_ms = 5
[focus]
start_um = ${firstFace - columnOffset + focusGuessError}
[service]
listen = "${listen}"
token_file = "token"
${service}`,
    );
  }

  /** Starts the daemon; after a first time at the same address as before. */
  async startDaemon() {
    this.#writeConfiguration(this.url ? new URL(this.url).host : "127.0.0.1:0");
    this.#daemon = new Program("biotomyd", ["--config", "rig.toml"], this.folder);
    this.url = `http://${await this.#daemon.says("listening on http://")}`;
  }

  async endDaemon(signal = "SIGTERM") {
    const end = await this.#daemon.end(signal);
    this.#logs += this.#daemon.output;
    this.#daemon = undefined;
    return end;
  }

  /** The daemon stands still, with its connections open, until it is thawed. */
  freezeDaemon() {
    this.#daemon.signal("SIGSTOP");
  }
  thawDaemon() {
    this.#daemon.signal("SIGCONT");
  }

  /** What a person does at the rig: `rig_hand`'s words after the socket. */
  hand(...words) {
    const all = [path.join(this.folder, "rig.socket"), ...words];
    const { status, stderr, error } = spawnSync(hand, all, limited);
    if (status !== 0) throw error ?? new Error(stderr);
  }

  /** Asks the daemon as a program does, and waits a while for the whole answer; `token` only when told
   * so. */
  ask(target, { token, headers, ...rest } = {}) {
    const authorization = token ? { Authorization: `Bearer ${token}` } : {};
    const signal = AbortSignal.timeout(answer_ms);
    const all = { ...authorization, ...headers };
    return fetch(this.url + target, { signal, ...rest, headers: all });
  }

  async status() {
    return (await this.ask("/api/v1/status", { token: this.token })).json();
  }

  async command(name, reason = "") {
    const answer = await this.ask(`/api/v1/control/${name}`, {
      method: "POST",
      token: this.token,
      body: reason ? JSON.stringify({ reason }) : "",
    });
    if (!answer.ok) throw new Error(`${name}: ${await answer.text()}`);
  }

  /** The status, once `holds` is true of it. */
  reaches(what, holds, seconds = 240) {
    return until(
      what,
      async () => {
        const status = await this.status();
        return holds(status) ? status : undefined;
      },
      { seconds, said: async () => JSON.stringify(await this.status()) },
    );
  }

  /** Acknowledges if need be, and goes on with the job. */
  async takeUpAgain() {
    const stopped = await this.reaches("rest", ({ state }) =>
      ["idle", "paused", "faulted", "done"].includes(state),
    );
    if (stopped.state === "done") return;
    if (stopped.state === "faulted") await this.command("acknowledge");
    const { state } = await this.reaches("unlocked", (s) => ["idle", "paused"].includes(s.state));
    await this.command(state === "idle" ? "start" : "resume");
  }

  /** Runs the whole job. Whatever stops it on its way is an error. */
  async runJob() {
    await this.command("start");
    await this.reaches("done", ({ state }) => {
      if (["paused", "faulted", "aborted"].includes(state)) throw new Error(`the job is ${state}`);
      return state === "done";
    });
  }

  async stop() {
    await this.#daemon?.end("SIGKILL");
    await this.#twin?.end("SIGKILL");
    if (this.#temporary) fs.rmSync(this.folder, { recursive: true, force: true });
  }
}
