import { useState } from "preact/hooks";

import { tokenQuestion } from "../api/token";
import { Button } from "../ui/Button";
import { Dialog } from "../ui/Dialog";
import { Field } from "../ui/Field";

/** Asks for the token whenever something can't be had without. */
export function TokenDialog() {
  const question = tokenQuestion.value;
  const [text, setText] = useState("");
  if (!question) return null;
  const answer = (value: string | null) => {
    setText("");
    question.answer(value);
  };
  return (
    <Dialog title="Token needed" onClose={() => answer(null)}>
      <form
        onSubmit={(event) => {
          event.preventDefault();
          answer(text.trim() || null);
        }}
      >
        <p>{question.why}</p>
        <Field
          label="Token"
          hint="It is in the file that the rig's configuration names as service.token_file. This tab forgets it when it is closed."
        >
          <input
            type="password"
            name="token"
            autocomplete="off"
            spellcheck={false}
            required
            autofocus
            value={text}
            onInput={(event) => setText(event.currentTarget.value)}
          />
        </Field>
        <div class="button-row">
          <Button kind="primary" submit>
            Use this token
          </Button>
          <Button onClick={() => answer(null)}>Cancel</Button>
        </div>
      </form>
    </Dialog>
  );
}
