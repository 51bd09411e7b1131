/** A place to work in: floor, walls, bench, lamp, and what stands on the bench. */

import {
  BackSide,
  BoxGeometry,
  BufferAttribute,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PlaneGeometry,
  Raycaster,
  Vector3,
  type BufferGeometry,
  type Material,
  type Ray,
  type Texture,
} from "three";
import { bakeLight, makeBakedMaterial } from "./baked_light";
import { benchSize, keepOnBench, type BenchItem, type BenchKind, type BenchSize } from "../../model/bench";
import { makeBenchItem } from "./bench_items";
import { makePegboard, makeWood } from "./textures";

const kBenchHeight = 0.92;
const kTop = 0.05;
const kRoomHeight = 2.9;
const kRoomMargin = 2.6;

interface Standing {
  item: BenchItem;
  mesh: Mesh;
}

/** Texture coordinates in metres, so that grain has its size on every board. */
function scaleUv(geometry: BoxGeometry, x: number, y: number, z: number): BoxGeometry {
  const uv = geometry.getAttribute("uv") as BufferAttribute;
  const normal = geometry.getAttribute("normal");
  for (let k = 0; k < uv.count; k++) {
    const [nx, nz] = [Math.abs(normal.getX(k)), Math.abs(normal.getZ(k))];
    const [u, v] = nz > 0.5 ? [x, y] : nx > 0.5 ? [y, z] : [x, z];
    uv.setXY(k, uv.getX(k) * u, uv.getY(k) * v);
  }
  return geometry;
}

/** The bench's top is lit in so many pieces each way, so that the lamp's spot is round. */
const kTopParts = 24;
/** Bench and room are drawn after the opaque parts, so that nothing of them is drawn where a part hides them. */
const kBehindParts = 1;
/** The walls from below: a skirting, paint, a line, plaster; heights over the floor [m]. */
const kWallBands = [
  { from: 0, to: 0.1, color: 0x44586a },
  { from: 0.1, to: 1.1, color: 0x5d7184 },
  { from: 1.1, to: 1.125, color: 0x44586a },
  { from: 1.125, to: kRoomHeight, color: 0xc9cdd2 },
];
/** Light that walls throw back at each other. */
const kWallLight = 0.35;

/** Of the lamp over the bench, at a place on it [m]. */
function lampLight(place: Vector3): number {
  return 0.3 / (1 + 4 * ((place.x - 0.2) ** 2 + (place.y + 0.1) ** 2));
}

export class Workshop {
  readonly root = new Group();
  size: BenchSize = { x: 1, y: 0.6 };
  private readonly building = new Group();
  private readonly standing: Standing[] = [];
  private readonly shapes = new Map<BenchKind, BufferGeometry>();
  private readonly itemMaterial = new MeshLambertMaterial({ vertexColors: true });
  private readonly textures = {
    wood: makeWood(),
    board: makePegboard(),
  };
  private readonly caster = new Raycaster();

  constructor() {
    this.root.add(this.building);
  }

  /** Around a product in this sphere, with the bench's top where it lies. */
  fit(centre: Vector3, radius: number, tableZ: number): void {
    this.size = benchSize(radius);
    this.root.position.set(centre.x, centre.y, tableZ - 5e-4);
    this.clearBuilding();
    this.buildBench();
    this.buildRoom();
    this.building.children.forEach((each) => (each.renderOrder = kBehindParts));
  }

  /** What stands on the bench now. */
  setItems(items: readonly BenchItem[]): void {
    this.standing.forEach(({ mesh }) => mesh.removeFromParent());
    this.standing.length = 0;
    for (const each of items) {
      const item = keepOnBench(each, this.size);
      const mesh = new Mesh(this.shapeOf(item.kind), this.itemMaterial);
      mesh.castShadow = mesh.receiveShadow = true;
      mesh.position.set(item.x, item.y, 0);
      mesh.rotation.z = item.turn;
      this.root.add(mesh);
      this.standing.push({ item, mesh });
    }
  }

  /** The item that a ray of W meets, and how far away. */
  pick(ray: Ray): { kind: BenchKind; distance: number } | null {
    this.caster.ray.copy(ray);
    this.root.updateMatrixWorld(true);
    const hit = this.caster.intersectObjects(this.standing.map((s) => s.mesh), false)[0];
    const found = this.standing.find((s) => s.mesh === hit?.object);
    return hit === undefined || found === undefined ? null : { kind: found.item.kind, distance: hit.distance };
  }

