/** What a test that drives the page from outside may look at or wait for; nothing here changes anything. */

import { nowMs } from "../protocol/frame_store";
import type { RoomHand } from "../view3d/vr/host";
import { leadsHand, store, studio, ui, view, viewport } from "./app_state";

/** Of the session, from one frame to the next (`LiveRun`). */
const kFrameMs = 1000 / 60;

interface Seen {
  x: number;
  y: number;
  isVisible: boolean;
}

export interface StudioHooks {
  readonly framesDrawn: number;
  state(): unknown;
  /** How far the session has gone on while this page got its frames, at least [ms]: what a slow machine leaves out does
   not count, however long it took. */
  readonly sessionMs: number;
  /** Until the server has answered, and with it all that this page has sent before. */
  hasAnswered(): Promise<void>;
  /** As it is drawn: position [m] and quaternion w, x, y, z in W. */
  pose(occurrence: number): unknown;
  /** Of the middle of a part, or of what of it no other part and no panel covers: client pixels. */
  screen(occurrence: number): Seen | null;
  /** A client pixel at which one sees this face of a part and can click it, or null. */
  screenOfFace(occurrence: number, face: number): Seen | null;
  /** For somebody in VR, in the room [m], Y up, the floor at 0: where the middle of a part is, how W stands
   there, where a button of a panel is, and both hands. */
  room: {
    part(occurrence: number): readonly number[] | null;
    world(): { p: readonly number[]; q: readonly number[]; scale: number };
    button(id: string): readonly number[] | null;
    hands(): readonly RoomHand[];
  };
  /** What it costs the page to take new poses of all parts, each time [ms]; without drawing them. */
  timePoses(times: number): readonly number[];
  /** How long so many pictures take, each until one of its pixels has been read [ms]. */
  timePictures(times: number): readonly number[];
  /** Of a point of W [m]: client pixels. */
  project(p: readonly [number, number, number]): { x: number; y: number };
}

declare global {
  interface Window {
    hvas?: StudioHooks;
  }
}

function toClient(at: { x: number; y: number }): { x: number; y: number } {
  const box = viewport.value!.canvas.getBoundingClientRect();
  return { x: box.left + at.x, y: box.top + at.y };
}

/** No panel lies over the picture there. */
function isOnPicture({ x, y }: { x: number; y: number }): boolean {
  return document.elementFromPoint(x, y) === viewport.value!.canvas;
}

function world(): { p: number[]; q: number[]; scale: number } {
  const { position, quaternion: q, scale } = viewport.value!.worldRoot;
  return { p: position.toArray(), q: [q.w, q.x, q.y, q.z], scale: scale.x };
}

function partInRoom(occurrence: number): number[] | null {
  const port = viewport.value;
  const matrix = port?.product.parts?.matrixOf(occurrence);
  const shape = port?.product.parts?.shapeOf(occurrence);
  if (!port || !matrix || !shape) {
    return null;
  }
  return shape.sphere.center.clone().applyMatrix4(matrix).applyMatrix4(port.worldRoot.matrixWorld).toArray();
}

/** A pixel at which the part is what one sees: its middle, or else one around it. */
function screen(occurrence: number): Seen | null {
  const port = viewport.value;
  const matrix = port?.product.parts?.matrixOf(occurrence);
  const shape = port?.product.parts?.shapeOf(occurrence);
  if (!port || !matrix || !shape) {
    return null;
  }
  const middle = shape.box.getCenter(shape.box.min.clone()).applyMatrix4(matrix);
  const at = port.project([middle.x, middle.y, middle.z]);
  const reach = shape.sphere.radius / port.eye.metresPerPixel([middle.x, middle.y, middle.z]);
  for (const share of [0, 0.25, 0.45, 0.65, 0.85]) {
    for (let k = 0; k < (share === 0 ? 1 : 16); k++) {
      const angle = (k * Math.PI) / 8;
      const probe = { x: at.x + share * reach * Math.cos(angle), y: at.y + share * reach * Math.sin(angle) };
      const seen = toClient(probe);
      const isFree = isOnPicture(seen) && port.pickCube(probe.x, probe.y) === null;
      if (isFree && port.product.pick(port.rayAt(probe.x, probe.y))?.occurrence === occurrence) {
        return { ...seen, isVisible: true };
      }
    }
  }
  return { ...toClient(at), isVisible: false };
}

