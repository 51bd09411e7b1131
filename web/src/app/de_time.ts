/** German of recordings, plots and devices. */
import type { enTime } from "./en_time";

export const deTime: Record<keyof typeof enTime, string> = {
  "log.recordingOn": "Aufnahme läuft: {name}",
  "log.recordingOff": "Aufgenommen: {name}",
};
