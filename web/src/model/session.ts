/** The token of the link for the session's cookie. */

import type { Role } from "../protocol/messages";

export type Admission = { isDenied: true } | { isDenied: false; role: Role | null };

/** Without a token, or without an answer, the cookie of an earlier visit may do. */
export async function exchangeToken(token: string | null): Promise<Admission> {
  if (token === null) {
    return { isDenied: false, role: null };
  }
  const answer = await fetch("/api/session", {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ token }),
  }).catch(() => null);
  if (answer === null) {
    return { isDenied: false, role: null };
  }
  return answer.ok ? { isDenied: false, role: ((await answer.json()) as { role: Role }).role } : { isDenied: true };
}
