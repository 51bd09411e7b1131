import { findAction, isEnabled, keyLabel, runAction } from "./actions";
import { Icon, type IconName } from "./icons";

export function ActionButton({ id, icon, label }: { id: string; icon: IconName; label?: string }) {
  const found = findAction(id);
  const name = found.label();
  const keys = found.keys?.[0];
  return (
    <button
      type="button"
      class={label === undefined ? "icon-button" : "text-button"}
      aria-label={label === undefined ? name : undefined}
      title={keys ? `${name} (${keyLabel(keys)})` : name}
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
