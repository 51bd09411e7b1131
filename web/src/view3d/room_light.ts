/** The material of the parts: a finish for each of them, and a room for metals to reflect. */

import { MeshStandardMaterial } from "three";

/** Radiance that comes from a direction of W, z up, blurred as a rough surface does: a floor, walls, and a ceiling with two
 rows of tubes and a window. It is a formula, as a picture of a room would have to be read twice for each pixel. All
 numbers are choices, made by eye beside the lamps of the stage. */
const kRoomLight = /* glsl */ `
  #ifdef HAS_ROOM
    uniform mat4 modelViewMatrix;
    vec3 roomLight(vec3 d, float roughness) {
      float blur = 0.04 + 0.9 * roughness;
      vec3 light = mix(vec3(0.3, 0.31, 0.33), vec3(0.84, 0.87, 0.92), smoothstep(-blur, blur, d.z));
      vec2 ceiling = d.xy / max(d.z, 0.05);
      float tubes = smoothstep(0.14 + blur, 0.14 - 0.5 * blur, abs(abs(ceiling.y + 0.25) - 0.6));
      float window = smoothstep(0.3 + blur, 0.3 - 0.5 * blur, abs(d.z - 0.35)) * smoothstep(0.75 - blur, 0.8 + 0.3 * blur, dot(d.xy, vec2(-0.78, -0.62)));
      float glare = 1.8 - 1.1 * roughness;
      return light + glare * (tubes * smoothstep(0.1, 0.5, d.z) * vec3(1.0, 0.98, 0.94) + 0.7 * window * vec3(0.88, 0.94, 1.0));
    }
  #endif
`;

/** In place of what three.js has for maps. The alpha of a part's colour carries encodeFinish(). */
const kReplaced: Record<string, string> = {
  "#include <common>": `#include <common>\n${kRoomLight}`,
  "#include <color_fragment>": "diffuseColor.rgb *= vColor.rgb;",
  "#include <roughnessmap_fragment>": /* glsl */ `
    float finish = floor(vColor.a + 0.5) - 1.0;
    float roughnessFactor = mod(finish, 16.0) / 15.0;
  `,
  "#include <metalnessmap_fragment>": /* glsl */ `
    #ifdef HAS_ROOM
      float metalnessFactor = floor(finish / 16.0) / 15.0;
    #else
      float metalnessFactor = metalness;
    #endif
  `,
  "#include <lights_fragment_maps>": /* glsl */ `
    #include <lights_fragment_maps>
    #ifdef HAS_ROOM
      // From the eye to the frame of the parts: a row vector times a matrix is the transposed matrix times it.
      vec3 mirrored = (vec4(reflect(-geometryViewDir, normal), 0.0) * modelViewMatrix).xyz;
      radiance += roomLight(normalize(mirrored), material.roughness);
    #endif
  `,
};

/** Makes the material of a batch whose colours carry finishes. Without the room metals have nothing to reflect: all parts
 have the metalness of the material then. */
export function makePartMaterial(): MeshStandardMaterial {
  const material = new MeshStandardMaterial({
    vertexColors: true,
    metalness: 0.12,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
  material.onBeforeCompile = (shader) => {
    for (const [from, to] of Object.entries(kReplaced)) {
      shader.fragmentShader = shader.fragmentShader.replace(from, to);
    }
  };
  return material;
}

export function setRoomLight(material: MeshStandardMaterial, hasRoom: boolean): void {
  const { HAS_ROOM: before, ...others } = material.defines ?? {};
  if ((before !== undefined) !== hasRoom) {
    material.defines = hasRoom ? { ...others, HAS_ROOM: "" } : others;
    material.needsUpdate = true;
  }
}
