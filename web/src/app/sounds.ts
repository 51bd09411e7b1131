/** What happens, to be heard: made by the page itself, after the first gesture of the user. */

import { effect } from "@preact/signals";
import type { HoldState } from "../protocol/messages";
import { store, view, viewport } from "./app_state";
import { holdingHand } from "./live";

const kVolume = 0.22;

class Sounds {
  private context: AudioContext | null = null;
  private noise: AudioBuffer | null = null;
  private wasTouching = false;
  private lastAxial = 0;
  private lastSlip = 0;

  wake(): void {
    this.context ??= new AudioContext();
    void this.context.resume();
  }

  onState(before: HoldState, now: HoldState): void {
    const order: HoldState[] = ["empty", "free", "near", "captured", "mating", "seated"];
    if (order.indexOf(now) <= order.indexOf(before)) {
      return;
    }
    if (view.hasOnlyEndSound.peek() && now !== "seated") {
      return;
    }
    if (now === "captured") {
      this.tone(660, 0.09, "sine", 0.7);
      this.tone(990, 0.12, "sine", 0.5, 0.06);
    } else if (now === "seated") {
      this.knock(180, 0.16, 1);
      this.tone(523, 0.2, "triangle", 0.6, 0.03);
      this.tone(784, 0.3, "triangle", 0.5, 0.1);
    } else if (now === "mating") {
      this.tone(440, 0.06, "triangle", 0.4);
    }
  }

  /** Contacts click as hard as they push; a fit that lets go and holds again creaks. */
  onFrame(contacts: number, newtons: number, axial: number, now: number): void {
    if (view.hasOnlyEndSound.peek()) {
      return;
    }
    const isTouching = contacts > 0 && newtons > 0.15;
    if (isTouching && !this.wasTouching) {
      this.knock(900, 0.05, Math.min(1, 0.15 + newtons / 12));
    }
    this.wasTouching = isTouching;
    const drop = this.lastAxial - axial;
    if (axial > 0.4 && drop > 0.12 * this.lastAxial && now - this.lastSlip > 45) {
      this.lastSlip = now;
      this.knock(2400, 0.025, Math.min(0.6, 0.1 + drop / 10));
    }
    this.lastAxial = axial;
  }

  private get isSilent(): boolean {
    return this.context === null || this.context.state !== "running" || view.isMuted.peek();
  }

  private tone(hz: number, seconds: number, type: OscillatorType, strength: number, after = 0): void {
    const context = this.context;
    if (context === null || this.isSilent) {
      return;
    }
    const start = context.currentTime + after;
    const source = new OscillatorNode(context, { type, frequency: hz });
    source.connect(this.envelope(strength, start, seconds));
    source.start(start);
    source.stop(start + seconds);
  }

  private knock(hz: number, seconds: number, strength: number): void {
    const context = this.context;
    if (context === null || this.isSilent) {
      return;
    }
    this.noise ??= makeNoise(context);
    const start = context.currentTime;
    const source = new AudioBufferSourceNode(context, { buffer: this.noise });
    const filter = new BiquadFilterNode(context, { type: "bandpass", frequency: hz, Q: 2.5 });
    source.connect(filter).connect(this.envelope(2.2 * strength, start, seconds));
    source.start(start, 0, seconds);
  }

  private envelope(strength: number, start: number, seconds: number): GainNode {
    const context = this.context!;
    const gain = new GainNode(context, { gain: 0 });
    gain.gain.setValueAtTime(0, start);
    gain.gain.linearRampToValueAtTime(kVolume * strength, start + 0.004);
    gain.gain.exponentialRampToValueAtTime(1e-4, start + seconds);
    gain.connect(context.destination);
    return gain;
  }
}

function makeNoise(context: AudioContext): AudioBuffer {
  const buffer = new AudioBuffer({ length: context.sampleRate / 2, sampleRate: context.sampleRate });
  const data = buffer.getChannelData(0);
  for (let k = 0; k < data.length; k++) {
    data[k] = 2 * Math.random() - 1;
  }
  return buffer;
}

export function startSounds(): void {
  const sounds = new Sounds();
  const wake = () => sounds.wake();
  addEventListener("pointerdown", wake, { once: true });
  addEventListener("keydown", wake, { once: true });
  let before: HoldState = "empty";
  effect(() => {
    const now = store.held.value[0]?.state ?? "empty";
    sounds.onState(before, now);
    before = now;
  });
  effect(() =>
    viewport.value?.onFrame((live, now) => {
      const hand = holdingHand(live);
      if (hand !== null) {
        sounds.onFrame(hand.contact_count, Math.hypot(...hand.f_felt_W_n), Math.abs(hand.axial_felt_n), now);
      }
    }),
  );
}