  /** Where a ray of W meets the bench's top, from its middle [m]. */
  pointOnBench(ray: Ray): { x: number; y: number } | null {
    const slope = ray.direction.z;
    const t = (this.root.position.z - ray.origin.z) / slope;
    if (Math.abs(slope) < 1e-4 || t <= 0) {
      return null;
    }
    const at = ray.at(t, new Vector3()).sub(this.root.position);
    return { x: at.x, y: at.y };
  }

  dispose(): void {
    this.clearBuilding();
    this.shapes.forEach((shape) => shape.dispose());
    this.itemMaterial.dispose();
    Object.values(this.textures).forEach((texture) => texture.dispose());
    this.root.removeFromParent();
  }

  private shapeOf(kind: BenchKind): BufferGeometry {
    const known = this.shapes.get(kind) ?? makeBenchItem(kind);
    this.shapes.set(kind, known);
    return known;
  }

  private buildBench(): void {
    const { x, y } = this.size;
    const wood = makeBakedMaterial(0xffffff, { map: this.textures.wood });
    const steel = makeBakedMaterial(0x4b5560);
    const add = (w: number, d: number, h: number, at: Vector3, material: Material, parts = 1) => {
      const geometry = scaleUv(new BoxGeometry(w, d, h, parts, parts), w, d, h);
      const mesh = new Mesh(bakeLight(geometry, (place) => lampLight(place.add(at))), material);
      mesh.position.copy(at);
      this.building.add(mesh);
    };
    add(2 * x, 2 * y, kTop, new Vector3(0, 0, -kTop / 2), wood, kTopParts);
    const leg = kBenchHeight - kTop;
    for (const [u, v] of [[-1, -1], [-1, 1], [1, -1], [1, 1]] as const) {
      add(0.07, 0.07, leg, new Vector3(u * (x - 0.08), v * (y - 0.08), -kTop - leg / 2), steel);
    }
    add(2 * x - 0.16, 0.03, 0.1, new Vector3(0, y - 0.08, -kTop - 0.07), steel);
    add(2 * x - 0.16, 2 * y - 0.16, 0.02, new Vector3(0, 0, -kBenchHeight + 0.2), wood);
  }

  private buildRoom(): void {
    const { x, y } = this.size;
    const [width, depth] = [2 * (x + kRoomMargin), 2 * (y + kRoomMargin)];
    const floorZ = -kBenchHeight;
    for (const { from, to, color } of kWallBands) {
      const geometry = new BoxGeometry(width, depth, to - from);
      keepOnlySides(geometry);
      // Seen from within only: from outside one looks in.
      const paint = makeBakedMaterial(color, { side: BackSide });
      const band = new Mesh(bakeLight(geometry, () => kWallLight, -1), paint);
      band.position.z = floorZ + (from + to) / 2;
      this.building.add(band);
    }
    const concrete = makeBakedMaterial(0x8c9095);
    const floor = new Mesh(bakeLight(new PlaneGeometry(width, depth, kTopParts, kTopParts), lampLight), concrete);
    floor.position.z = floorZ;
    const board = this.plane(1.9 * x, 0.7, this.textures.board);
    board.rotation.x = Math.PI / 2;
    board.position.set(0, depth / 2 - 0.02, floorZ + 1.75);
    this.building.add(floor, board, ...this.makeLights());
  }

  private makeLights(): Mesh[] {
    const glow = new MeshBasicMaterial({ color: 0xfff6e6 });
    return [-0.6, 0.6].map((share) => {
      const tube = new Mesh(new BoxGeometry(1.2, 0.09, 0.04), glow);
      tube.position.set(share * (this.size.x + 1), 0.4, kRoomHeight - kBenchHeight - 0.05);
      return tube;
    });
  }

  private plane(width: number, depth: number, texture: Texture): Mesh {
    const geometry = new PlaneGeometry(width, depth);
    const uv = geometry.getAttribute("uv") as BufferAttribute;
    for (let k = 0; k < uv.count; k++) {
      uv.setXY(k, uv.getX(k) * width, uv.getY(k) * depth);
    }
    return new Mesh(bakeLight(geometry), makeBakedMaterial(0xffffff, { map: texture }));
  }

  private clearBuilding(): void {
    this.building.traverse((object) => {
      if (object instanceof Mesh) {
        (object.geometry as BufferGeometry).dispose();
        (object.material as Material).dispose();
      }
    });
    this.building.clear();
  }
}

/** A box without floor and ceiling. */
function keepOnlySides(geometry: BufferGeometry): void {
  const normal = geometry.getAttribute("normal");
  const index = geometry.index!;
  const kept: number[] = [];
  for (let k = 0; k < index.count; k += 3) {
    if (Math.abs(normal.getZ(index.getX(k))) < 0.5) {
      kept.push(index.getX(k), index.getX(k + 1), index.getX(k + 2));
    }
  }
  geometry.setIndex(kept);
}

