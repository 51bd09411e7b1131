/** A file of the user's on its way: sent, asked for, and cancelled at whatever stage it is. */

import type { Command } from "../protocol/messages";
import type { Store } from "./store";
import { asServerError, uploadFile } from "./upload";

interface Host {
  command(command: Extract<Command, { command: "open" | "cancel" }>): Promise<unknown>;
}

export class ProductOpening {
  private sending: AbortController | null = null;
  private isAsked = false;

  constructor(
    private readonly store: Store,
    private readonly host: Host,
  ) {}

  async upload(file: File): Promise<void> {
    const sending = new AbortController();
    this.sending = sending;
    this.store.failure.value = null;
    try {
      const upload = await uploadFile(file, sending.signal, (fraction) => {
        this.store.upload.value = { file: file.name, fraction };
      });
      if (!sending.signal.aborted) {
        this.isAsked = true;
        await this.host.command({ command: "open", upload });
      }
    } catch (error) {
      if (!sending.signal.aborted) {
        this.store.failure.value = asServerError(error, file.name);
      }
    } finally {
      this.isAsked = false;
      this.store.upload.value = null;
      this.sending = null;
    }
  }

  cancel(): void {
    this.sending?.abort();
    if (this.isAsked || this.store.loading.value !== null) {
      void this.host.command({ command: "cancel" });
      this.store.loading.value = null;
    }
  }
}
