import { useRef } from "preact/hooks";
import { findAction, runAction } from "./actions";
import { store, studio, viewport } from "./app_state";
import { catalogues, language, languageNames, number, t, tn, type Language } from "./i18n";
import { Key } from "./key";
import { ageText, setText, useLive } from "./live";

/** kB/s since the last look. */
function makeMeter(): (bytes: number, now: number) => number {
  let last = { bytes: 0, at: 0 };
  let rate = 0;
  return (bytes, now) => {
    if (now - last.at > 900) {
      rate = last.at === 0 ? 0 : Math.max(0, bytes - last.bytes) / (now - last.at);
      last = { bytes, at: now };
    }
    return rate;
  };
}

export function StatusBar() {
  const fps = useRef<HTMLSpanElement>(null);
  const stream = useRef<HTMLSpanElement>(null);
  const age = useRef<HTMLSpanElement>(null);
  const meter = useRef(makeMeter());
  useLive((live) => {
    const rate = meter.current(studio.liveFrames?.bytesReceived ?? 0, performance.now());
    setText(fps.current, t("status.fps", { n: viewport.value?.meter.framesPerSecond || "–" }));
    setText(stream.current, t("status.stream", { n: number(rate, 0) }));
    setText(age.current, t("status.age", { age: ageText(live) }));
  }, 400);
  const link = store.link.value === "open" && store.isSilent.value ? "silent" : store.link.value;
  const scene = store.scene.value;
  const viewers = store.clients.value.length - 1;
  return (
    <footer class="status">
      <span class={`chip-plain is-${link}`} data-testid="link" data-link={link}>
        {t(`status.${link}`, { host: location.host })}
      </span>
      <span class="figures" ref={fps} />
      {scene !== null ? <span>{tn("status.parts", scene.occurrences.length)}</span> : null}
      {scene !== null ? <span class="wide-only">{t("status.triangles", { n: number(scene.triangles, 0) })}</span> : null}
      <span class="figures wide-only" ref={stream} />
      <span class="figures" ref={age} data-testid="age" />
      {viewers > 0 ? <span>{tn("status.viewers", viewers)}</span> : null}
      <span class="spacer" />
      <span>{t("status.units")}</span>
      <select
        class="language"
        aria-label={t("status.language")}
        data-testid="language"
        value={language.value}
        onChange={(event) => (language.value = event.currentTarget.value as Language)}
      >
        {(Object.keys(catalogues) as Language[]).map((code) => (
          <option key={code} value={code}>
            {languageNames[code]}
          </option>
        ))}
      </select>
      <button type="button" class="status-button" data-testid="open-shortcuts" onClick={() => runAction(findAction("shortcuts"))}>
        <Key of={findAction("shortcuts")} /> {t("status.shortcuts")}
      </button>
    </footer>
  );
}
