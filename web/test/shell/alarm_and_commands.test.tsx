// @vitest-environment happy-dom
import { render } from "preact";
import { act } from "preact/test-utils";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { connection, status } from "../../src/api/live";
import { setToken } from "../../src/api/token";
import type { Status } from "../../src/api/types";
import { Controls } from "../../src/run/Controls";
import { AlarmBar } from "../../src/shell/AlarmBar";
import { AlarmLine } from "../../src/shell/AlarmLine";
import { CommandDialog } from "../../src/shell/CommandDialog";
import { commandAsked } from "../../src/shell/commands";
import { Connecting } from "../../src/shell/Connecting";
import { ConnectionBanner } from "../../src/shell/ConnectionBanner";
import { DialogNotice } from "../../src/ui/Dialog";
import { aStatus, anAlarm as alarm } from "../a_status";

const page = () => document.body;
const buttons = () => [...page().querySelectorAll("button")].map((button) => button.textContent);
const button = (name: string) =>
  [...page().querySelectorAll("button")].find((one) => one.textContent === name);
const field = (name: string) => page().querySelector<HTMLInputElement>(`input[name="${name}"]`);

function type(name: string, text: string): void {
  const input = field(name);
  if (!input) throw new Error(`there is no field ${name}`);
  void act(() => {
    input.value = text;
    input.dispatchEvent(new Event("input", { bubbles: true }));
  });
}

const press = (name: string) => act(() => button(name)?.click());

function show(changes: Partial<Status>, lost = false): void {
  const shown = aStatus(changes);
  void act(() => {
    status.value = shown;
    render(
      <DialogNotice.Provider value={<AlarmLine />}>
        <AlarmBar />
        <Controls status={shown} lost={lost} />
        <CommandDialog />
        <ConnectionBanner />
      </DialogNotice.Provider>,
      page(),
    );
  });
}

/** As its button does, and waits for what comes of it at once. */
async function sendForm(): Promise<void> {
  await act(async () => {
    page()
      .querySelector("form")
      ?.dispatchEvent(new Event("submit", { bubbles: true, cancelable: true }));
    await new Promise((resolve) => setTimeout(resolve));
  });
}

