/** What `look` gives, once it gives something; it is asked again and again, and may be slow.
 * `said`: tells what there was instead when time is up. */
export async function until(what, look, { seconds = 60, said } = {}) {
  const limit = Date.now() + seconds * 1000;
  for (;;) {
    const seen = await look();
    if (seen !== undefined && seen !== false) return seen;
    if (Date.now() > limit) {
      throw new Error(`waited ${seconds} s for: ${what}${said ? `; it is ${await said()}` : ""}`);
    }
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}
