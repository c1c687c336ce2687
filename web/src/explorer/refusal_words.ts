import { capital } from "../shell/capital";

/** A refusal that the tool would print on a terminal, as a person writes it. */
export const refusalWords = (text: string): string => capital(text).replace(/ um\b/g, "\u00a0µm");
