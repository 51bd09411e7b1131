/** Light that is reckoned once, at the corners of what stands still: nothing is left of it to do in each pixel. */

import { BufferAttribute, Vector3, type BufferGeometry } from "three";

/** Where light comes from, in the frame of the geometry. The numbers were chosen beside the lit parts, by eye. */
const kSun = new Vector3(-0.32, -0.44, 0.84);
const kSky = 0.55; // from above; a third of it from below
const kSunShare = 0.45;

/** Colours the corners by the light that falls on them.
 @param more  Light of a lamp at a point, added to that of sun and sky.
 @param sign  -1 for what is seen from its inside. */
export function bakeLight(geometry: BufferGeometry, more: (at: Vector3) => number = () => 0, sign = 1): BufferGeometry {
  const normals = geometry.getAttribute("normal");
  const places = geometry.getAttribute("position");
  const colors = new Float32Array(3 * places.count);
  const normal = new Vector3();
  const place = new Vector3();
  for (let k = 0; k < places.count; k++) {
    normal.fromBufferAttribute(normals, k).multiplyScalar(sign);
    place.fromBufferAttribute(places, k);
    const sky = kSky * (2 / 3 + normal.z / 3);
    const light = sky + kSunShare * Math.max(0, normal.dot(kSun)) + more(place);
    colors.set([light, light, light], 3 * k);
  }
  geometry.setAttribute("color", new BufferAttribute(colors, 3));
  return geometry;
}
