// What an operator does at the page, by what they read on it.

/** A dialog that is open, by its title. */
export const dialog = (page, name) => page.getByRole("dialog", { name });

/** Gives the token where it is asked for. */
export async function giveToken(page, token) {
  const asked = dialog(page, "Token needed");
  await asked.getByLabel("Token").fill(token);
  await asked.getByRole("button", { name: "Use this token" }).click();
  await asked.waitFor({ state: "hidden" });
}

/** Opens the dialog of a command such as "Start" and sends it with a reason. */
export async function sendCommand(page, name, reason = "") {
  // The button that opens it ends with dots where more is asked before anything happens.
  await page
    .getByRole("button", { name: new RegExp(`^${name}…?$`) })
    .first()
    .click();
  const asked = dialog(page, name);
  if (reason) await asked.getByLabel("Reason").fill(reason);
  await asked.getByRole("button", { name, exact: true }).click();
  return asked;
}

/** Gives a command; the token as well if it is asked for. The sentence of the answer. */
export async function command(page, name, { reason, token } = {}) {
  const asked = await sendCommand(page, name, reason);
  const answer = asked.locator(".notice-good, .notice-bad[role=alert]");
  const needsToken = dialog(page, "Token needed");
  await answer.or(needsToken).first().waitFor();
  if (await needsToken.isVisible()) {
    if (!token) throw new Error(`${name} needs a token`);
    await giveToken(page, token);
    await answer.waitFor();
  }
  const sentence = await answer.textContent();
  const close = asked.getByRole("button", { name: /^(Close|Cancel)$/ }).last();
  await close.click();
  await asked.waitFor({ state: "hidden" });
  return sentence;
}

/** The answer that asks for a token is an error to the browser's console; no other is. */
export const askedForToken = /status of 401/;
/** So is the one that says that it is a wrong one. */
export const wrongToken = /status of 403/;