describe("alarm and commands", () => {
  const fetched = vi.fn<typeof fetch>();

  beforeEach(() => {
    fetched.mockReset();
    vi.stubGlobal("fetch", fetched);
    setToken("secret");
    commandAsked.value = null;
  });

  afterEach(() => {
    render(null, page());
    status.value = null;
    vi.unstubAllGlobals();
  });

  it("offers the commands that the job would obey, and no other", () => {
    show({ commands: ["pause", "abort"] });
    expect(buttons()).toEqual(["Pause", "Abort"]);
    show({ commands: ["start", "something-new"] });
    expect(buttons()).toEqual(["Start"]);
    show({ commands: [] });
    expect(buttons()).toEqual([]);
  });

  it("offers no start of a job that has every layer", () => {
    const commands = ["start"];
    show({ state: "done", committed: 80, layers: 80, commands });
    expect(buttons()).toEqual([]);
    show({ state: "done", committed: 80, layers: 90, commands });
    expect(buttons()).toEqual(["Start"]);
  });

  it("offers none that could not be sent", () => {
    show({ commands: ["pause"] }, true);
    expect(button("Pause")?.disabled).toBe(true);
  });

  it("tells of an alarm what happened, what to do and since when", () => {
    show({ state: "faulted", alarm, commands: ["acknowledge"] });
    const bar = page().querySelector('[role="alert"]');
    expect(bar?.textContent).toContain("the door is open");
    expect(bar?.textContent).toContain("Close the door, then acknowledge.");
    expect(bar?.querySelector("time")?.dateTime).toBe(alarm.since);
    show({ state: "idle", alarm: null });
    expect(page().querySelector('[role="alert"]')).toBeNull();
  });

  it("tells why an alarm can't be acknowledged yet", () => {
    const waiting_for = "the cause is still there: the e-stop is pressed";
    const waiting = () => page().querySelector(".alarm-waiting")?.textContent;
    show({ state: "faulted", alarm, waiting_for, commands: [] });
    expect(waiting()).toBe("The cause is still there: the e-stop is pressed.");
    show({ state: "faulted", alarm, waiting_for, commands: ["acknowledge"] });
    expect(waiting()).toBeUndefined();
  });

  it("writes small of an alarm what its device says", () => {
    const cause = "stage at tcp://10.0.0.7:502: no answer: timed out";
    show({ state: "faulted", alarm: { ...alarm, cause } });
    const shown = page().querySelector(".alarm-cause");
    expect(shown?.textContent).toBe(`Alarm: ${cause}`);
    expect(shown?.querySelector(".alarm-details")?.textContent).toBe(": no answer: timed out");
  });

  it("sends a command with its reason, and shows the answer", async () => {
    fetched.mockResolvedValue(new Response(JSON.stringify({ message: "the step is finished" })));
    show({ commands: ["pause"] });
    await press("Pause");
    type("reason", " lunch ");
    await sendForm();
    const [path, options] = fetched.mock.calls[0];
    expect(path).toBe("/api/v1/control/pause");
    expect(options?.method).toBe("POST");
    expect(options?.body).toBe('{"reason":"lunch"}');
    expect(page().querySelector('[role="status"].notice')?.textContent).toContain(
      "the step is finished",
    );
  });

  it("shows why a command was refused, and leaves the dialog open", async () => {
    const error = { error: { code: "conflict", message: "the job is done" } };
    fetched.mockResolvedValue(new Response(JSON.stringify(error), { status: 409 }));
    show({ commands: ["pause"] });
    await press("Pause");
    await sendForm();
    expect(page().querySelector('dialog [role="alert"]')?.textContent).toBe("the job is done");
  });

  it("stays until the answer to a command has come, whatever is pressed", async () => {
    let answer = (_: Response) => {};
    fetched.mockReturnValue(new Promise((resolve) => (answer = resolve)));
    show({ commands: ["pause"] });
    await press("Pause");
    const dialog = () => page().querySelector("dialog");
    const send = (event: Event) => act(async () => void dialog()!.dispatchEvent(event));
    await sendForm();
    await send(new Event("cancel", { cancelable: true }));
    await press("Cancel");
    expect(dialog()).not.toBeNull();
    await act(async () => {
      answer(new Response(JSON.stringify({ message: "the step is finished" })));
      await new Promise((resolve) => setTimeout(resolve));
    });
    expect(dialog()?.textContent).toContain("the step is finished");
    await send(new Event("cancel", { cancelable: true }));
    expect(dialog()).toBeNull();
  });

  it("does not claim to know what became of a command that nobody answered", async () => {
    fetched.mockRejectedValue(new TypeError("failed"));
    show({ commands: ["pause"] });
    await press("Pause");
    await sendForm();
    expect(page().querySelector('dialog [role="alert"]')?.textContent).toMatch(
      /does not answer\. The rig’s state will show/,
    );
  });

  it("tells of an alarm in a dialog, too, unless that is about it", async () => {
    const line = () => page().querySelector("dialog .alarm-line")?.textContent;
    show({ commands: ["pause", "acknowledge"] });
    await press("Pause");
    expect(line()).toBeUndefined();
    show({ state: "faulted", alarm, commands: ["pause", "acknowledge"] });
    expect(line()).toBe("Alarm: the door is open");
    await press("Cancel");
    await press("Acknowledge…");
    expect(page().querySelector("dialog")?.textContent).toContain("the door is open");
    expect(line()).toBeUndefined();
  });

  it("says after a while what may keep the server from being heard", () => {
    const since = Date.now() - 6000;
    connection.value = { state: "connecting", why: "", since, heardAt: 0, retryAt: 0 };
    void act(() => render(<Connecting />, page()));
    expect(page().textContent).toMatch(/^Connecting….*close one\.$/);
    connection.value = { ...connection.value, since: since + 3000 };
    void act(() => render(<Connecting />, page()));
    expect(page().textContent).toBe("Connecting…");
  });

  it("does not abort before the word is typed", async () => {
    show({ commands: ["abort"] });
    await press("Abort");
    const submit = () => page().querySelector<HTMLButtonElement>('dialog button[type="submit"]');
    expect(submit()?.disabled).toBe(true);
    type("confirmation", "abor");
    expect(submit()?.disabled).toBe(true);
    await sendForm();
    expect(fetched).not.toHaveBeenCalled();
    type("confirmation", " Abort ");
    expect(submit()?.disabled).toBe(false);
  });

  it("says that the connection is lost, on the body too", () => {
    show({});
    expect(page().querySelector(".connection-banner")?.textContent).toBe("");
    void act(() => {
      connection.value = {
        state: "lost",
        why: "The server does not answer.",
        since: Date.now(),
        heardAt: Date.now(),
        retryAt: Date.now() + 3000,
      };
    });
    expect(page().querySelector('[role="status"]')?.textContent).toContain("Connection lost");
    expect(document.body.dataset.connection).toBe("lost");
  });
});
