/** What page and worker say to each other. */

import type { StoreBuffer } from "./frame_store";

export type ToWorker =
  | { type: "connect"; url: string; store: StoreBuffer | null }
  | { type: "text"; text: string }
  | { type: "credit"; epoch: number; seq: number }
  | { type: "input"; data: ArrayBuffer }
  /** The hand is idle, or the page is hidden: nothing is repeated any more. */
  | { type: "rest" };

export type FromWorker =
  | { type: "open" }
  | { type: "closed" }
  | { type: "text"; text: string }
  /** The server says nothing any more, or speaks again. */
  | { type: "silence"; isSilent: boolean }
  | { type: "frames"; data: ArrayBuffer; receivedMs: number };
