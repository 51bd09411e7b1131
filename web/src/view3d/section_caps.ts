/** A plane that cuts the product, and the cut surfaces filled, each with its part's colour. */

import {
  AlwaysStencilFunc,
  BackSide,
  CanvasTexture,
  Color,
  DecrementWrapStencilOp,
  FrontSide,
  Group,
  IncrementWrapStencilOp,
  KeepStencilOp,
  Mesh,
  MeshBasicMaterial,
  NotEqualStencilFunc,
  Plane,
  PlaneGeometry,
  RepeatWrapping,
  Scene,
  Vector3,
  ZeroStencilOp,
  type Matrix4,
  type Sphere,
  type StencilOp,
} from "three";
import type { SectionPlane } from "../model/view_link";
import type { PartShape } from "./part_shape";
import type { Parts } from "./parts";

/** Each cut part costs three draw calls. */
const kMostCaps = 120;

function stencilMaterial(plane: Plane, side: typeof FrontSide | typeof BackSide, op: StencilOp): MeshBasicMaterial {
  return new MeshBasicMaterial({
    side,
    clippingPlanes: [plane],
    depthWrite: false,
    depthTest: false,
    colorWrite: false,
    stencilWrite: true,
    stencilFunc: AlwaysStencilFunc,
    stencilFail: op,
    stencilZFail: op,
    stencilZPass: op,
  });
}

/** Diagonal lines, as on a drawing. */
function makeHatch(): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 32;
  const pen = canvas.getContext("2d")!;
  pen.fillStyle = "#ffffff";
  pen.fillRect(0, 0, 32, 32);
  pen.strokeStyle = "rgba(0,0,0,0.32)";
  pen.lineWidth = 3;
  for (const shift of [-32, 0, 32]) {
    pen.beginPath();
    pen.moveTo(shift - 4, 36);
    pen.lineTo(shift + 36, -4);
    pen.stroke();
  }
  const texture = new CanvasTexture(canvas);
  texture.wrapS = texture.wrapT = RepeatWrapping;
  return texture;
}

export class SectionCaps {
  readonly plane = new Plane(new Vector3(0, 0, -1), 0);
  readonly scene = new Scene();
  private readonly back = stencilMaterial(this.plane, BackSide, IncrementWrapStencilOp);
  private readonly front = stencilMaterial(this.plane, FrontSide, DecrementWrapStencilOp);
  private readonly hatch = makeHatch();
  private readonly quad = new PlaneGeometry(1, 1);
  private readonly caps = new Map<number, Group>();
  private size = 1;

  /** Puts the plane where the section says, for a product in this sphere. */
  place(section: SectionPlane, sphere: Sphere): void {
    const normal = new Vector3().setComponent(section.axis, section.isFlipped ? 1 : -1);
    const at = sphere.center.clone();
    at.setComponent(section.axis, at.getComponent(section.axis) + section.offset * sphere.radius);
    this.plane.setFromNormalAndCoplanarPoint(normal, at);
    this.size = 2.5 * sphere.radius;
  }

  /** Makes and moves what is needed for the parts that the plane goes through now. */
  update(parts: Parts): void {
    let count = 0;
    const centre = new Vector3();
    for (const entry of parts.entries) {
      centre.copy(entry.shape.sphere.center).applyMatrix4(entry.matrix);
      const isCut =
        !entry.look.isHidden &&
        !entry.look.isGhost &&
        Math.abs(this.plane.distanceToPoint(centre)) < entry.shape.sphere.radius &&
        count++ < kMostCaps;
      const known = this.caps.get(entry.occurrence);
      if (!isCut) {
        if (known !== undefined) {
          known.visible = false;
        }
        continue;
      }
      const cap = known ?? this.makeCap(entry.occurrence, entry.shape);
      cap.visible = true;
      this.placeCap(cap, entry.matrix, entry.look.tint, entry.look.amount);
    }
  }

  clear(): void {
    for (const cap of this.caps.values()) {
      ((cap.children[2] as Mesh).material as MeshBasicMaterial).dispose();
    }
    this.caps.clear();
    this.scene.clear();
  }

  dispose(): void {
    this.clear();
    [this.back, this.front, this.hatch, this.quad].forEach((each) => each.dispose());
  }

  private makeCap(occurrence: number, shape: PartShape): Group {
    const base = (shape.color ?? new Color(0.6, 0.6, 0.6)).clone();
    const fill = new MeshBasicMaterial({
      map: this.hatch,
      stencilWrite: true,
      stencilRef: 0,
      stencilFunc: NotEqualStencilFunc,
      stencilFail: KeepStencilOp,
      stencilZFail: ZeroStencilOp,
      stencilZPass: ZeroStencilOp,
    });
    fill.userData["base"] = base;
    const cap = new Group();
    const order = 10 + 3 * this.caps.size;
    [new Mesh(shape.geometry, this.back), new Mesh(shape.geometry, this.front), new Mesh(this.quad, fill)].forEach(
      (mesh, k) => {
        mesh.renderOrder = order + k;
        mesh.frustumCulled = false;
        mesh.matrixAutoUpdate = false;
        cap.add(mesh);
      },
    );
    this.caps.set(occurrence, cap);
    this.scene.add(cap);
    return cap;
  }

  private placeCap(cap: Group, matrix: Matrix4, tint: Color | null, amount: number): void {
    const [back, front, quad] = cap.children as [Mesh, Mesh, Mesh<PlaneGeometry, MeshBasicMaterial>];
    back.matrix.copy(matrix);
    front.matrix.copy(matrix);
    const { normal } = this.plane;
    const at = this.plane.coplanarPoint(new Vector3());
    quad.position.copy(at);
    quad.up.set(0, Math.abs(normal.y) > 0.9 ? 0 : 1, Math.abs(normal.y) > 0.9 ? 1 : 0);
    quad.lookAt(at.clone().sub(normal));
    quad.scale.setScalar(2 * this.size);
    quad.updateMatrix();
    const material = quad.material;
    material.color.copy(material.userData["base"] as Color).lerp(new Color(1, 1, 1), 0.25);
    if (tint !== null) {
      material.color.lerp(tint, amount);
    }
    this.hatch.repeat.setScalar(45);
  }
}
