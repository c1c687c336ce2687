// A line for each check, as it is done: what became of it, what was checked, and what was found.

const counts = { pass: 0, FAIL: 0, skip: 0 };

function line(outcome, volume, what, found = "") {
  ++counts[outcome];
  console.log(`${outcome.padEnd(5)} ${volume.padEnd(22)} ${what.padEnd(44)} ${found}`.trimEnd());
}

export const pass = (volume, what, found) => line("pass", volume, what, found);
export const fail = (volume, what, found) => line("FAIL", volume, what, found);
export const skip = (volume, what, why) => line("skip", volume, what, why);

/** Runs a check, which returns what it found and throws when that is wrong. */
export async function check(volume, what, action) {
  try {
    pass(volume, what, await action());
  } catch (error) {
    fail(volume, what, String(error.message ?? error).split("\n")[0]);
  }
}

export function close() {
  console.log(`${counts.pass} passed, ${counts.FAIL} failed, ${counts.skip} skipped`);
  return counts.FAIL === 0;
}
