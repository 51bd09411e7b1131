/** A field for a number with its unit: "38 mm", "1.5 in". */

import { useSignal } from "@preact/signals";
import { inUsualUnit, parseQuantity, usualUnit, type QuantityKind } from "../model/quantity";
import { number, t } from "./i18n";

export interface QuantityEntryProps {
  kind: QuantityKind;
  label: string;
  /** In SI. */
  value: number;
  digits: number;
  testId: string;
  onChange: (value: number) => void;
}

export function QuantityEntry({ kind, label, value, digits, testId, onChange }: QuantityEntryProps) {
  /** What is being typed; null: nothing. */
  const typed = useSignal<string | null>(null);
  const shown = `${number(inUsualUnit(value, kind), digits)} ${usualUnit(kind)}`;
  const read = typed.value === null ? value : parseQuantity(typed.value, kind);
  const commit = () => {
    if (read !== null) {
      if (typed.value !== null) {
        onChange(read);
      }
      typed.value = null;
    }
  };
  return (
    <input
      class="quantity"
      inputMode="text"
      value={typed.value ?? shown}
      aria-label={label}
      aria-invalid={read === null}
      title={t(kind === "length" ? "quantity.length" : "quantity.angle")}
      data-testid={testId}
      onFocus={(event) => event.currentTarget.select()}
      onInput={(event) => (typed.value = event.currentTarget.value)}
      onBlur={() => {
        commit();
        typed.value = null;
      }}
      onKeyDown={(event) => {
        if (event.key === "Enter") {
          commit();
        } else if (event.key === "Escape" && typed.value !== null) {
          event.stopPropagation();
          typed.value = null;
        }
      }}
    />
  );
}
