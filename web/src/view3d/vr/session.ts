/** Immersive VR: both hands take parts, lead them, turn and scale the world, and press panels. */

import { Box3, Color, HemisphereLight, Sphere, Vector3 } from "three";
import type { Studio } from "../../model/studio";
import type { Viewport } from "../viewport";
import type { Room, RoomHand, VrHost } from "./host";
import { UserHand } from "./user_hand";
import { VrHands } from "./vr_hands";
import { VrPanels } from "./vr_panels";
import { VrWorld } from "./vr_world";

const kBackground = 0x171c25;

class VrSession implements Room {
  private readonly hands: readonly UserHand[];
  private readonly world: VrWorld;
  private readonly parts: VrHands;
  private readonly panels: VrPanels;
  /** Those that took hold where nothing was: of the world itself. */
  private readonly pulling = new Set<UserHand>();
  private readonly light = new HemisphereLight(0xffffff, 0x6f7684, 0.6);
  private frames = 0;

  constructor(
    private readonly port: Viewport,
    studio: Studio,
    host: VrHost,
  ) {
    const { renderer, worldRoot, product } = port;
    const room = worldRoot.parent!;
    const { center, radius } = new Box3().setFromPoints(product.outline()).getBoundingSphere(new Sphere());
    this.world = new VrWorld(worldRoot, port.vrEyes, center.toArray(), radius);
    this.hands = [0, 1].map((index) => new UserHand(index, renderer.xr, room));
    this.parts = new VrHands(port, studio, worldRoot, this.hands);
    this.panels = new VrPanels(room, this.world, host, port.view);
    room.add(this.light);
    for (const hand of this.hands) {
      hand.onGrab = (kind) => this.grab(hand, kind !== "squeeze");
      hand.onRelease = () => {
        this.pulling.delete(hand);
        this.parts.release(hand);
      };
    }
  }

  /** Where a button of a panel is, in the room. */
  buttonAt(id: string): readonly number[] | null {
    for (const panel of [this.panels.main, this.panels.wrist]) {
      const at = panel.mesh.visible ? panel.find(id) : null;
      if (at !== null) {
        return panel.mesh.localToWorld(new Vector3(at.x, at.y, 0)).toArray();
      }
    }
    return null;
  }

  describeHands(): RoomHand[] {
    return this.hands.map((hand) => {
      const q = hand.orientation;
      return {
        p: hand.position.toArray(),
        q: [q.w, q.x, q.y, q.z],
        isTracked: hand.isTracked,
        isHolding: this.parts.isHolding(hand),
      };
    });
  }

  update(now: number): void {
    this.frames += 1;
    if (this.frames <= 2) {
      // The first picture tells where the head is.
      this.world.placeBefore(this.port.view.isSeated.peek() ? "seated" : "standing");
      this.panels.placeMain();
    }
    this.world.update(this.hands, [...this.pulling].filter((hand) => hand.isTracked));
    this.parts.update(now);
    this.panels.update(this.hands, this.port.live, now);
    this.hands.forEach((hand) => hand.draw(this.parts.isHolding(hand)));
  }

  dispose(): void {
    this.parts.releaseAll();
    this.hands.forEach((hand) => hand.dispose());
    this.panels.dispose();
    this.world.dispose();
    this.light.removeFromParent();
  }

  private grab(hand: UserHand, mayPress: boolean): void {
    if (mayPress && this.panels.press(hand)) {
      return;
    }
    if (!this.parts.grab(hand)) {
      this.pulling.add(hand);
    }
  }
}

/** Enters VR and stays until the session ends. Fails where there is no headset that knows its floor. */
export async function startVr(port: Viewport, studio: Studio, host: VrHost, onEnd: () => void): Promise<void> {
  const { renderer } = port;
  const session = await navigator.xr!.requestSession("immersive-vr", {
    requiredFeatures: ["local-floor"],
    optionalFeatures: ["hand-tracking"],
  });
  renderer.xr.enabled = true;
  renderer.xr.setReferenceSpaceType("local-floor");
  await renderer.xr.setSession(session);
  const vr = new VrSession(port, studio, host);
  port.enterRoom(new Color(kBackground), vr);
  session.addEventListener("end", () => {
    vr.dispose();
    renderer.xr.enabled = false;
    port.leaveRoom();
    onEnd();
  });
}
