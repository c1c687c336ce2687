/** How long a stream is listened to, and then not, where there are too few connections. */
const listens_ms = 1000;
const waits_ms = 4000;

/** Opens and closes a stream in turns: what was missed meanwhile comes first each time. */
export class StreamTurns {
  private timer: ReturnType<typeof setTimeout> | undefined;
  private taken = false;

  constructor(
    private readonly stream: { open(): void; close(): void },
    private readonly random = Math.random,
  ) {}

  /** The stream is given back, and opened now and then. */
  begin(): void {
    this.taken = true;
    this.giveBack();
  }

  /** The stream is as it happens to be, and stays so. */
  end(): void {
    this.taken = false;
    clearTimeout(this.timer);
  }

  /** The stream is open: what is new comes at once. */
  opened(): void {
    if (!this.taken) return;
    clearTimeout(this.timer); // it was lost for a moment
    this.timer = setTimeout(() => this.giveBack(), listens_ms);
  }

  private giveBack(): void {
    clearTimeout(this.timer);
    this.stream.close();
    // So that the turns of many tabs spread.
    const wait_ms = waits_ms * (0.75 + this.random() / 2);
    this.timer = setTimeout(() => this.stream.open(), wait_ms);
  }
}
