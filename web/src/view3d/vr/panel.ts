/** A flat panel in the room: text, bars and buttons, drawn on a canvas and pressed with a ray. */

import {
  CanvasTexture,
  LinearFilter,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  Raycaster,
  SRGBColorSpace,
  type Ray,
} from "three";

export interface PanelButton {
  id: string;
  label: string;
  isOn?: boolean;
  isBad?: boolean;
}

export interface PanelBar {
  label: string;
  value: string;
  /** 0 to 1. */
  share: number;
  color: string;
}

export interface PanelContent {
  title: string;
  lines: readonly string[];
  bars: readonly PanelBar[];
  /** Rows of buttons, from above. */
  buttons: readonly (readonly PanelButton[])[];
}

interface Placed extends PanelButton {
  x: number;
  y: number;
  width: number;
  height: number;
}

const kPixelsPerMetre = 1600;
const kInk = "#e8ebf1";
const kQuiet = "#a3adbd";
const kBack = "#1e2430";
const kRim = "#5a6678";
const kRaised = "#34405a";
const kAccent = "#4f9dff";
const kBad = "#ff6b6b";
const kFont = "system-ui, 'Segoe UI', Roboto, 'Noto Sans', sans-serif";

export class Panel {
  readonly mesh: Mesh<PlaneGeometry, MeshBasicMaterial>;
  private readonly canvas = document.createElement("canvas");
  private readonly pen: CanvasRenderingContext2D;
  private readonly texture: CanvasTexture;
  private readonly caster = new Raycaster();
  private placed: Placed[] = [];
  private drawn = "";

  /** @param em  Height of its text [m]. */
  constructor(width: number, height: number, private readonly em: number) {
    this.canvas.width = Math.round(width * kPixelsPerMetre);
    this.canvas.height = Math.round(height * kPixelsPerMetre);
    this.pen = this.canvas.getContext("2d")!;
    this.texture = new CanvasTexture(this.canvas);
    this.texture.colorSpace = SRGBColorSpace;
    this.texture.minFilter = LinearFilter;
    this.mesh = new Mesh(
      new PlaneGeometry(width, height),
      new MeshBasicMaterial({ map: this.texture, transparent: true, toneMapped: false }),
    );
    this.mesh.renderOrder = 40;
  }

  /** Draws what has changed since the last time. @param pointed  The button that is pointed at. */
  show(content: PanelContent, pointed: string | null): void {
    const key = JSON.stringify([content, pointed]);
    if (key === this.drawn) {
      return;
    }
    this.drawn = key;
    const { pen, canvas } = this;
    const em = this.em * kPixelsPerMetre;
    pen.clearRect(0, 0, canvas.width, canvas.height);
    this.box(2, 2, canvas.width - 4, canvas.height - 4, 0.7 * em, kBack);
    pen.lineWidth = 3;
    pen.strokeStyle = kRim;
    pen.stroke();
    let y = 1.5 * em;
    this.text(content.title, 0.8 * em, y, 1.12 * em, kInk, true);
    for (const line of content.lines) {
      y = this.paragraph(line, y + 1.45 * em, em);
    }
    for (const bar of content.bars) {
      y += 1.7 * em;
      this.bar(bar, y, em);
    }
    this.buttons(content.buttons, pointed, em);
    this.texture.needsUpdate = true;
  }

  /** The button that a ray of the room meets, and how far from where it begins. */
  hit(ray: Ray): { button: string | null; distance: number } | null {
    this.mesh.updateWorldMatrix(true, false);
    this.caster.ray.copy(ray);
    const found = this.mesh.visible ? this.caster.intersectObject(this.mesh, false)[0] : undefined;
    if (found?.uv === undefined) {
      return null;
    }
    const x = found.uv.x * this.canvas.width;
    const y = (1 - found.uv.y) * this.canvas.height;
    const button = this.placed.find((b) => x >= b.x && x <= b.x + b.width && y >= b.y && y <= b.y + b.height);
    return { button: button?.id ?? null, distance: found.distance };
  }

