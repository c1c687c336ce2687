/** A word of a command line as the server writes it: plain, or between quotes. */
const word = /(?:[^\s'\\]|'[^']*'|\\.)+/g;

/** What a command line of `biotomy` asks for: without the program, the sample and where it goes. */
export function askedBy(command: string): string {
  const [, , , ...rest] = command.match(word) ?? [];
  return rest.filter((part) => !part.startsWith("--output=")).join(" ");
}
