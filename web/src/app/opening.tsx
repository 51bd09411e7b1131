/** Before there is a product: the empty screen, and what is being opened. */

import { canSteer, store, studio } from "./app_state";
import { denialText } from "./banners";
import { chooseFile } from "./exports";
import { number, t } from "./i18n";
import type { MessageKey } from "./en";
import { en } from "./en";
import type { Example } from "../protocol/messages";
import { Icon } from "./icons";
import { StartDemo, StartDevices } from "./start_page";

function stageName(stage: string): string {
  const key = `load.${stage.toLowerCase()}`;
  return key in en ? t(key as MessageKey) : stage;
}

export function EmptyState() {
  const link = store.link.value;
  if (link === "denied") {
    return (
      <div class="empty" role="alert">
        <Icon name="lock" size={40} />
        <p class="empty-lead">{denialText()}</p>
      </div>
    );
  }
  if (link !== "open") {
    return (
      <div class="empty">
        <p class="quiet">{t("empty.waiting")}</p>
      </div>
    );
  }
  const mayOpen = canSteer();
  return (
    <div class="empty" data-testid="empty">
      <StartDemo />
      <h2 class="empty-title">{t("empty.title")}</h2>
      <button type="button" class="drop-zone" disabled={!mayOpen} onClick={chooseFile} data-testid="drop-zone">
        <Icon name="upload" size={36} />
        <strong>{t("empty.drop")}</strong>
        <span class="link-like">{t("empty.or")}</span>
        <span class="quiet">{t("empty.formats")}</span>
      </button>
      {mayOpen ? null : <p class="quiet">{t("empty.needsLease")}</p>}
      <Offered title={t("start.recent")} offered={store.examples.value.filter((each) => each.is_recent)} mayOpen={mayOpen} />
      <Offered title={t("empty.examples")} offered={store.examples.value.filter((each) => !each.is_recent)} mayOpen={mayOpen} />
      <StartDevices />
    </div>
  );
}

/** Products to open by a click; nothing where there are none. */
function Offered({ title, offered, mayOpen }: { title: string; offered: readonly Example[]; mayOpen: boolean }) {
  return offered.length === 0 ? null : (
    <>
      <p class="empty-or">{title}</p>
      <div class="examples">
        {offered.map((example) => (
          <button
            key={example.id}
            type="button"
            class="example"
            disabled={!mayOpen}
            data-testid={`example-${example.id}`}
            onClick={() => void studio.command({ command: "open", example: example.id })}
          >
            <Icon name={example.is_recent ? "cube" : "cubes"} size={26} />
            <strong>{example.name}</strong>
            <span>{example.about}</span>
          </button>
        ))}
      </div>
    </>
  );
}

export function LoadingDrawer() {
  const loading = store.loading.value;
  const upload = store.upload.value;
  const failure = store.failure.value;
  if (failure !== null) {
    return (
      <div class="drawer is-failed" role="alert" data-testid="failure">
        <h2>
          <Icon name="warn" /> {t("load.failed")}
        </h2>
        <p>{failure.message}</p>
        {failure.where ? <p class="quiet">{failure.where}</p> : null}
        {failure.remedy ? <p>{failure.remedy}</p> : null}
        <button type="button" class="small-button" onClick={() => (store.failure.value = null)}>
          {t("load.close")}
        </button>
      </div>
    );
  }
  const share = store.meshShare.value;
  const meshes = share === null ? null : { file: store.scene.value?.name ?? "", fraction: share, stage: "meshes" };
  const now = upload !== null ? { ...upload, stage: "upload" } : (loading ?? meshes);
  if (now === null) {
    return null;
  }
  const percent = Math.round(100 * now.fraction);
  return (
    <div class="drawer" data-testid="loading">
      <h2>{t("load.title", { file: now.file })}</h2>
      <div class="progress" role="progressbar" aria-valuenow={percent} aria-valuemin={0} aria-valuemax={100} aria-label={stageName(now.stage)}>
        <i style={{ transform: `scaleX(${Math.max(0.02, now.fraction)})` }} />
      </div>
      <p class="drawer-row">
        <span>{stageName(now.stage)}</span>
        <span class="figures">{number(percent, 0)} %</span>
        <button type="button" class="small-button" data-testid="cancel-open" onClick={() => studio.opening.cancel()}>
          {t("load.cancel")}
        </button>
      </p>
    </div>
  );
}