  /** Where a button is, in the frame of the mesh [m]; null where there is none. */
  find(id: string): { x: number; y: number } | null {
    const button = this.placed.find((b) => b.id === id);
    return button === undefined
      ? null
      : {
          x: (button.x + button.width / 2 - this.canvas.width / 2) / kPixelsPerMetre,
          y: -(button.y + button.height / 2 - this.canvas.height / 2) / kPixelsPerMetre,
        };
  }

  dispose(): void {
    this.mesh.removeFromParent();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
    this.texture.dispose();
  }

  /** Words as lines that fit. @return Where the last one stands. */
  private paragraph(words: string, y: number, em: number): number {
    const most = this.canvas.width - 1.6 * em;
    this.pen.font = `${em}px ${kFont}`;
    let line = "";
    for (const word of words.split(" ")) {
      const longer = line === "" ? word : `${line} ${word}`;
      if (this.pen.measureText(longer).width > most && line !== "") {
        this.text(line, 0.8 * em, y, em, kQuiet);
        y += 1.3 * em;
        line = word;
      } else {
        line = longer;
      }
    }
    this.text(line, 0.8 * em, y, em, kQuiet);
    return y;
  }

  private bar({ label, value, share, color }: PanelBar, y: number, em: number): void {
    const { width } = this.canvas;
    const [from, to] = [0.34 * width, 0.7 * width];
    this.text(label, 0.8 * em, y, 0.95 * em, kQuiet);
    this.box(from, y - 0.65 * em, to - from, 0.6 * em, 0.3 * em, kRaised);
    const filled = Math.min(1, Math.max(0, share)) * (to - from);
    if (filled > 1) {
      this.box(from, y - 0.65 * em, filled, 0.6 * em, Math.min(0.3 * em, filled / 2), color);
    }
    this.text(value, to + 0.5 * em, y, 0.95 * em, kInk);
  }

  private buttons(rows: PanelContent["buttons"], pointed: string | null, em: number): void {
    this.placed = [];
    const height = 1.9 * em;
    const gap = 0.4 * em;
    let y = this.canvas.height - rows.length * (height + gap) - 0.4 * em;
    for (const row of rows) {
      const width = (this.canvas.width - 1.6 * em - (row.length - 1) * gap) / Math.max(1, row.length);
      row.forEach((button, k) => {
        const placed = { ...button, x: 0.8 * em + k * (width + gap), y, width, height };
        this.placed.push(placed);
        this.button(placed, button.id === pointed, em);
      });
      y += height + gap;
    }
  }

  private button(button: Placed, isPointed: boolean, em: number): void {
    const { pen } = this;
    this.box(button.x, button.y, button.width, button.height, 0.4 * em, button.isOn ? kAccent : kRaised);
    if (isPointed || button.isBad) {
      pen.lineWidth = 0.12 * em;
      pen.strokeStyle = isPointed ? kInk : kBad;
      pen.stroke();
    }
    pen.textAlign = "center";
    const ink = button.isOn ? "#06142a" : button.isBad ? kBad : kInk;
    this.text(button.label, button.x + button.width / 2, button.y + 1.28 * em, 0.92 * em, ink, true, button.width - 0.4 * em);
    pen.textAlign = "left";
  }

  private box(x: number, y: number, width: number, height: number, radius: number, color: string): void {
    this.pen.beginPath();
    this.pen.roundRect(x, y, width, height, radius);
    this.pen.fillStyle = color;
    this.pen.fill();
  }

  private text(words: string, x: number, y: number, size: number, ink: string, isBold = false, most?: number): void {
    this.pen.font = `${isBold ? 650 : 400} ${size}px ${kFont}`;
    this.pen.fillStyle = ink;
    this.pen.fillText(words, x, y, most ?? this.canvas.width - x - 0.4 * size);
  }
}
