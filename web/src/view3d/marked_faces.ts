/** Which faces are marked in the view. */

import type { Matrix4 } from "three";
import type { ViewState } from "../model/view_state";
import type { FaceOf, Mate } from "../protocol/messages";
import type { PartShape } from "./part_shape";
import type { Parts } from "./parts";

/** Those that were picked, the one that is selected, and both sides of the mate that is looked at. */
export function markedFaces(view: ViewState, mates: readonly Mate[]): FaceOf[] {
  const selected = view.selectedFace.value;
  const lit = view.litMate.value;
  const mate = mates.find(({ id }) => id === lit);
  return [
    ...view.picked.value,
    ...(selected === null ? [] : [selected]),
    ...(mate?.faces_a ?? []).map((face) => ({ occurrence: mate!.a, face })),
    ...(mate?.faces_b ?? []).map((face) => ({ occurrence: mate!.b, face })),
  ];
}

/** These faces with the shapes of their parts, and where they stand. */
export function shapesOfFaces(faces: readonly FaceOf[], parts: Parts | null): { shape: PartShape; matrix: Matrix4; face: number }[] {
  return faces.flatMap(({ occurrence, face }) => {
    const shape = parts?.shapeOf(occurrence);
    const matrix = parts?.matrixOf(occurrence);
    return shape && matrix ? [{ shape, matrix, face }] : [];
  });
}
