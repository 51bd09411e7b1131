/** Line icons on a grid of 24. */

const kPaths = {
  logo: "M12 2.8l8 4.6v9.2l-8 4.6-8-4.6V7.4zM12 9a3 3 0 100 6 3 3 0 000-6z",
  undo: "M8 5L4 9l4 4M4 9h10a5 5 0 010 10h-3",
  redo: "M16 5l4 4-4 4M20 9H10a5 5 0 000 10h3",
  theme: "M12 4a8 8 0 100 16zM12 4a8 8 0 010 16",
  share: "M9 12a3 3 0 11-6 0 3 3 0 016 0zM21 6a3 3 0 11-6 0 3 3 0 016 0zM21 18a3 3 0 11-6 0 3 3 0 016 0zM8.6 10.6l6.8-3.4M8.6 13.4l6.8 3.4",
  headset: "M4 8h16a1 1 0 011 1v7a1 1 0 01-1 1h-4.5l-2-3h-3l-2 3H4a1 1 0 01-1-1V9a1 1 0 011-1z",
  stop: "M8.2 3h7.6L21 8.2v7.6L15.8 21H8.2L3 15.8V8.2zM9 12h6",
  hammer: "M13 7l-9 9.5a1.8 1.8 0 002.6 2.6L16 10M11 5l3-2 7 7-3 3-2.5-2.5L13 8z",
  hand: "M8 12V5.5a1.5 1.5 0 013 0V11m0-6.5V4a1.5 1.5 0 013 0v7m0-5a1.5 1.5 0 013 0v7.5c0 4-2.2 6.5-5.5 6.5-3 0-4.2-1.4-5.7-4.2L4.3 13.5a1.4 1.4 0 012.3-1.5L8 14",
  cursor: "M6 4l12 8-5.2 1.2L16 19l-2.4 1.2-3-5.9L6.5 18z",
  cube: "M12 3l8 4.5v9L12 21l-8-4.5v-9zM4 7.5l8 4.5 8-4.5M12 12v9",
  cubes: "M8 10l4.5 2.5v5L8 20l-4.5-2.5v-5zM16 4l4.5 2.5v5L16 14l-4.5-2.5v-5zM3.5 12.5L8 15l4.5-2.5M11.5 6.5L16 9l4.5-2.5",
  face: "M4 9l11-4 5 10-11 4zM4 9l5 10",
  section: "M4 6h7v12H4zM13 4v16M15.5 6H20v12h-4.5",
  explode: "M12 12l-6-6M6 10V6h4M12 12l6-6M14 6h4v4M12 12l-6 6M6 14v4h4M12 12l6 6M14 18h4v-4",
  measure: "M3 15L15 3l6 6L9 21zM7 11l2 2M10 8l3 3M13 5l2 2",
  mate: "M8 12h8M9 7H7a5 5 0 000 10h2M15 7h2a5 5 0 010 10h-2",
  isolate: "M4 8V4h4M16 4h4v4M20 16v4h-4M8 20H4v-4M9 9h6v6H9z",
  ghost: "M6 20V11a6 6 0 0112 0v9l-3-2-3 2-3-2zM10 11v.5M14 11v.5",
  eye: "M2.5 12S6 5.5 12 5.5 21.5 12 21.5 12 18 18.5 12 18.5 2.5 12 2.5 12zM12 9a3 3 0 100 6 3 3 0 000-6z",
  eyeOff: "M4 4l16 16M9.5 6a9.500 9.500 0 012.500-.400C18 5.600 21.500 12 21.500 12a17 17 0 01-3 3.700M6 7.700A16 16 0 002.500 12S6 18.500 12 18.500a9 9 0 004-1",
  fit: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5",
  play: "M7 5l12 7-12 7z",
  pause: "M8 5v14M16 5v14",
  toStart: "M19 5l-11 7 11 7zM5 5v14",
  toEnd: "M5 5l11 7-11 7zM19 5v14",
  list: "M8 6h12M8 12h12M8 18h12M4 6h.010M4 12h.010M4 18h.010",
  download: "M12 4v11M7.500 11l4.500 4.500 4.500-4.500M4 16v3a1 1 0 001 1h14a1 1 0 001-1v-3",
  pen: "M4 20l1-4L16.500 4.500l3 3L8 19zM14 7l3 3",
  trash: "M5 7h14M10 7V4.500h4V7M7 7l1 13h8l1-13M10.500 11v5.500M13.500 11v5.500",
  device: "M5 19h14M12 19v-6M12 13L7 8M7 8a2 2 0 10-.010 0M12 13a1.500 1.500 0 10-.010 0",
  step: "M6 5l9 7-9 7zM18 5v14",
  reset: "M5 8a8 8 0 11-1 6M5 3v5h5",
  check: "M5 12.500l4.500 4.500L19 7",
  dot: "M12 8a4 4 0 100 8 4 4 0 000-8z",
  chevron: "M9 6l6 6-6 6",
  close: "M6 6l12 12M18 6L6 18",
  search: "M10.500 4a6.500 6.500 0 100 13 6.500 6.500 0 000-13zM15.500 15.500L20 20",
  upload: "M12 16V5M7.500 9L12 4.500 16.500 9M4 16v3a1 1 0 001 1h14a1 1 0 001-1v-3",
  sound: "M4 10v4h3l5 4V6l-5 4zM15.500 9a4 4 0 010 6M18 6.500a8 8 0 010 11",
  mute: "M4 10v4h3l5 4V6l-5 4zM16 10l5 5M21 10l-5 5",
  panels: "M4 5h16v14H4zM9 5v14M9 14h11",
  warn: "M12 4l9 16H3zM12 10v4M12 17v.500",
  menu: "M4 7h16M4 12h16M4 17h16",
  flip: "M4 12h16M16 8l4 4-4 4M8 8l-4 4 4 4",
  lock: "M6 11h12v9H6zM8.500 11V8a3.500 3.500 0 017 0v3",
} as const;

export type IconName = keyof typeof kPaths;

export function Icon({ name, size = 18 }: { name: IconName; size?: number }) {
  return (
    <svg class="icon" width={size} height={size} viewBox="0 0 24 24" aria-hidden="true" focusable="false">
      <path d={kPaths[name]} />
    </svg>
  );
}
