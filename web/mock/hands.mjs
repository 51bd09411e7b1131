// The hands of the toy and the devices that it pretends to find.

const MOUSE = {
  address: "pointer",
  name: "Mouse",
  model: "Simulated device of 7.9 N",
  serial: "",
  is_emulated: false,
  has_force: true,
  has_torque: true,
  max_force_n: 7.9,
  scale: 1,
  notes: [],
};
const FOUND = [
  {
    address: "emulated:openhaptics:touch_x",
    driver: "openhaptics",
    name: "Touch X",
    detail: "emulator",
    is_emulated: true,
    is_ready: true,
  },
  {
    address: "forcedimension:0",
    driver: "forcedimension",
    name: "omega.6",
    detail: "libdhd could not be loaded: install the SDK of Force Dimension and search again",
    is_emulated: false,
    is_ready: false,
  },
];

export class Hands {
  constructor(onChange) {
    this.onChange = onChange;
    this.devices = [MOUSE];
    this.isSearching = false;
  }

  list() {
    return this.devices.map((device, hand) => ({ hand, device, condition: "ready", lease: null }));
  }

  setCount(count) {
    this.devices = Array.from({ length: count }, (_, hand) => this.devices[hand] ?? MOUSE);
    this.tell();
  }

  use(hand, address, scale) {
    const found = FOUND.find((each) => each.address === address);
    this.devices[hand] =
      found === undefined
        ? MOUSE
        : {
            ...MOUSE,
            ...found,
            model: "Touch X, 6 DoF in, 3 DoF out",
            scale: scale || 1.6,
            notes: ["No torque: only the force of a contact is felt."],
          };
    this.tell();
  }

  tell() {
    this.onChange({ event: "hands", hands: this.list() });
  }

  search() {
    this.isSearching = true;
    setTimeout(() => {
      this.isSearching = false;
      this.onChange({ event: "devices", devices: FOUND, is_searching: false });
    }, 1500);
    return { devices: FOUND.slice(0, 1), is_searching: true };
  }
}

const EDGES_US = [10, 20, 30, 50, 70, 100, 150, 200, 300, 500, 700, 1000, 2000];

/** Counts of a second of ticks that mostly take `middle` microseconds. */
function counts(middle) {
  const at = (us) => 1000 * Math.exp(-Math.pow(Math.log(us / middle) / 0.35, 2));
  return [...EDGES_US, 4000].map((us) => Math.round(at(us)));
}

export function rates(hand) {
  return {
    histograms: { edges_us: EDGES_US, compute: counts(45), wake_up: counts(70) },
    hands: [0, 1].map((k) => ({
      hand: k,
      speed_m_s: 0,
      limit_n: 7.9,
      condition: "ready",
      force_n: k === 0 ? Math.hypot(...(hand?.f_felt_W_n ?? [0])) : 0,
      torque_nm: k === 0 ? Math.hypot(...(hand?.t_felt_W_nm ?? [0])) : 0,
      energy_j: 0.0021,
    })),
  };
}
