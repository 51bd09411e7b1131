import { BoxGeometry, Color, SphereGeometry, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import { makeCoarse } from "../src/view3d/coarse_shape";
import { joinPrimitives } from "../src/view3d/part_shape";

describe("the coarse mesh of a part", () => {
  it("has less than a tenth of a sphere's triangles, its size, and normals that point outwards", () => {
    const shape = joinPrimitives([{ geometry: new SphereGeometry(0.01, 64, 48), color: new Color(1, 0, 0) }]);
    const coarse = makeCoarse(shape)!;
    expect(coarse.index!.count).toBeLessThan(0.1 * shape.index.length);
    coarse.computeBoundingBox();
    const size = coarse.boundingBox!.getSize(new Vector3());
    const cell = 0.02 / 6;
    for (const side of size.toArray()) {
      expect(Math.abs(side - 0.02)).toBeLessThan(cell);
    }
    const [position, normal] = [new Vector3(), new Vector3()];
    for (let k = 0; k < coarse.getAttribute("position").count; k++) {
      position.fromBufferAttribute(coarse.getAttribute("position"), k);
      normal.fromBufferAttribute(coarse.getAttribute("normal"), k);
      expect(normal.dot(position.normalize())).toBeGreaterThan(0.7);
      expect(normal.length()).toBeCloseTo(1, 5);
    }
  });

  it("is not made where it would save little", () => {
    expect(makeCoarse(joinPrimitives([{ geometry: new BoxGeometry(1, 1, 1), color: new Color(1, 0, 0) }]))).toBeNull();
  });
});
