/** Light that is reckoned once, at the corners of what stands still: each pixel has one multiplication left. */

import {
  BufferAttribute,
  Color,
  LinearSRGBColorSpace,
  MeshBasicMaterial,
  NoColorSpace,
  SRGBColorSpace,
  Vector3,
  type BufferGeometry,
  type Side,
  type Texture,
} from "three";

/** Where light comes from, in the frame of the geometry. The numbers were chosen beside the lit parts, by eye. */
const kSun = new Vector3(-0.32, -0.44, 0.84);
const kSky = 0.55; // from above; a third of it from below
const kSunShare = 0.45;

/** Colours the corners by the light that falls on them, for a material of makeBakedMaterial.
 @param more  Light of a lamp at a point, added to that of sun and sky.
 @param sign  -1 for what is seen from its inside. */
export function bakeLight(geometry: BufferGeometry, more: (at: Vector3) => number = () => 0, sign = 1): BufferGeometry {
  const normals = geometry.getAttribute("normal");
  const places = geometry.getAttribute("position");
  const colors = new Float32Array(3 * places.count);
  const normal = new Vector3();
  const place = new Vector3();
  const shade = new Color();
  for (let k = 0; k < places.count; k++) {
    normal.fromBufferAttribute(normals, k).multiplyScalar(sign);
    place.fromBufferAttribute(places, k);
    const sky = kSky * (2 / 3 + normal.z / 3);
    shade.setScalar(sky + kSunShare * Math.max(0, normal.dot(kSun)) + more(place)).convertLinearToSRGB();
    shade.toArray(colors, 3 * k);
  }
  geometry.setAttribute("color", new BufferAttribute(colors, 3));
  return geometry;
}

/** Makes the material of a baked surface. Colour and light are multiplied as they are coded for the screen: sRGB is
 nearly a power law, for which the product of codes is the code of the product. No pixel is decoded and coded again.
 @param map  Of no colour space, so that its texels are taken as they are. */
export function makeBakedMaterial(color: number, { map = null, side }: { map?: Texture | null; side?: Side } = {}): MeshBasicMaterial {
  if (map !== null) {
    map.colorSpace = NoColorSpace;
  }
  const material = new MeshBasicMaterial({ map, vertexColors: true, ...(side === undefined ? {} : { side }) });
  material.color.setHex(color, LinearSRGBColorSpace); // as it is coded
  material.onBeforeCompile = (shader) => {
    // Pictures for a later pass, as of the anaglyph, are linear.
    const isShown = (shader as typeof shader & { outputColorSpace: string }).outputColorSpace === SRGBColorSpace;
    const linear = "gl_FragColor = sRGBTransferEOTF(gl_FragColor);";
    shader.fragmentShader = shader.fragmentShader.replace("#include <colorspace_fragment>", isShown ? "" : linear);
  };
  return material;
}
