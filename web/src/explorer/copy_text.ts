/** Puts text where it can be pasted from. False where the browser keeps pages from doing so. */
export async function copyText(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return false; // no secure context: a rig's computer is often reached by plain HTTP
  }
}
