import { findAction } from "./actions";
import { ActionButton } from "./action_button";
import { t } from "./i18n";
import type { IconName } from "./icons";

const kTools: readonly (readonly [string, IconName])[][] = [
  [["tool-hand", "hand"], ["tool-select", "cursor"]],
  [["mode-part", "cube"], ["mode-subassembly", "cubes"], ["mode-face", "face"]],
  [["section", "section"], ["explode", "explode"], ["tool-measure", "measure"], ["tool-mate", "mate"]],
  [["isolate", "isolate"], ["ghost", "ghost"], ["fit", "fit"]],
];

export function ToolRail() {
  return (
    <div class="tool-rail" role="toolbar" aria-label={t("tools.label")} aria-orientation="vertical">
      {kTools.map((group, k) => (
        <div class="tool-group" key={k}>
          {group.map(([id, icon]) => (
            <ActionButton key={findAction(id).id} id={id} icon={icon} />
          ))}
        </div>
      ))}
    </div>
  );
}
