/** The panel on the wrist, and the one that stands before the user. */

import { Matrix4, Vector3, type Object3D } from "three";
import { liveNumbers } from "../../model/hints";
import type { ViewState } from "../../model/view_state";
import type { LiveState } from "../../protocol/frame_store";
import type { VrAction, VrHost } from "./host";
import { Panel, type PanelBar } from "./panel";
import type { UserHand } from "./user_hand";
import type { VrWorld } from "./vr_world";

/** Before the eyes, and below the line of sight [m]. */
const kDistance = 1.2;
const kBelow = 0.12;
const kBeside = 0.5;
const kForceFull = 8;
const kRedrawMs = 100;
const kOnWrist = new Matrix4()
  .makeRotationX(-0.9)
  .setPosition(0, 0.075, 0.03);

export class VrPanels {
  readonly wrist = new Panel(0.2, 0.155, 0.0098);
  readonly main = new Panel(0.56, 0.34, 0.0195);
  private readonly pointed = new Map<UserHand, { panel: Panel; button: string }>();
  private isPlaced = false;
  private lastDrawn = 0;

  constructor(
    private readonly room: Object3D,
    private readonly world: VrWorld,
    private readonly host: VrHost,
    private readonly view: ViewState,
  ) {
    room.add(this.wrist.mesh, this.main.mesh);
    this.wrist.mesh.matrixAutoUpdate = false;
  }

  update(hands: readonly UserHand[], live: LiveState | null, now: number): void {
    if (!this.isPlaced) {
      this.placeMain();
    }
    this.placeOnWrist(hands);
    this.point(hands);
    if (now - this.lastDrawn > kRedrawMs) {
      this.lastDrawn = now;
      this.draw(live);
    }
  }

  /** A button that this hand points at is pressed. @return Whether there was one. */
  press(hand: UserHand): boolean {
    const at = this.pointed.get(hand);
    if (at === undefined) {
      return false;
    }
    this.run(at.button);
    return true;
  }

  /** To the side of the product, upright, facing the eyes. */
  placeMain(): void {
    this.isPlaced = true;
    const { p, yaw } = this.world.head;
    const angle = yaw - Math.asin(kBeside / kDistance);
    const mesh = this.main.mesh;
    mesh.position.set(p[0] - kDistance * Math.sin(angle), p[1] - kBelow, p[2] - kDistance * Math.cos(angle));
    mesh.quaternion.setFromAxisAngle(new Vector3(0, 1, 0), angle);
    mesh.updateMatrixWorld(true);
  }

  dispose(): void {
    this.wrist.dispose();
    this.main.dispose();
  }

  /** On the left wrist; on the right one where there is no left. */
  private placeOnWrist(hands: readonly UserHand[]): void {
    const wearer = hands.find((h) => h.isTracked && h.handedness === "left") ?? null;
    this.wrist.mesh.visible = wearer !== null;
    if (wearer !== null) {
      const toRoom = new Matrix4().copy(this.room.matrixWorld).invert();
      this.wrist.mesh.matrix.copy(toRoom.multiply(wearer.wrist).multiply(kOnWrist));
      this.wrist.mesh.matrixWorldNeedsUpdate = true;
    }
  }

  private point(hands: readonly UserHand[]): void {
    this.pointed.clear();
    for (const hand of hands.filter((h) => h.isTracked)) {
      const hits = [this.wrist, this.main].flatMap((panel) => {
        const isOwn = panel === this.wrist && hand.handedness === "left";
        const hit = isOwn ? null : panel.hit(hand.pointer);
        return hit?.button == null ? [] : [{ panel, button: hit.button, distance: hit.distance }];
      });
      const nearest = hits.sort((a, b) => a.distance - b.distance)[0];
      if (nearest !== undefined) {
        this.pointed.set(hand, nearest);
      }
    }
  }

  private pointedOn(panel: Panel): string | null {
    return [...this.pointed.values()].find((at) => at.panel === panel)?.button ?? null;
  }

  private draw(live: LiveState | null): void {
    const { host } = this;
    const status = host.status();
    const lines = [status.alarm ?? status.hint].filter(Boolean);
    const forces = status.isForcesOff ? host.say("forcesOn") : host.say("forcesOff");
    const undo = status.canUndo ? [{ id: "undo", label: host.say("undo") }] : [];
    const stop = { id: "forces", label: forces, isBad: !status.isForcesOff };
    this.wrist.show(
      { title: status.title, lines: lines.slice(0, 1), bars: this.bars(live), buttons: [[...undo, stop]] },
      this.pointedOn(this.wrist),
    );
    this.main.show(
      {
        title: status.title,
        lines,
        bars: this.bars(live),
        buttons: [
          [
            { id: "seated", label: host.say("seated"), isOn: this.view.isSeated.value },
            { id: "before", label: host.say("before") },
            { id: "smaller", label: host.say("smaller") },
            { id: "larger", label: host.say("larger") },
          ],
          [
            { id: "left", label: host.say("left") },
            { id: "right", label: host.say("right") },
            { id: "next", label: host.say("next") },
            { id: "leave", label: host.say("leave") },
          ],
        ],
      },
      this.pointedOn(this.main),
    );
  }

  private bars(live: LiveState | null): PanelBar[] {
    const hand = live?.hands.find((h) => h.state > 0);
    const values = hand === undefined ? null : liveNumbers(hand);
    const { host } = this;
    const depth = values !== null && values.depthGoalMm > 0 ? values : null;
    return [
      {
        label: host.say("depth"),
        value: depth === null ? "–" : `${host.number(depth.depthMm, 1)} / ${host.number(depth.depthGoalMm, 0)} mm`,
        share: depth?.depthShare ?? 0,
        color: "#43d08a",
      },
      {
        label: host.say("force"),
        value: values === null ? "–" : `${host.number(values.feltN, 1)} N`,
        share: (values?.feltN ?? 0) / kForceFull,
        color: "#ff6b6b",
      },
    ];
  }

  private run(button: string): void {
    const own: Record<string, () => void> = {
      seated: () => {
        this.view.isSeated.value = !this.view.isSeated.value;
        this.placeAll();
      },
      before: () => this.placeAll(),
      larger: () => this.world.grow(1),
      smaller: () => this.world.grow(-1),
      left: () => this.world.turn(1),
      right: () => this.world.turn(-1),
    };
    const act = own[button];
    if (act !== undefined) {
      act();
    } else {
      this.host.run(button as VrAction);
    }
  }

  private placeAll(): void {
    this.world.placeBefore(this.view.isSeated.value ? "seated" : "standing");
    this.placeMain();
  }
}
