/** The order of assembly: orders that the program has found, one that the user drags, and what fails in it. */

import { type Signal, useSignal } from "@preact/signals";
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";
import { movesOf, placeAt, withMoved } from "../model/order";
import type { Order, OrderedMove } from "../protocol/messages";
import { canSteer, store, studio } from "./app_state";
import { number, t, tn } from "./i18n";
import { Icon } from "./icons";

const kNameLimit = 3; // Names in one sentence; the others are counted.

function nameOf(id: number): string {
  return store.occurrences.value.get(id)?.name ?? `o${id}`;
}

function namesOf(ids: readonly number[]): string {
  const names = ids.slice(0, kNameLimit).map(nameOf).join(", ");
  return ids.length > kNameLimit ? t("order.andMore", { names, n: ids.length - kNameLimit }) : names;
}

/** What has to be known of a move: what stops it, or what makes it hard. */
function remarksOn(move: OrderedMove): string[] {
  if (move.blocked_by.length > 0) {
    return [t("order.blocked", { names: namesOf(move.blocked_by) })];
  }
  const remarks = [];
  if (move.in_tool_space.length > 0) {
    remarks.push(t("order.cramped", { names: namesOf(move.in_tool_space) }));
  }
  if (move.holds !== null && move.holds.length > 0) {
    remarks.push(t("order.holds", { names: namesOf(move.holds) }));
  }
  return remarks;
}

function summaryOf(order: Order): string {
  if (!order.is_possible) {
    return tn("order.fails", order.moves.filter((move) => move.blocked_by.length > 0).length);
  }
  return t("order.costs", {
    cost: number(order.cost ?? 0),
    turns: order.turns ?? 0,
    directions: order.direction_changes ?? 0,
    tools: order.tool_changes ?? 0,
    reach: number(order.reach_m ?? 0, 2),
    force: number(order.force_n ?? 0, 0),
    time: number(order.hand_time_s ?? 0, 0),
  });
}

interface Dragged {
  from: number;
  to: number;
}

interface RowProps {
  move: OrderedMove;
  place: number;
  count: number;
  dragged: Signal<Dragged | null>;
  onMove: (from: number, to: number) => void;
}

function Row({ move, place, count, dragged, onMove }: RowProps) {
  const middles = (row: Element | null) =>
    [...(row?.parentElement?.children ?? [])].map((one) => {
      const box = one.getBoundingClientRect();
      return 0.5 * (box.top + box.bottom);
    });
  const rowOf = (event: PointerEvent) => (event.currentTarget as Element).closest("li");
  const onKeyDown = (event: KeyboardEvent) => {
    const to = event.key === "ArrowUp" ? place - 1 : event.key === "ArrowDown" ? place + 1 : null;
    if (to !== null) {
      event.preventDefault(); // The arrow keys move nothing else meanwhile.
      event.stopPropagation();
      if (to >= 0 && to < count) {
        onMove(place, to);
      }
    }
  };
  const drag = dragged.value;
  const name = nameOf(move.occurrence);
  const isTarget = drag !== null && drag.to === place && drag.from !== place;
  const marks = [
    move.blocked_by.length > 0 ? "is-bad" : "",
    drag?.from === place ? "is-dragged" : "",
    isTarget ? (drag.to < drag.from ? "is-before" : "is-behind") : "",
  ];
  return (
    <li class={marks.filter(Boolean).join(" ")} data-testid={`order-row-${place}`}>
      <button
        type="button"
        class="order-handle"
        data-testid={`order-handle-${place}`}
        aria-label={t("order.move", { name })}
        title={t("order.move", { name })}
        onKeyDown={onKeyDown}
        onPointerDown={(event) => {
          (event.currentTarget as Element).setPointerCapture(event.pointerId);
          dragged.value = { from: place, to: place };
        }}
        onPointerMove={(event) => {
          if (dragged.value?.from === place) {
            dragged.value = { from: place, to: placeAt(middles(rowOf(event)), place, event.clientY) };
          }
        }}
        onPointerUp={() => {
          const { from, to } = dragged.value ?? { from: place, to: place };
          dragged.value = null;
          if (from !== to) {
            onMove(from, to);
          }
        }}
        onPointerCancel={() => (dragged.value = null)}
      >
        <Icon name="menu" size={14} />
      </button>
      <div>
        <span>
          {place + 1}. {move.members.length > 0 ? t("steps.insertMany", { name, n: move.members.length }) : name}
        </span>
        {remarksOn(move).map((remark) => (
          <p key={remark} class="quiet">
            {remark}
          </p>
        ))}
      </div>
    </li>
  );
}

