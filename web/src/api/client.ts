import { askForToken, needsToken, setToken, token } from "./token";

/** What anybody may ask: what this server is. */
export const servicePath = "/api/v1/service";

/** The server answered, and the answer was no. `message` is its sentence. */
export class ApiError extends Error {
  constructor(
    readonly status: number,
    readonly code: string,
    message: string,
    readonly retryAfter: number | null = null, // seconds
  ) {
    super(message);
    this.name = "ApiError";
  }
}

/** There was no answer, or not all of it. */
export class ConnectionError extends Error {
  constructor() {
    super("The server does not answer.");
    this.name = "ConnectionError";
  }
}

export interface RequestOptions {
  method?: "GET" | "POST" | "DELETE";
  body?: unknown; // sent as JSON
  signal?: AbortSignal;
  /** Without a signal: how long to wait for the answer, however long a person looks for the token. */
  limit_ms?: number;
  headers?: Record<string, string>;
}

/** True for the error of a request that was given up by its own AbortSignal. */
export const isAbort = (error: unknown): boolean =>
  error instanceof DOMException && error.name === "AbortError";

/** What to show a person of any error. */
export const sentenceOf = (error: unknown): string =>
  error instanceof Error ? error.message : String(error);

const limitOf = ({ limit_ms }: RequestOptions): AbortSignal | undefined =>
  limit_ms === undefined ? undefined : AbortSignal.timeout(limit_ms);

/** What came; ConnectionError where nothing did, or it broke off. Given up, it throws the AbortError. */
async function arrived<T>(coming: Promise<T>): Promise<T> {
  try {
    return await coming;
  } catch (error) {
    if (isAbort(error)) throw error;
    throw new ConnectionError();
  }
}

async function send(path: string, options: RequestOptions): Promise<Response> {
  const headers: Record<string, string> = { ...options.headers };
  if (token()) headers.Authorization = `Bearer ${token()}`;
  if (options.body !== undefined) headers["Content-Type"] = "application/json";
  return arrived(
    fetch(path, {
      method: options.method ?? "GET",
      headers,
      body: options.body === undefined ? undefined : JSON.stringify(options.body),
      signal: options.signal ?? limitOf(options),
      credentials: "omit",
      redirect: "error",
    }),
  );
}

/** The error that a response tells of. */
export async function errorOf(response: Response): Promise<ApiError> {
  const retry = Number(response.headers.get("Retry-After"));
  const retryAfter = response.headers.has("Retry-After") && Number.isFinite(retry) ? retry : null;
  try {
    const { error } = (await response.json()) as { error: { code: string; message: string } };
    return new ApiError(response.status, String(error.code), String(error.message), retryAfter);
  } catch {
    const sentence = `The server answered ${response.status} ${response.statusText}`.trim();
    return new ApiError(response.status, "unknown", `${sentence}.`, retryAfter);
  }
}

const whyNeeded = "This needs the token that the rig’s computer keeps.";
const whyAgain = "The token was not accepted.";

/**
 * A request that succeeded; where a token is needed, the person is asked for it.
 * Throws ApiError, ConnectionError, or the AbortError of `options.signal`.
 */
export async function request(path: string, options: RequestOptions = {}): Promise<Response> {
  const isReading = (options.method ?? "GET") === "GET";
  if (needsToken(isReading) && path !== servicePath) await tokenOr401(whyNeeded, !isReading);
  const withToken = token();
  let response = await send(path, options);
  if (lacksToken(response)) {
    // Another request may have been given a token meanwhile.
    if (token() === withToken) {
      setToken("");
      const error = await errorOf(response);
      await tokenOr401(withToken ? whyAgain : whyNeeded, !isReading, error);
    }
    response = await send(path, options);
    if (lacksToken(response)) setToken("");
  }
  if (!response.ok) throw await errorOf(response);
  return response;
}

/**
 * Without a token the answer is 401, with a wrong one 403 that asks for another. Of any other 403 no
 * token is the cause.
 */
const lacksToken = ({ status, headers }: Response): boolean =>
  status === 401 || (status === 403 && headers.has("WWW-Authenticate"));

/** Throws when the person gives none. */
async function tokenOr401(
  why: string,
  insist: boolean,
  error = new ApiError(401, "unauthorized", "Without the token this can’t be done."),
): Promise<void> {
  if ((await askForToken(why, insist)) === null) throw error;
}

const jsonOf = <T>(response: Response): Promise<T> => arrived(response.json() as Promise<T>);

export const blobOf = (response: Response): Promise<Blob> => arrived(response.blob());

export async function getJson<T>(path: string, signal?: AbortSignal): Promise<T> {
  return jsonOf(await request(path, { signal }));
}

/** What is asked for is only begun before the answer comes: a long silence is none. */
export const longestAnswer_ms = 20_000;

export async function postJson<T>(path: string, body?: unknown): Promise<T> {
  const limit_ms = longestAnswer_ms;
  return jsonOf(await request(path, { method: "POST", body, limit_ms }));
}

/** Answers may be empty: what they say is not looked at. */
export async function deleteAt(path: string): Promise<void> {
  await request(path, { method: "DELETE", limit_ms: longestAnswer_ms });
}

/** A picture or a file, whole. */
export async function getBlob(path: string, signal?: AbortSignal): Promise<Blob> {
  return blobOf(await request(path, { signal }));
}

/** "/path?a=1&b=2" of what is neither undefined nor null. */
export function withQuery(
  path: string,
  query: Record<string, string | number | boolean | undefined | null>,
): string {
  const parameters = new URLSearchParams();
  for (const [name, value] of Object.entries(query)) {
    if (value !== undefined && value !== null) parameters.set(name, String(value));
  }
  const text = parameters.toString();
  return text ? `${path}?${text}` : path;
}
