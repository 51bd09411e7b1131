/**
 * A hand that the mouse, a finger or the keyboard leads. It holds a part until it is told to let go, so
 * that one may look from elsewhere and take hold again on the way.
 */

import { ease, easeTurn, leash, pointAtLine, rayOnPlane, wayInLine, type Line, type Ray } from "../model/assist";
import {
  add,
  compose,
  distance,
  dot,
  inverse,
  multiply,
  norm,
  normalized,
  scale,
  sub,
  toQuat,
  toVec3,
  turnAbout,
  unit,
  type Pose,
  type Vec3,
} from "../model/math";
import type { HandInput, HandState } from "../protocol/frames";
import type { Step, TablePlace } from "../protocol/messages";
import { nearestPlace, placeOnTable, type Place } from "./hand_places";

const kFine = 0.2;
/** The way in catches the hand when it is seen this near to it [px]. */
const kCatchPx = 34;
const kHoldOnPx = 60;
/** Of the hand [m/s]. */
const kFastest = 0.4;
const kSlowest = 0.12;
const kCaptured = 3;
/** A free part may be further behind: what is known of it is some time old [m]. */
const kFreeLeash = 0.08;
/** From this share of the way in outwards the hand may cross over to it. */
const kOutside = 0.96;

/** What the view knows of the eye. */
export interface Eye {
  /** Out of the screen, right and up: unit vectors in W. */
  back: Vec3;
  right: Vec3;
  up: Vec3;
  rayTo(p: Vec3): Ray;
  metresPerPixel(p: Vec3): number;
}

export interface TakenPart {
  occurrence: number;
  /** As it lay when it was taken. */
  X_WB: Pose;
  goal: Pose;
  step: Step | null;
  radius: number;
  /** How far out along the way in the part is clear of all that stands there [m]. */
  clearance: number;
  /** What moves with it. */
  members: readonly number[];
  /** Its places at loose parts on the table. */
  tablePlaces: readonly TablePlace[];
}

interface Hold {
  part: TakenPart;
  X_HB: Pose;
  /** The one in the product first. */
  places: readonly Place[];
  /** The one that the pointer is nearest to. */
  goal: Pose;
  way: Line | null;
  /** Where the pointer leads it, before any help. */
  free: Pose;
  /** What was told to the server last. */
  sent: Pose;
  start: Vec3;
  isCaught: boolean;
  isTurnedByUser: boolean;
  wasSeen: boolean;
}

export class MouseHand {
  assists = true;
  private hold: Hold | null = null;
  private grabbed: Vec3 | null = null;

  /** @param hand  Which of the hands it is, for the server. */
  constructor(private readonly hand = 0) {}

  get occurrence(): number | null {
    return this.hold?.part.occurrence ?? null;
  }

  /** Whether the part is in the hand, or moves with what is. */
  holds(occurrence: number): boolean {
    return this.hold !== null && (this.hold.part.occurrence === occurrence || this.hold.part.members.includes(occurrence));
  }

  get isDragging(): boolean {
    return this.grabbed !== null;
  }

  /** The way in that the hand follows now. */
  get isCaught(): boolean {
    return this.hold?.isCaught ?? false;
  }

  begin(part: TakenPart, hand: Pose): void {
    const X_HB = compose(inverse(hand), part.X_WB);
    const goal = compose(part.goal, inverse(X_HB));
    const inProduct = { goal, way: part.step?.kind === "insert" ? wayInLine(goal, part.step.way_in, part.clearance) : null };
    const onTable = part.tablePlaces.map((place) => placeOnTable(place, X_HB, part.radius));
    this.hold = {
      part,
      X_HB,
      places: [inProduct, ...onTable],
      ...(onTable.find((_, k) => part.tablePlaces[k]!.is_there) ?? inProduct),
      free: hand,
      sent: hand,
      start: hand.p,
      isCaught: false,
      isTurnedByUser: false,
      wasSeen: false,
    };
  }

  end(): void {
    this.hold = null;
    this.grabbed = null;
  }

  /** The pointer takes hold of what the hand has; `ray` is the pointer's. */
  grab(ray: Ray, eye: Eye): void {
    if (this.hold !== null) {
      this.hold.free = { ...this.hold.free, p: this.hold.sent.p };
      this.grabbed = rayOnPlane(ray, this.hold.free.p, eye.back);
    }
  }

  drop(): void {
    this.grabbed = null;
    if (this.hold !== null && !this.hold.isCaught) {
      this.hold.free = { ...this.hold.free, p: this.hold.sent.p };
    }
  }

  drag(ray: Ray, eye: Eye, isFine: boolean): void {
    if (this.hold === null || this.grabbed === null) {
      return;
    }
    const to = rayOnPlane(ray, this.grabbed, eye.back);
    if (to !== null) {
      this.shift(scale(sub(to, this.grabbed), isFine ? kFine : 1));
      this.grabbed = to;
    }
  }

  /** Moves along the axes of the screen; metres. */
  nudge(right: number, up: number, away: number, eye: Eye): void {
    this.shift(add(add(scale(eye.right, right), scale(eye.up, up)), scale(eye.back, -away)));
  }

