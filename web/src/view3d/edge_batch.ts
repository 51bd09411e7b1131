/** The edges of all parts in one draw call: each vertex finds the pose of its part in a texture. */

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DataTexture,
  DynamicDrawUsage,
  FloatType,
  LineSegments,
  NearestFilter,
  RGBAFormat,
  ShaderMaterial,
  type Matrix4,
} from "three";
import { kEdgeFloats } from "./edges";
import type { PartShape } from "./part_shape";

const kVertex = /* glsl */ `
  #include <clipping_planes_pars_vertex>
  uniform sampler2D poses;
  uniform vec3 ink, markedInk;
  attribute float instance;
  attribute vec3 normalA, normalB;
  varying vec4 vInk;
  void main() {
    int row = int(instance + 0.5);
    vec4 a = texelFetch(poses, ivec2(0, row), 0);
    vec4 b = texelFetch(poses, ivec2(1, row), 0);
    vec4 c = texelFetch(poses, ivec2(2, row), 0);
    vec4 d = texelFetch(poses, ivec2(3, row), 0);
    // The fourth row of the matrix is free: it carries how strongly to draw, and whether marked.
    float strength = a.w;
    float marked = b.w;
    mat4 pose = mat4(vec4(a.xyz, 0.0), vec4(b.xyz, 0.0), vec4(c.xyz, 0.0), vec4(d.xyz, 1.0));
    vec4 mvPosition = modelViewMatrix * pose * vec4(position, 1.0);
    mat3 turn = mat3(modelViewMatrix) * mat3(pose);
    vec3 toEye = isOrthographic ? vec3(0.0, 0.0, 1.0) : -mvPosition.xyz;
    bool isHidden = dot(turn * normalA, toEye) < 0.0 && dot(turn * normalB, toEye) < 0.0;
    vInk = vec4(mix(ink, markedInk, marked), strength);
    #include <clipping_planes_vertex>
    // A little nearer than the faces that it bounds, and no more: else it shows through thin walls.
    mvPosition.xyz *= isOrthographic ? 1.0 : 0.9993;
    gl_Position = projectionMatrix * mvPosition;
    gl_Position.z -= isOrthographic ? 2e-5 : 0.0;
    if (isHidden || strength <= 0.0) {
      gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    }
  }
`;

const kFragment = /* glsl */ `
  #include <clipping_planes_pars_fragment>
  varying vec4 vInk;
  void main() {
    #include <clipping_planes_fragment>
    gl_FragColor = vInk;
    #include <colorspace_fragment>
  }
`;

export class EdgeBatch {
  readonly object: LineSegments<BufferGeometry, ShaderMaterial>;
  private readonly texture: DataTexture;
  private readonly poses: Float32Array;
  /** Of each part, the first of its corners; and the end of all. */
  private readonly starts: readonly number[];

  constructor(shapes: readonly PartShape[]) {
    this.poses = new Float32Array(16 * Math.max(1, shapes.length));
    this.texture = new DataTexture(this.poses, 4, Math.max(1, shapes.length), RGBAFormat, FloatType);
    this.texture.minFilter = this.texture.magFilter = NearestFilter;
    const material = new ShaderMaterial({
      vertexShader: kVertex,
      fragmentShader: kFragment,
      uniforms: {
        poses: { value: this.texture },
        ink: { value: new Color(0x10151d) },
        markedInk: { value: new Color(0xffffff) },
      },
      transparent: true,
      depthWrite: false,
      clipping: true,
    });
    let end = 0;
    this.starts = [0, ...shapes.map(({ edges }) => (end += (2 * edges.length) / kEdgeFloats))];
    this.object = new LineSegments(makeGeometry(shapes), material);
    this.object.frustumCulled = false;
    this.object.renderOrder = 1;
  }

  /** Draws the edges of these parts only: what is small in the picture has none. */
  draw(isDrawn: (instance: number) => boolean): void {
    const { geometry } = this.object;
    if (geometry.index === null) {
      geometry.setIndex(new BufferAttribute(new Uint32Array(this.starts.at(-1) ?? 0), 1).setUsage(DynamicDrawUsage));
    }
    const index = geometry.index!.array;
    let at = 0;
    for (let instance = 0; instance + 1 < this.starts.length; instance++) {
      const end = isDrawn(instance) ? (this.starts[instance + 1] ?? 0) : 0;
      for (let corner = this.starts[instance] ?? 0; corner < end; corner++) {
        index[at++] = corner;
      }
    }
    geometry.index!.needsUpdate = true;
    geometry.setDrawRange(0, at);
  }

  /** Takes the edges of a part whose form has changed; there are as many as before. */
  reshape(instance: number, edges: Float32Array): void {
    const positions = this.object.geometry.getAttribute("position");
    let corner = this.starts[instance] ?? 0;
    for (let k = 0; k < edges.length; k += kEdgeFloats) {
      for (const at of [k, k + 3]) {
        positions.setXYZ(corner++, edges[at] ?? 0, edges[at + 1] ?? 0, edges[at + 2] ?? 0);
      }
    }
    positions.needsUpdate = true;
  }

  setInk(ink: Color, marked: Color): void {
    (this.object.material.uniforms["ink"]!.value as Color).copy(ink);
    (this.object.material.uniforms["markedInk"]!.value as Color).copy(marked);
  }

  /** @param strength  0: not drawn, 1: full. */
  setPose(instance: number, matrix: Matrix4, strength: number, isMarked: boolean): void {
    const at = 16 * instance;
    this.poses.set(matrix.elements, at);
    this.poses[at + 3] = strength;
    this.poses[at + 7] = isMarked ? 1 : 0;
    this.texture.needsUpdate = true;
  }

  dispose(): void {
    this.object.geometry.dispose();
    this.object.material.dispose();
    this.texture.dispose();
  }
}

function makeGeometry(shapes: readonly PartShape[]): BufferGeometry {
  const segments = shapes.reduce((n, s) => n + s.edges.length / kEdgeFloats, 0);
  const positions = new Float32Array(6 * segments);
  const normalsA = new Float32Array(6 * segments);
  const normalsB = new Float32Array(6 * segments);
  const instances = new Float32Array(2 * segments);
  let at = 0;
  shapes.forEach((shape, instance) => {
    const edges = shape.edges;
    for (let k = 0; k < edges.length; k += kEdgeFloats) {
      for (let end = 0; end < 2; end++) {
        positions.set(edges.subarray(k + 3 * end, k + 3 * end + 3), 3 * at);
        normalsA.set(edges.subarray(k + 6, k + 9), 3 * at);
        normalsB.set(edges.subarray(k + 9, k + 12), 3 * at);
        instances[at] = instance;
        at += 1;
      }
    }
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setAttribute("normalA", new BufferAttribute(normalsA, 3));
  geometry.setAttribute("normalB", new BufferAttribute(normalsB, 3));
  geometry.setAttribute("instance", new BufferAttribute(instances, 1));
  return geometry;
}
