/** The rim between the view and a panel: dragged, or moved by the arrow keys; a double click lets it be. */

import { useRef } from "preact/hooks";
import { ui } from "./app_state";
import { t } from "./i18n";

export type SplitName = keyof typeof ui.sizes;

interface Split {
  /** The panel as it is when nobody has dragged its rim; and how far it goes [px]. */
  usual: () => number;
  least: number;
  most: number;
  isUpright: boolean;
  /** Of the pointer's way: makes the panel larger. */
  sign: 1 | -1;
}

export const kSplits: Record<SplitName, Split> = {
  model: { usual: () => 264, least: 180, most: 480, isUpright: true, sign: 1 },
  inspector: { usual: () => 286, least: 220, most: 520, isUpright: true, sign: -1 },
  plots: {
    usual: () => Math.min(190, Math.max(128, 0.18 * innerHeight)),
    least: 96,
    most: 460,
    isUpright: false,
    sign: -1,
  },
};
const kStep = 16;

/** As a length of the style; nothing where nobody has dragged it. */
export function sizeOf(name: SplitName): string | undefined {
  const size = ui.sizes[name].value;
  return size > 0 ? `${clamp(name, size)}px` : undefined;
}

function clamp(name: SplitName, size: number): number {
  return Math.min(kSplits[name].most, Math.max(kSplits[name].least, Math.round(size)));
}

export function Splitter({ name }: { name: SplitName }) {
  const split = kSplits[name];
  const size = ui.sizes[name];
  const start = useRef<{ at: number; size: number } | null>(null);
  const now = size.value > 0 ? clamp(name, size.value) : Math.round(split.usual());
  const set = (wanted: number) => (size.value = clamp(name, wanted));
  const place = (event: PointerEvent) => (split.isUpright ? event.clientX : event.clientY);
  const onKeyDown = (event: KeyboardEvent) => {
    const [less, more] = split.isUpright ? ["ArrowLeft", "ArrowRight"] : ["ArrowUp", "ArrowDown"];
    const moves: Record<string, number> = {
      [less]: now - split.sign * kStep,
      [more]: now + split.sign * kStep,
      Home: split.least,
      End: split.most,
    };
    const to = moves[event.key];
    if (to !== undefined) {
      event.preventDefault();
      event.stopPropagation();
      set(to);
    }
  };
  return (
    <div
      class={`splitter is-${name}`}
      role="separator"
      tabIndex={0}
      aria-orientation={split.isUpright ? "vertical" : "horizontal"}
      aria-label={t(`split.${name}`)}
      aria-valuenow={now}
      aria-valuemin={split.least}
      aria-valuemax={split.most}
      title={t("split.help")}
      data-testid={`split-${name}`}
      onKeyDown={onKeyDown}
      onDblClick={() => (size.value = 0)}
      onPointerDown={(event) => {
        start.current = { at: place(event), size: now };
        event.currentTarget.setPointerCapture(event.pointerId);
      }}
      onPointerMove={(event) => {
        if (start.current !== null) {
          set(start.current.size + split.sign * (place(event) - start.current.at));
        }
      }}
      onPointerUp={() => (start.current = null)}
      onPointerCancel={() => (start.current = null)}
    />
  );
}
