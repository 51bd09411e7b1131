/** What VR asks of the page around it: words in its language, and what can be done. */

export type VrAction = "undo" | "forces" | "next" | "leave";
export type VrWord =
  | "depth"
  | "force"
  | "undo"
  | "forcesOff"
  | "forcesOn"
  | "next"
  | "leave"
  | "seated"
  | "larger"
  | "smaller"
  | "left"
  | "right"
  | "before";

export interface VrStatus {
  /** The step at hand, and what comes of it, in words. */
  title: string;
  hint: string;
  /** What is the matter, if anything is. */
  alarm: string | null;
  canUndo: boolean;
  isForcesOff: boolean;
}

export interface VrHost {
  say(word: VrWord): string;
  number(value: number, digits: number): string;
  status(): VrStatus;
  run(action: VrAction): void;
}

/** One of the hands of somebody in VR: where it takes hold. */
export interface RoomHand {
  p: readonly number[];
  /** w, x, y, z. */
  q: readonly number[];
  isTracked: boolean;
  isHolding: boolean;
}

/** What VR does with every frame, and where things are in it [m]. */
export interface Room {
  update(now: number): void;
  /** Null where there is none of this name. */
  buttonAt(id: string): readonly number[] | null;
  describeHands(): readonly RoomHand[];
}
