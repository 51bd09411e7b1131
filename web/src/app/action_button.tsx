import { findAction, isEnabled, runAction } from "./actions";
import { Icon, type IconName } from "./icons";
import { shownKey } from "./key";

export function ActionButton({ id, icon, label }: { id: string; icon: IconName; label?: string }) {
  const found = findAction(id);
  const name = found.label();
  const keys = shownKey(found);
  return (
    <button
      type="button"
      class={label === undefined ? "icon-button" : "text-button"}
      aria-label={label === undefined ? name : undefined}
      title={keys === null ? name : `${name} (${keys})`}
      aria-pressed={found.isOn?.()}
      disabled={!isEnabled(found)}
      data-testid={`button-${id}`}
      onClick={() => runAction(found)}
    >
      <Icon name={icon} />
      {label === undefined ? null : <span>{label}</span>}
    </button>
  );
}
