import { useState } from "preact/hooks";

import { sentenceOf } from "../api/client";
import { status } from "../api/live";
import { Button } from "../ui/Button";
import { Dialog } from "../ui/Dialog";
import { Field } from "../ui/Field";
import { type Command, commandAsked, give } from "./commands";

/** What a command does, a reason for the journal, a word to type where there is no way back. */
export function CommandDialog() {
  const command = commandAsked.value;
  return command && <Asked key={command.name} command={command} />;
}

type Answer =
  { state: "none" } | { state: "waiting" } | { state: "done" | "refused"; sentence: string };

function Asked({ command }: { command: Command }) {
  const [reason, setReason] = useState("");
  const [word, setWord] = useState("");
  const [answer, setAnswer] = useState<Answer>({ state: "none" });
  // What was asked for can't be withdrawn, so that what comes of it must be seen.
  const close = () => {
    if (answer.state !== "waiting") commandAsked.value = null;
  };
  const confirmed = !command.confirmWord || word.trim().toLowerCase() === command.confirmWord;
  const send = async () => {
    setAnswer({ state: "waiting" });
    try {
      setAnswer({ state: "done", sentence: await give(command, reason) });
    } catch (error) {
      setAnswer({ state: "refused", sentence: sentenceOf(error) });
    }
  };

  if (answer.state === "done") {
    return (
      <Dialog title={command.label} onClose={close}>
        <p class="notice notice-good" role="status">
          Done: {answer.sentence}.
        </p>
        <div class="button-row">
          <Button kind="primary" autofocus onClick={close}>
            Close
          </Button>
        </div>
      </Dialog>
    );
  }
  return (
    <Dialog title={command.label} onClose={close} withoutNotice={command.name === "acknowledge"}>
      <form
        onSubmit={(event) => {
          event.preventDefault();
          if (confirmed) void send();
        }}
      >
        {command.name === "acknowledge" && status.value?.alarm && (
          <p class="notice notice-bad">{status.value.alarm.cause}</p>
        )}
        <p>{command.about}</p>
        <Field label="Reason" hint="A few words for the journal, if you like.">
          <input
            type="text"
            name="reason"
            maxLength={500}
            autocomplete="off"
            autofocus={!command.confirmWord}
            value={reason}
            onInput={(event) => setReason(event.currentTarget.value)}
          />
        </Field>
        {command.confirmWord && (
          <Field label={`Type “${command.confirmWord}” to confirm.`}>
            <input
              type="text"
              name="confirmation"
              autocomplete="off"
              autocapitalize="none"
              spellcheck={false}
              autofocus
              value={word}
              onInput={(event) => setWord(event.currentTarget.value)}
            />
          </Field>
        )}
        {answer.state === "refused" && (
          <p class="notice notice-bad" role="alert">
            {answer.sentence}
          </p>
        )}
        <div class="button-row">
          <Button
            submit
            kind={command.kind === "plain" ? "primary" : command.kind}
            disabled={!confirmed || answer.state === "waiting"}
          >
            {answer.state === "waiting" ? "Asking…" : command.label}
          </Button>
          <Button disabled={answer.state === "waiting"} onClick={close}>
            Cancel
          </Button>
        </div>
      </form>
    </Dialog>
  );
}
