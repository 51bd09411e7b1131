/**
 * A hand that the mouse, a finger or the keyboard leads. It holds a part until it is told to let go, so
 * that one may look from elsewhere and take hold again on the way.
 */

import {
  approach,
  ease,
  easeTurn,
  inLineWithin,
  leash,
  offLine,
  pointAtLine,
  rayOnPlane,
  type Line,
  type Ray,
} from "../model/assist";
import {
  add,
  angleBetween,
  compose,
  distance,
  dot,
  inverse,
  multiply,
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
import { nearestPlace, placesOf, type Place, type TakenPart } from "./hand_places";

const kFine = 0.2;
/** The way in catches the hand when it is seen this near to it [px]. */
const kCatchPx = 34;
const kHoldOnPx = 60;
/** Of the hand [m/s]. */
const kFastest = 0.4;
const kSlowest = 0.12;
const kCaptured = 3;
/** Grips are the same within this: poses of the server come in single precision [m, rad]. */
const kSameGrip = 1e-5;
const kSameGripAngle = 1e-4;
/** A free part may be further behind: what is known of it is some time old [m]. */
const kFreeLeash = 0.08;
/** What is in line with the way in may be this many times as far off before it has to come out again, as it is known
 with delay: a choice. */
const kStillInLine = 3;

/** What the view knows of the eye. */
export interface Eye {
  /** Out of the screen, right and up: unit vectors in W. */
  back: Vec3;
  right: Vec3;
  up: Vec3;
  rayTo(p: Vec3): Ray;
  metresPerPixel(p: Vec3): number;
}

interface Hold {
  part: TakenPart;
  X_HB: Pose;
  /** The one in the product first. */
  places: readonly [Place, ...Place[]];
  /** The one that the pointer is nearest to. */
  goal: Pose;
  way: Line | null;
  /** Where the pointer leads it, before any help. */
  free: Pose;
  /** What was told to the server last. */
  sent: Pose;
  start: Vec3;
  isCaught: boolean;
  /** The hand is on the way in, for the server as well, and may go along it. */
  isInLine: boolean;
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
    const places = placesOf(part, X_HB);
    this.hold = {
      part,
      X_HB,
      places,
      ...(places.slice(1).find((_, k) => part.tablePlaces[k]!.is_there) ?? places[0]),
      free: hand,
      sent: hand,
      start: hand.p,
      isCaught: false,
      isInLine: false,
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
    if (isOurs) {
      holdAsGripped(hold, live);
    }
    if (!isOurs || live.state < kCaptured) {
      goToPlace(hold, nearestPlace(hold.places, hold.free.p, eye));
    }
    this.turnTowardsGoal(hold, seconds);
    const wanted = this.wantedPlace(hold, live, isOurs ? toVec3(live.p_WH_m) : hold.sent.p, eye);
    // Quick over the table, careful where it matters.
    const fastest = Math.min(kFastest, Math.max(kSlowest, 2.5 * distance(hold.sent.p, hold.goal.p)));
    let p = ease(hold.sent.p, wanted, seconds, 0.06, fastest);
    if (isOurs) {
      const displayed = compose({ p: toVec3(live.p_WD_m), q: toQuat(live.q_WD) }, inverse(hold.X_HB)).p;
      p = isBlocked(live) ? leash(displayed, p, Math.max(0.015, 0.35 * hold.part.radius)) : waitFor(displayed, hold.sent.p, p);
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

  /** @param heard  Where the server has the hand, some time ago. */
  private wantedPlace(hold: Hold, live: HandState | null, heard: Vec3, eye: Eye): Vec3 {
    const line = this.assists ? this.guide(hold, live) : null;
    if (line === null) {
      hold.isCaught = false;
      hold.isInLine = false;
      return hold.free.p;
    }
    const snap = pointAtLine(eye.rayTo(hold.free.p), line);
    const reach = (hold.isCaught ? kHoldOnPx : kCatchPx) * eye.metresPerPixel(snap.p);
    hold.isCaught = snap.off < reach;
    if (!hold.isCaught) {
      hold.isInLine = false;
      return hold.free.p;
    }
    const far = Math.max(offLine(hold.sent.p, line), offLine(heard, line));
    hold.isInLine = far < (hold.isInLine ? kStillInLine : 1) * inLineWithin(line);
    return hold.isInLine ? snap.p : approach(hold.sent.p, line);
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

/** The hand closes on its part where that is by then: a part that rolls is elsewhere than when it was pressed on. */
function holdAsGripped(hold: Hold, live: HandState): void {
  const X_WH = { p: toVec3(live.p_WH_m), q: toQuat(live.q_WH) };
  const X_HB = compose(inverse(X_WH), { p: toVec3(live.p_WT_m), q: toQuat(live.q_WT) });
  if (distance(X_HB.p, hold.X_HB.p) < kSameGrip && angleBetween(X_HB.q, hold.X_HB.q) < kSameGripAngle) {
    return;
  }
  const at = hold.places.findIndex(({ way }) => way === hold.way);
  hold.X_HB = X_HB;
  hold.places = placesOf(hold.part, X_HB);
  Object.assign(hold, hold.places[at] ?? hold.places[0]);
}

/** Until a mate has caught the part, it is for the place that the pointer is nearest to. */
function goToPlace(hold: Hold, place: Place): void {
  if (place.way !== hold.way) {
    hold.goal = place.goal;
    hold.way = place.way;
    hold.isCaught = false;
    hold.isInLine = false;
  }
}

/** Something else than the hand leads the part as well. */
function isBlocked(live: HandState): boolean {
  return live.contact_count > 0 || live.state >= kCaptured;
}

/** A free part that is seen too far behind is waited for: led back to it, the hand would go to and fro,
 as what is seen is some time old. */
function waitFor(displayed: Vec3, at: Vec3, to: Vec3): Vec3 {
  return distance(displayed, to) > Math.max(kFreeLeash, distance(displayed, at)) ? at : to;
}