/** Of the triangles of the face, the first whose middle nothing hides. */
function screenOfFace(occurrence: number, face: number): Seen | null {
  const port = viewport.value;
  const matrix = port?.product.parts?.matrixOf(occurrence);
  const shape = port?.product.parts?.shapeOf(occurrence);
  if (!port || !matrix || !shape) {
    return null;
  }
  const corners = shape.faceGeometry(face).getAttribute("position").array;
  const middle = shape.box.min.clone();
  const corner = middle.clone();
  for (let k = 0; k < corners.length; k += 9) {
    middle.set(0, 0, 0);
    for (let c = 0; c < 9; c += 3) {
      middle.addScaledVector(corner.fromArray(corners, k + c), 1 / 3);
    }
    const at = port.project(middle.applyMatrix4(matrix).toArray());
    const seen = toClient(at);
    const hit = isOnPicture(seen) ? port.product.pick(port.rayAt(at.x, at.y)) : null;
    if (hit?.occurrence === occurrence && hit.face === face) {
      return { ...seen, isVisible: true };
    }
  }
  return null;
}

function timePoses(times: number): number[] {
  const port = viewport.value!;
  const frames = studio.liveFrames;
  return Array.from({ length: times }, () => {
    const live = frames?.read() ?? null;
    port.product.forgetPoses();
    const start = performance.now();
    port.product.update(frames, live, nowMs());
    return performance.now() - start;
  });
}

function timePictures(times: number): number[] {
  const port = viewport.value!;
  const gl = port.renderer.getContext();
  const pixel = new Uint8Array(4);
  return Array.from({ length: times }, () => {
    const start = performance.now();
    port.draw();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    return performance.now() - start;
  });
}

function playbackState(): unknown {
  const playback = studio.recordings.playback.value;
  return playback === null
    ? null
    : {
        id: playback.run.detail.id,
        timeS: playback.timeS,
        durationS: playback.durationS,
        isPlaying: playback.isPlaying.value,
        marks: playback.marks.map(({ kind, timeS }) => ({ kind, timeS })),
      };
}

export function exposeHooks(): void {
  window.hvas = {
    get framesDrawn() {
      return viewport.value?.framesDrawn ?? 0;
    },
    get sessionMs() {
      return (studio.liveFrames?.messagesReceived ?? 0) * kFrameMs;
    },
    hasAnswered: async () => void (await studio.command({ command: "status" })),
    state: () => ({
      link: store.link.value,
      isSilent: store.isSilent.value,
      role: store.role.value,
      hasLease: store.hasLease.value,
      leadsHand: leadsHand(),
      hasScene: viewport.value?.product.parts != null && viewport.value.product.scene === store.scene.value,
      epoch: store.scene.value?.epoch ?? null,
      step: store.step.value,
      held: store.held.value,
      hands: viewport.value?.live?.hands ?? [],
      contacts: viewport.value?.live?.contacts.length ?? 0,
      ageMs: viewport.value?.live?.ageMs ?? null,
      framesPerSecond: viewport.value?.meter.framesPerSecond ?? 0,
      isShared: studio.liveFrames !== null && !(studio.liveFrames.buffer instanceof ArrayBuffer),
      messages: studio.liveFrames?.messagesReceived ?? 0,
      playback: playbackState(),
      recording: store.recording.value?.id ?? null,
      plotSpan: ui.plotSpan.value,
      placements: Object.fromEntries(store.placements.value),
      leaders: Object.fromEntries(store.leaders.value),
      forcesOff: store.forcesOff.value,
      safety: store.safety.value,
      demo: store.demo.value,
      clients: store.clients.value.length,
      eye: viewport.value?.rig.pose().eye ?? null,
      isInVr: ui.isInVr.value,
      selected: view.selected.value,
      hidden: [...view.hidden.value],
      measurement: view.measurement.value,
      isCaught: viewport.value?.hand.mouse.isCaught ?? false,
    }),
    pose: (occurrence) => viewport.value?.product.poseOf(occurrence) ?? null,
    screen,
    screenOfFace,
    timePoses,
    timePictures,
    room: {
      part: partInRoom,
      world,
      button: (id) => viewport.value?.room?.buttonAt(id) ?? null,
      hands: () => viewport.value?.room?.describeHands() ?? [],
    },
    project: (p) => toClient(viewport.value!.project(p)),
  };
}
