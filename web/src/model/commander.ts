/** What parts of the model need of the connection to the server, which has them. */

import type { Command, CommandResults } from "../protocol/messages";

export interface Commander {
  /** Sends a command; null: it was refused, which the user has been told. */
  command<K extends Command["command"]>(command: Extract<Command, { command: K }>): Promise<CommandResults[K] | null>;
}

export interface Announcer {
  /** Tells the user something. */
  notify(text: string, isError?: boolean): void;
}
