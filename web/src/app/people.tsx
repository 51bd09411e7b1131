/** The people in the studio: their names and colours, who leads what, and whose view is followed. */

import { effect } from "@preact/signals";
import { colourOf } from "../model/people";
import { endSharing } from "../model/session";
import type { Client } from "../protocol/messages";
import { store, studio, ui } from "./app_state";
import { t } from "./i18n";
import { Icon } from "./icons";

/** As others are told of a client: its user's name, or its number. */
export function clientName(id: string): string {
  const name = store.clients.value.find((client) => client.id === id)?.name;
  return name === undefined || name === "" ? t("people.guest", { n: id.slice(1) }) : name;
}

/** The name that the user has given goes to the server whenever the page has come in. */
export function introduceOneself(): void {
  effect(() => {
    const name = ui.userName.value;
    if (store.client.value !== "" && store.link.value === "open" && store.study.value === null && (name !== "" || ui.hasName.peek())) {
      ui.hasName.value = name !== "";
      void studio.tell({ command: "introduce", name });
    }
  });
}

function Dot({ id }: { id: string }) {
  return <i class="person-dot" style={{ background: colourOf(id) }} aria-hidden="true" />;
}

/** Those who are here besides this page, for the header. */
export function PeopleChip() {
  const others = store.clients.value.filter(({ id }) => id !== store.client.value);
  if (others.length === 0 || store.study.value !== null) {
    return null;
  }
  const names = others.map(({ id }) => clientName(id)).join(", ");
  return (
    <button
      type="button"
      class="chip people-chip"
      data-testid="people-chip"
      title={names}
      aria-label={t("people.chip", { n: others.length, names })}
      onClick={() => (ui.overlay.value = { kind: "share" })}
    >
      {others.slice(0, 4).map(({ id }) => (
        <Dot key={id} id={id} />
      ))}
      <span>{others.length + 1}</span>
    </button>
  );
}

function roleText(client: Client): string {
  const hands = (client.hands ?? []).filter((hand) => hand < Math.max(1, store.hands.value.length));
  const led = hands.map((hand) => t("hands.name", { n: hand + 1 })).join(", ");
  return client.has_lease ? t("people.steers", { hands: led }) : led !== "" ? t("people.helps", { hands: led }) : t("people.looks");
}

function Person({ client }: { client: Client }) {
  const isSelf = client.id === store.client.value;
  const isFollowed = store.followed.value === client.id;
  return (
    <li class="person" data-testid={`person-${client.id}`}>
      <Dot id={client.id} />
      <strong>{isSelf ? t("people.self", { name: clientName(client.id) }) : clientName(client.id)}</strong>
      <span class="quiet">{roleText(client)}</span>
      <span class="spacer" />
      {isSelf || !store.looking.value.has(client.id) ? null : (
        <button
          type="button"
          class="small-button"
          aria-pressed={isFollowed}
          data-testid={`follow-${client.id}`}
          onClick={() => (store.followed.value = isFollowed ? null : client.id)}
        >
          {t(isFollowed ? "people.unfollow" : "people.follow")}
        </button>
      )}
    </li>
  );
}

async function end(): Promise<void> {
  const error = await endSharing();
  studio.notify(error === null ? t("people.ended") : [error.message, error.remedy].filter(Boolean).join(": "), error !== null);
}

/** Who is here, what one is called oneself, and the end of it. */
export function PeopleList() {
  const clients = store.clients.value;
  const hasGuests = clients.length > 1;
  return (
    <section aria-labelledby="people-title" class="people">
      <h3 id="people-title">{t("people.title")}</h3>
      <label class="people-name">
        <span>{t("people.ownName")}</span>
        <input
          type="text"
          maxLength={40}
          value={ui.userName.value}
          placeholder={t("people.namePlaceholder")}
          data-testid="own-name"
          onChange={(event) => (ui.userName.value = event.currentTarget.value.trim())}
        />
      </label>
      <ul>
        {clients.map((client) => (
          <Person key={client.id} client={client} />
        ))}
      </ul>
      {hasGuests && store.hasLease.value ? (
        <button type="button" class="small-button" data-testid="end-sharing" onClick={() => void end()}>
          <Icon name="stop" size={14} /> {t("people.end")}
        </button>
      ) : null}
    </section>
  );
}

/** While the view of somebody else is followed. */
export function FollowedBanner() {
  const { followed } = store;
  return followed.value === null ? null : (
    <div class="banner is-info" role="status" data-testid="followed">
      <Dot id={followed.value} />
      <span>{t("people.followed", { name: clientName(followed.value) })}</span>
      <button type="button" class="banner-button" onClick={() => (followed.value = null)}>
        {t("people.unfollow")}
      </button>
    </div>
  );
}
