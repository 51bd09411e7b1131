/** A link for somebody else: to look on, or to help; with the view that is shown, as text and as a QR code. */

import { useSignal, type Signal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import encodeQR from "qr";
import { invite, type Invitation } from "../model/session";
import { withToken } from "../model/view_link";
import type { Role } from "../protocol/messages";
import { store, studio, ui } from "./app_state";
import { Dialog, DialogHead } from "./dialog";
import { shownFragment } from "./exports";
import { t } from "./i18n";
import { Icon } from "./icons";
import { PeopleList } from "./people";

const close = () => (ui.overlay.value = null);

type Guest = "viewer" | "operator";

/** Light around it, as wide as the standard asks for [modules]. */
const kQuiet = 4;

/** Dark on light in every theme: cameras read no other. */
function QrCode({ text }: { text: string }) {
  const { size, path } = useMemo(() => {
    const rows = encodeQR(text, "raw", { ecc: "medium", border: kQuiet });
    const dark = rows.flatMap((row, y) => row.flatMap((isDark, x) => (isDark ? [`M${x} ${y}h1v1h-1z`] : [])));
    return { size: rows.length, path: dark.join("") };
  }, [text]);
  return (
    <svg class="qr-code" viewBox={`0 0 ${size} ${size}`} role="img" aria-label={t("share.qr")} data-testid="share-qr" shape-rendering="crispEdges">
      <rect width={size} height={size} fill="#fff" />
      <path d={path} fill="#000" />
    </svg>
  );
}

async function copy(text: string): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
    studio.notify(t("notice.copied"));
  } catch {
    studio.notify(t("notice.copyFailed"), true);
  }
}

/** Made when it is asked for: one that lets somebody steer is for one browser. */
function useInvitation(guest: Signal<Guest>): { link: Invitation | null; isDone: boolean; again: () => void } {
  const made = useSignal<ReadonlyMap<Role, Invitation | null>>(new Map());
  const make = async (role: Role) => {
    const link = await invite(role);
    made.value = new Map(made.peek()).set(role, link);
  };
  useEffect(() => {
    if (store.role.peek() !== "operator") {
      made.value = new Map<Role, null>([["viewer", null]]);
    } else if (!made.peek().has(guest.value)) {
      void make(guest.value);
    }
  }, [guest.value]);
  return {
    link: made.value.get(guest.value) ?? null,
    isDone: made.value.has(guest.value),
    again: () => void make(guest.value),
  };
}

function Guests({ guest }: { guest: Signal<Guest> }) {
  const possible: readonly Guest[] = store.isOwner.value ? ["viewer", "operator"] : ["viewer"];
  return (
    <div class="segments is-text" role="radiogroup" aria-label={t("share.who")}>
      {possible.map((each) => (
        <button
          key={each}
          type="button"
          role="radio"
          aria-checked={guest.value === each}
          data-testid={`share-${each}`}
          onClick={() => (guest.value = each)}
        >
          {t(each === "viewer" ? "share.viewer" : "share.operator")}
        </button>
      ))}
    </div>
  );
}

function Address({ link, origin }: { link: Invitation; origin: Signal<string> }) {
  return link.origins.length < 2 ? null : (
    <label class="share-address">
      <span>{t("share.address")}</span>
      <select value={origin.value} data-testid="share-origin" onChange={(event) => (origin.value = event.currentTarget.value)}>
        {link.origins.map((each) => (
          <option key={each} value={each}>
            {each}
          </option>
        ))}
      </select>
    </label>
  );
}

/** Nobody is to scan a code that leads nowhere. */
function LocalOnly({ link }: { link: Invitation }) {
  return (
    <div class="note share-local" role="note" data-testid="share-local">
      <p>
        <Icon name="warn" size={14} /> {t("share.local")}
      </p>
      <p>
        {t("share.listen")} <code>hvas studio --listen {link.reachable[0] ?? "0.0.0.0"}</code>
      </p>
    </div>
  );
}

export default function ShareDialog() {
  const guest = useSignal<Guest>("viewer");
  const origin = useSignal("");
  const fragment = useMemo(shownFragment, []);
  const { link, isDone, again } = useInvitation(guest);
  const base = link?.origins.includes(origin.value) === true ? origin.value : (link?.origins[0] ?? location.origin);
  const hash = link === null ? fragment : withToken(link.token, fragment);
  const address = `${base}/${hash === "" ? "" : `#${hash}`}`;
  return (
    <Dialog title={t("share.title")} kind="share" onClose={close}>
      <DialogHead title={t("share.title")} onClose={close} />
      <div class="dialog-body share-body">
        <PeopleList />
        {store.role.value === "operator" ? <Guests guest={guest} /> : null}
        {isDone ? (
          <>
            <p>{t(link === null ? "share.inOnly" : guest.value === "viewer" ? "share.viewerMeans" : "share.operatorMeans")}</p>
            {link?.is_local === true ? <LocalOnly link={link} /> : null}
            {link === null ? null : <Address link={link} origin={origin} />}
            <div class="share-link">
              <input readOnly value={address} aria-label={t("share.link")} data-testid="share-link" onFocus={(event) => event.currentTarget.select()} />
              <button type="button" class="small-button is-main" data-testid="share-copy" onClick={() => void copy(address)}>
                {t("share.copy")}
              </button>
            </div>
            {link?.is_for_one === true ? (
              <button type="button" class="small-button" data-testid="share-again" onClick={again}>
                {t("share.again")}
              </button>
            ) : null}
            {link === null || link.is_local ? null : <QrCode text={address} />}
          </>
        ) : (
          <p class="quiet">{t("lazy.loading")}</p>
        )}
      </div>
    </Dialog>
  );
}
