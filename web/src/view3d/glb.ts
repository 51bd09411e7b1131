/** Loads the product's meshes: which shape each occurrence has. */

import { Color, type BufferGeometry, type Material, type Mesh, type MeshStandardMaterial, type Object3D } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { joinPrimitives, type PartShape } from "./part_shape";

function colorOf(material: Material | Material[]): Color {
  const single = Array.isArray(material) ? material[0] : material;
  return (single as MeshStandardMaterial | undefined)?.color ?? new Color(0.6, 0.6, 0.6);
}

function meshesOf(node: Object3D): Mesh[] {
  const meshes: Mesh[] = [];
  node.traverse((child) => {
    if ((child as Mesh).isMesh) {
      meshes.push(child as Mesh);
    }
  });
  return meshes;
}

/** @param onBytes  Hears how many bytes there are by now.
 @return Shapes by occurrence; like parts share one. */
export async function loadShapes(url: string, onBytes: (count: number) => void = () => {}): Promise<Map<number, PartShape>> {
  const gltf = await new GLTFLoader().loadAsync(url, ({ loaded }) => onBytes(loaded));
  const shapes = new Map<number, PartShape>();
  const byGeometry = new Map<BufferGeometry, PartShape>();
  gltf.scene.traverse((node) => {
    const occurrence: unknown = node.userData["occurrence"];
    if (typeof occurrence !== "number" || shapes.has(occurrence)) {
      return;
    }
    const meshes = meshesOf(node);
    const first = meshes[0];
    if (first === undefined) {
      return;
    }
    let shape = byGeometry.get(first.geometry);
    if (shape === undefined) {
      shape = joinPrimitives(meshes.map((m) => ({ geometry: m.geometry, color: colorOf(m.material) })));
      byGeometry.set(first.geometry, shape);
    }
    shapes.set(occurrence, shape);
  });
  return shapes;
}
