/** The server's sentences begin small, so that they go into other sentences. */
export const capital = (text: string): string => text.charAt(0).toUpperCase() + text.slice(1);
