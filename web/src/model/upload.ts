/** A file on its way to the server. */

import { CommandError } from "../protocol/connection";
import type { ServerError } from "../protocol/messages";

/** XMLHttpRequest, for fetch does not tell how much of a body has gone. */
export function uploadFile(
  file: File,
  signal: AbortSignal,
  onFraction: (fraction: number) => void,
): Promise<string> {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open("POST", `/api/upload?name=${encodeURIComponent(file.name)}`);
    request.setRequestHeader("Content-Type", "application/octet-stream");
    request.upload.onprogress = (event) => onFraction(event.total > 0 ? event.loaded / event.total : 0);
    request.onload = () => {
      const answer = parseJson(request.responseText) as { upload?: string; error?: ServerError } | null;
      if (request.status < 400 && answer?.upload !== undefined) {
        resolve(answer.upload);
      } else {
        reject(answer?.error ? new CommandError(answer.error) : new Error(`${request.status} ${request.statusText}`));
      }
    };
    request.onerror = () => reject(new Error(`${file.name}: the connection was lost`));
    request.onabort = () => reject(new DOMException("aborted", "AbortError"));
    signal.addEventListener("abort", () => request.abort());
    onFraction(0);
    request.send(file);
  });
}

function parseJson(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    return null;
  }
}

export function asServerError(error: unknown, where: string): ServerError {
  if (error instanceof CommandError) {
    return error.detail;
  }
  return { code: "upload", message: error instanceof Error ? error.message : String(error), where, remedy: "" };
}
