/** What stands on the bench: put there, put away, moved by the arrow keys. */

import { kBenchKinds, type BenchItem, type BenchKind } from "../model/bench";
import { view, viewport } from "./app_state";
import { t } from "./i18n";
import { Icon } from "./icons";

const kStep = 0.01;
const kTurn = Math.PI / 12;

function moved(item: BenchItem, key: string): BenchItem | null {
  switch (key) {
    case "ArrowLeft":
      return { ...item, x: item.x - kStep };
    case "ArrowRight":
      return { ...item, x: item.x + kStep };
    case "ArrowUp":
      return { ...item, y: item.y + kStep };
    case "ArrowDown":
      return { ...item, y: item.y - kStep };
    case "q":
      return { ...item, turn: item.turn + kTurn };
    case "e":
      return { ...item, turn: item.turn - kTurn };
    default:
      return null;
  }
}

export function WorkshopPanel() {
  const host = viewport.value?.workshop;
  if (!view.editsBench.value || !view.showsWorkshop.value || host === undefined) {
    return null;
  }
  const items = host.items;
  const onKeyDown = (kind: BenchKind) => (event: KeyboardEvent) => {
    const item = items.find((each) => each.kind === kind);
    if (item !== undefined && moved(item, event.key) !== null) {
      event.preventDefault();
      event.stopPropagation();
      host.change(kind, (each) => moved(each, event.key) ?? each);
    }
  };
  return (
    <div class="float-panel bench-panel" role="group" aria-label={t("bench.title")} data-testid="bench-panel">
      <Icon name="hammer" />
      {kBenchKinds.map((kind) => (
        <button
          key={kind}
          type="button"
          class="chip-button"
          aria-pressed={items.some((item) => item.kind === kind)}
          title={t("bench.help")}
          data-testid={`bench-${kind}`}
          onClick={() => host.toggle(kind)}
          onKeyDown={onKeyDown(kind)}
        >
          {t(`bench.${kind}`)}
        </button>
      ))}
      <button type="button" class="small-button" onClick={() => (view.benchItems.value = null)}>
        {t("bench.reset")}
      </button>
      <button type="button" class="icon-button" aria-label={t("dialog.close")} onClick={() => (view.editsBench.value = false)}>
        <Icon name="close" />
      </button>
    </div>
  );
}
