/** The token of the link for the session's cookie, and links for others. */

import type { Role, ServerError } from "../protocol/messages";

export type Admission = { isDenied: true; error: ServerError | null } | { isDenied: false; role: Role | null };

/** A link that lets somebody else in. */
export interface Invitation {
  token: string;
  role: Role;
  /** The first browser that comes by it, and no other. */
  is_for_one: boolean;
  /** Where the studio can be reached, from anywhere or from this machine alone. */
  origins: string[];
  is_local: boolean;
  /** Addresses at which it could listen for others. */
  reachable: string[];
}

/** What a refusal says; null where it says nothing. */
export async function readError(answer: Response): Promise<ServerError | null> {
  const body = (await answer.json().catch(() => null)) as { error?: ServerError } | null;
  return body?.error ?? null;
}

function post(route: string, body: object): Promise<Response | null> {
  return fetch(route, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(body),
  }).catch(() => null);
}

/** Without a token, or without an answer, the cookie of an earlier visit may do. */
export async function exchangeToken(token: string | null): Promise<Admission> {
  const answer = token === null ? null : await post("/api/session", { token });
  if (answer === null) {
    return { isDenied: false, role: null };
  }
  return answer.ok
    ? { isDenied: false, role: ((await answer.json()) as { role: Role }).role }
    : { isDenied: true, error: await readError(answer) };
}

/** All others leave. @return Why not; null where it is done. */
export async function endSharing(): Promise<ServerError | null> {
  const answer = await post("/api/end_sharing", {});
  if (answer?.ok === true) {
    return null;
  }
  const error = answer === null ? null : await readError(answer);
  return error ?? { code: "io", message: "no answer", where: "", remedy: "" };
}

/** Null where the server makes none. */
export async function invite(role: Role): Promise<Invitation | null> {
  const answer = await post("/api/link", { role });
  return answer?.ok ? ((await answer.json()) as Invitation) : null;
}