  /** Turns about the axes of the screen; radians. */
  turn(aboutRight: number, aboutUp: number, aboutBack: number, eye: Eye): void {
    if (this.hold === null) {
      return;
    }
    let q = this.hold.free.q;
    for (const [axis, angle] of [
      [eye.right, aboutRight],
      [eye.up, aboutUp],
      [eye.back, aboutBack],
    ] as const) {
      q = multiply(turnAbout(axis, angle), q);
    }
    this.hold.free = { ...this.hold.free, q: normalized(q) };
    this.hold.isTurnedByUser = true;
  }

  /** Turns the part as it has to stand in its place. */
  snapTurn(): void {
    if (this.hold !== null) {
      this.hold.free = { ...this.hold.free, q: this.hold.goal.q };
      this.hold.isTurnedByUser = false;
    }
  }

  /** One step of the hand; returns what to tell the server, or null when nothing is held.
   @param live  What the server says of the hand. */
  update(seconds: number, live: HandState | null, eye: Eye): HandInput | null {
    const hold = this.hold;
    if (hold === null) {
      return null;
    }
    const isOurs = live !== null && live.state > 0 && live.occurrence === hold.part.occurrence;
    if (hold.wasSeen && live !== null && !isOurs) {
      this.end();
      return null;
    }
    hold.wasSeen ||= isOurs;
    if (!isOurs || live.state < kCaptured) {
      goToPlace(hold, nearestPlace(hold.places, hold.free.p, eye));
    }
    this.turnTowardsGoal(hold, seconds);
    const wanted = this.wantedPlace(hold, live, eye);
    // Quick over the table, careful where it matters.
    const fastest = Math.min(kFastest, Math.max(kSlowest, 2.5 * distance(hold.sent.p, hold.goal.p)));
    let p = ease(hold.sent.p, wanted, seconds, 0.06, fastest);
    if (isOurs) {
      const displayed = compose({ p: toVec3(live.p_WD_m), q: toQuat(live.q_WD) }, inverse(hold.X_HB)).p;
      const isBlocked = live.contact_count > 0 || live.state >= kCaptured;
      p = leash(displayed, p, isBlocked ? Math.max(0.015, 0.35 * hold.part.radius) : kFreeLeash);
    }
    hold.sent = { p, q: easeTurn(hold.sent.q, hold.free.q, seconds, 0.06) };
    return {
      hand: this.hand,
      buttons: 1,
      p_WH_m: hold.sent.p,
      q_WH: hold.sent.q,
      client_ms: performance.now() % 1e6,
    };
  }

  private shift(by: Vec3): void {
    if (this.hold !== null) {
      this.hold.free = { ...this.hold.free, p: add(this.hold.free.p, by) };
    }
  }

  /** A part that has been lifted turns by itself as it will stand, unless its user turns it. */
  private turnTowardsGoal(hold: Hold, seconds: number): void {
    const isLifted = distance(hold.sent.p, hold.start) > 0.15 * hold.part.radius;
    if (this.assists && !hold.isTurnedByUser && isLifted) {
      hold.free = { ...hold.free, q: easeTurn(hold.free.q, hold.goal.q, seconds, 0.12) };
    }
  }

  private wantedPlace(hold: Hold, live: HandState | null, eye: Eye): Vec3 {
    const line = this.assists ? this.guide(hold, live) : null;
    if (line === null) {
      hold.isCaught = false;
      return hold.free.p;
    }
    const snap = pointAtLine(eye.rayTo(hold.free.p), line);
    const reach = (hold.isCaught ? kHoldOnPx : kCatchPx) * eye.metresPerPixel(snap.p);
    hold.isCaught = snap.off < reach;
    if (!hold.isCaught) {
      return hold.free.p;
    }
    return approach(hold.sent.p, snap.p, line);
  }

  /** The axis that a captured mate has, or else the way in. */
  private guide(hold: Hold, live: HandState | null): Line | null {
    const isGuided = live !== null && live.state >= kCaptured && Math.hypot(...live.axis_W) > 0.5;
    if (!isGuided) {
      return hold.way;
    }
    const d = unit(toVec3(live.axis_W));
    if (hold.way !== null && Math.abs(dot(d, hold.way.d)) > 0.9 && offLine(hold.sent.p, hold.way) < 0.2 * hold.part.radius) {
      return hold.way;
    }
    const length = 2 * hold.part.radius;
    return { p: hold.sent.p, d, low: -length, high: length };
  }
}

/** Until a mate has caught the part, it is for the place that the pointer is nearest to. */
function goToPlace(hold: Hold, place: Place): void {
  if (place.way !== hold.way) {
    hold.goal = place.goal;
    hold.way = place.way;
    hold.isCaught = false;
  }
}

function offLine(p: Vec3, line: Line): number {
  const r = sub(p, line.p);
  return norm(sub(r, scale(line.d, dot(r, line.d))));
}

/** Towards a point of the way in, but first out beside it and across to where it begins: never through
 what stands around it. */
function approach(from: Vec3, to: Vec3, line: Line): Vec3 {
  const far = offLine(from, line);
  const length = Math.max(1e-6, line.high);
  if (far < 0.03 * length + 5e-4) {
    return to;
  }
  const s = dot(sub(from, line.p), line.d);
  const outer = add(line.p, scale(line.d, line.high));
  if (s > kOutside * line.high) {
    return outer;
  }
  const beside = sub(from, add(line.p, scale(line.d, s)));
  return add(outer, beside);
}
