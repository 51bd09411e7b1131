/** English of recordings, plots and devices. */
export const enTime = {
  "log.recordingOn": "Recording: {name}",
  "log.recordingOff": "Recorded: {name}",
} as const;
