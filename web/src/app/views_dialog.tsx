/** Views under names: kept in this browser, of the product that is open. */

import { useSignal } from "@preact/signals";
import { decodeView, encodeView } from "../model/view_link";
import { store, ui, viewport } from "./app_state";
import { Dialog, DialogHead } from "./dialog";
import { t } from "./i18n";
import { Icon } from "./icons";

const close = () => (ui.overlay.value = null);

function show(link: string): void {
  const view = decodeView(link);
  if (view !== null) {
    viewport.value?.show(view);
  }
  close();
}

export default function ViewsDialog() {
  const product = store.scene.value?.name ?? "";
  const own = ui.savedViews.value.filter((each) => each.product === product);
  const name = useSignal(t("views.first", { n: own.length + 1 }));
  const keep = (event: Event) => {
    event.preventDefault();
    const shared = viewport.value?.sharedView();
    const wanted = name.value.trim();
    if (shared !== undefined && wanted !== "") {
      const others = ui.savedViews.value.filter((each) => each.product !== product || each.name !== wanted);
      ui.savedViews.value = [...others, { name: wanted, product, view: encodeView(shared) }];
      name.value = t("views.first", { n: own.length + 2 });
    }
  };
  const remove = (gone: string) => {
    ui.savedViews.value = ui.savedViews.value.filter((each) => each.product !== product || each.name !== gone);
  };
  return (
    <Dialog title={t("views.title")} kind="views" onClose={close}>
      <DialogHead title={t("views.title")} onClose={close} />
      <div class="dialog-body">
        {own.length === 0 ? <p class="quiet">{t("views.none")}</p> : null}
        <ul class="saved-views">
          {own.map((each) => (
            <li key={each.name}>
              <button type="button" class="small-button" onClick={() => show(each.view)}>
                {each.name}
              </button>
              <button
                type="button"
                class="eye-button"
                aria-label={t("views.remove", { name: each.name })}
                onClick={() => remove(each.name)}
              >
                <Icon name="close" size={14} />
              </button>
            </li>
          ))}
        </ul>
        <form class="fit-choice" onSubmit={keep}>
          <input
            value={name.value}
            aria-label={t("views.name")}
            data-testid="view-name"
            onInput={(event) => (name.value = event.currentTarget.value)}
          />
          <button type="submit" class="small-button is-main" data-testid="view-keep">
            {t("views.keep")}
          </button>
        </form>
      </div>
    </Dialog>
  );
}