export function OrderPanel({ close }: { close: () => void }) {
  const steps = store.scene.value?.steps ?? [];
  const order = useSignal<readonly OrderedMove[]>(movesOf(steps));
  const known = useSignal<Order | null>(null);
  const found = useSignal<readonly Order[]>([]);
  const chosen = useSignal("");
  const isBusy = useSignal(false);
  const dragged = useSignal<Dragged | null>(null);
  const asked = useRef(0);
  const focused = useRef<number | null>(null);
  const list = useRef<HTMLOListElement>(null);

  const show = (shown: Order) => {
    known.value = shown;
    order.value = shown.moves;
  };
  const ask = async <T,>(work: () => Promise<T | null>, use: (answer: T) => void) => {
    asked.current += 1;
    const turn = asked.current;
    isBusy.value = true;
    store.orderProgress.value = null;
    const answer = await work();
    if (turn === asked.current) {
      isBusy.value = false;
      if (answer !== null) {
        use(answer);
      }
    }
  };
  const check = (moves: readonly OrderedMove[]) =>
    ask(() => studio.command({ command: "check_order", occurrences: moves.map((move) => move.occurrence) }), show);
  const move = (from: number, to: number) => {
    order.value = withMoved(order.value, from, to);
    known.value = null;
    chosen.value = "";
    focused.current = to;
    void check(order.value);
  };
  const find = () =>
    ask(
      () => studio.command({ command: "find_orders" }),
      ({ orders }) => {
        found.value = orders;
        if (orders[0] !== undefined) {
          chosen.value = "0";
          show(orders[0]);
        }
      },
    );
  useEffect(() => void check(order.value), []);
  useLayoutEffect(() => {
    if (focused.current !== null) {
      list.current?.children[focused.current]?.querySelector("button")?.focus();
      focused.current = null;
    }
  }, [order.value]);

  const isOff = isBusy.value || store.demo.value || !canSteer();
  const progress = store.orderProgress.value;
  const use = async () => {
    await studio.command({ command: "set_order", occurrences: order.value.map((one) => one.occurrence) });
    close();
  };
  return (
    <section class="card-group" aria-labelledby="order-title" data-testid="order-panel">
      <h2 id="order-title">{t("order.title")}</h2>
      <p class="quiet">{t("order.help")}</p>
      {found.value.length > 0 ? (
        <select
          class="mate-choice"
          aria-label={t("order.found")}
          data-testid="order-choice"
          value={chosen.value}
          onChange={(event) => {
            chosen.value = event.currentTarget.value;
            const picked = found.value[Number(chosen.value)];
            if (chosen.value !== "" && picked !== undefined) {
              show(picked);
            }
          }}
        >
          <option value="">{t("order.own")}</option>
          {found.value.map((one, k) => (
            <option key={k} value={String(k)}>
              {t("order.foundOne", { n: k + 1, cost: number(one.cost ?? 0) })}
            </option>
          ))}
        </select>
      ) : null}
      <ol class="order" ref={list}>
        {order.value.map((one, k) => (
          <Row key={one.occurrence} move={one} place={k} count={order.value.length} dragged={dragged} onMove={move} />
        ))}
      </ol>
      <p role="status" data-testid="order-summary" class={known.value?.is_possible === false ? "order-fails" : ""}>
        {isBusy.value
          ? t("order.busy", { percent: number(100 * (progress?.fraction ?? 0), 0) })
          : known.value !== null
            ? summaryOf(known.value)
            : ""}
      </p>
      <p class="card-buttons">
        <button type="button" class="small-button" data-testid="order-find" disabled={isOff} onClick={() => void find()}>
          {t("order.find")}
        </button>
        <button
          type="button"
          class="small-button is-main"
          data-testid="order-use"
          disabled={isOff || known.value?.is_possible !== true}
          onClick={() => void use()}
        >
          {t("order.use")}
        </button>
        <button type="button" class="small-button" data-testid="order-cancel" onClick={close}>
          {t("order.cancel")}
        </button>
      </p>
    </section>
  );
}
