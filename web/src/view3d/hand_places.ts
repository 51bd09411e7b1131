/** Where a part in a hand may go: to its place in the product, or to loose parts on the table that it fits. */

import { pointAtLine, wayInLine, type Line, type Ray } from "../model/assist";
import { compose, inverse, type Pose, type Vec3 } from "../model/math";
import type { Step, TablePlace } from "../protocol/messages";

/** A place on the table is meant when its way in is seen this near to the pointer [px]. */
const kTablePx = 90;
/** Of the part's radius: how far out it is clear of the loose parts that it goes to. */
const kTableRoom = 0.5;

/** What is needed of the eye. */
interface Sight {
  rayTo(p: Vec3): Ray;
  metresPerPixel(p: Vec3): number;
}

/** A place of what the hand has; of the hand, not of the part. */
export interface Place {
  goal: Pose;
  way: Line | null;
}

/** A part that a hand has taken up. */
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

/** All places of a part, the one in the product first. */
export function placesOf(part: TakenPart, X_HB: Pose): [Place, ...Place[]] {
  const goal = compose(part.goal, inverse(X_HB));
  const way = part.step?.kind === "insert" ? wayInLine(goal, part.step.way_in, part.clearance) : null;
  return [{ goal, way }, ...part.tablePlaces.map((place) => placeOnTable(place, X_HB, part.radius))];
}

/** @param radius  Of the part [m]. */
export function placeOnTable(place: TablePlace, X_HB: Pose, radius: number): Place {
  const goal = compose(place.goal, inverse(X_HB));
  return { goal, way: wayInLine(goal, place.way_in, place.distance_m + kTableRoom * radius) };
}

/** The place whose way in is seen nearest to a point; the first one, in the product, where none is near. */
export function nearestPlace(places: readonly Place[], at: Vec3, eye: Sight): Place {
  const ray = eye.rayTo(at);
  const pixelsTo = ({ way }: Place): number => {
    if (way === null) {
      return Infinity;
    }
    const snap = pointAtLine(ray, way);
    return snap.off / eye.metresPerPixel(snap.p);
  };
  const seen = places.map(pixelsTo);
  const least = Math.min(...seen);
  return least < kTablePx ? places[seen.indexOf(least)]! : places[0]!;
}
