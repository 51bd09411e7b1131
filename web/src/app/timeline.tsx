/** Record, play, and the line of time with what happened on it. */

import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { liveMarks, type Mark } from "../model/marks";
import { kSpeeds, type Playback } from "../model/playback";
import { ActionButton } from "./action_button";
import { findAction, isEnabled, runAction } from "./actions";
import { liveTraces, store, studio, ui } from "./app_state";
import { logText } from "./event_list";
import { duration, number, t } from "./i18n";
import { Icon } from "./icons";
import { shownKey } from "./key";
import { setText, useLive } from "./live";
import { backToLive, openRecording, plotClock, seek, shownSpan } from "./time_source";

const kDrawMs = 30;
const kMarksMs = 1000;
/** An event this near to the thumb is told with the time, as a share of the line. */
const kNear = 0.006;
/** A press that moves less than this is a click [px]. */
const kClickPx = 3;

export function markText(mark: Mark): string {
  return mark.told === null ? t("mark.contact") : logText(mark.told);
}

function RecordButton() {
  const label = useRef<HTMLSpanElement>(null);
  const { recording } = store;
  const isOn = recording.value !== null;
  useLive(() => {
    const now = recording.peek();
    setText(label.current, now === null ? t("time.rec") : duration((performance.now() - now.sinceMs) / 1e3));
  }, 100);
  const found = findAction("record");
  const keys = shownKey(found);
  return (
    <button
      type="button"
      class={`rec-button ${isOn ? "is-on" : ""}`}
      aria-pressed={isOn}
      aria-label={found.label()}
      title={keys === null ? found.label() : `${found.label()} (${keys})`}
      disabled={!isEnabled(found)}
      data-testid="rec"
      onClick={() => runAction(found)}
    >
      <i aria-hidden="true" />
      <span class="figures" ref={label}>
        {t("time.rec")}
      </span>
    </button>
  );
}

function Transport({ playback }: { playback: Playback | null }) {
  return (
    <div class="transport" role="group" aria-label={t("time.transport")}>
      <ActionButton id="play-start" icon="toStart" />
      <ActionButton id="play" icon={playback?.isPlaying.value ? "pause" : "play"} />
      <ActionButton id="play-end" icon="toEnd" />
    </div>
  );
}

function Speed({ playback }: { playback: Playback }) {
  return (
    <select
      class="speed"
      aria-label={t("time.speed")}
      data-testid="speed"
      value={playback.speed.value}
      onChange={(event) => (playback.speed.value = Number(event.currentTarget.value))}
    >
      {kSpeeds.map((speed) => (
        <option key={speed} value={speed}>
          {number(speed)}×
        </option>
      ))}
    </select>
  );
}

/** Of live plots they come as it goes on. */
function useMarks(playback: Playback | null): readonly Mark[] {
  const beat = useSignal(0);
  useEffect(() => {
    const timer = setInterval(() => (beat.value += 1), kMarksMs);
    return () => clearInterval(timer);
  }, []);
  if (playback !== null) {
    return playback.marks;
  }
  void beat.value;
  return liveMarks(store.log.value, liveTraces.list());
}

/** The time of the thumb: of a playback its moment, of live plots the end of what they show. */
function thumbS(): number {
  return studio.recordings.playback.peek()?.timeS ?? shownSpan().toS;
}

function shareOf(timeS: number): number {
  const { beginS, endS } = plotClock();
  return endS > beginS ? Math.min(1, Math.max(0, (timeS - beginS) / (endS - beginS))) : 1;
}

/** What the thumb's place means, in words. */
function thumbText(marks: readonly Mark[]): string {
  const { isReplay, endS } = plotClock();
  const timeS = thumbS();
  const share = shareOf(timeS);
  const near = marks.filter((mark) => Math.abs(shareOf(mark.timeS) - share) < kNear).map(markText);
  const time = isReplay ? duration(timeS) : ui.plotSpan.peek() === null ? t("time.live") : t("time.ago", { s: number(endS - timeS, 1) });
  return [time, ...near].join(", ");
}

function moveBy(event: KeyboardEvent): boolean {
  const playback = studio.recordings.playback.peek();
  const { beginS, endS } = plotClock();
  const frame = event.key === "ArrowRight" || event.key === "ArrowUp" ? 1 : event.key === "ArrowLeft" || event.key === "ArrowDown" ? -1 : 0;
  const second = event.key === "PageUp" ? 1 : event.key === "PageDown" ? -1 : event.shiftKey ? frame : 0;
  if (event.key === "Home" || event.key === "End") {
    seek(event.key === "Home" ? beginS : endS);
  } else if (second !== 0) {
    seek(thumbS() + second);
  } else if (frame !== 0) {
    if (playback !== null) {
      playback.stepFrames(frame);
    } else {
      seek(thumbS() + frame / 60);
    }
  } else {
    return false;
  }
  return true;
}

function Track({ marks }: { marks: readonly Mark[] }) {
  const slider = useRef<HTMLDivElement>(null);
  const fill = useRef<HTMLElement>(null);
  const thumb = useRef<HTMLElement>(null);
  const place = () => {
    const share = shareOf(thumbS());
    if (fill.current !== null && thumb.current !== null) {
      fill.current.style.transform = `scaleX(${share})`;
      thumb.current.style.left = `${100 * share}%`;
    }
  };
  const tell = () => {
    if (slider.current === null) {
      return;
    }
    const { beginS, endS } = plotClock();
    slider.current.setAttribute("aria-valuemax", (endS - beginS).toFixed(1));
    slider.current.setAttribute("aria-valuenow", (thumbS() - beginS).toFixed(1));
    slider.current.setAttribute("aria-valuetext", thumbText(marks));
    slider.current.title = thumbText(marks);
  };
  useLive(place, kDrawMs);
  useLive(tell, 250);
  /** Where it was pressed; a press on a mark that does not move on is for the mark's own moment. */
  const pressedAt = useRef<number | null>(null);
  const drag = (event: PointerEvent) => {
    const box = slider.current!.getBoundingClientRect();
    const { beginS, endS } = plotClock();
    seek(beginS + Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)) * (endS - beginS));
    place();
  };
  const onPress = (event: PointerEvent) => {
    if (event.button !== 0) {
      return;
    }
    slider.current!.setPointerCapture(event.pointerId);
    slider.current!.focus();
    event.preventDefault();
    const mark = (event.target as HTMLElement).dataset["timeS"];
    if (mark === undefined) {
      drag(event);
    } else {
      pressedAt.current = event.clientX;
      seek(Number(mark));
      place();
    }
  };
  const onMove = (event: PointerEvent) => {
    const isOnMark = pressedAt.current !== null && Math.abs(event.clientX - pressedAt.current) < kClickPx;
    if (!isOnMark && slider.current!.hasPointerCapture(event.pointerId)) {
      pressedAt.current = null;
      drag(event);
    }
  };
  return (
    <div
      class="track"
      onPointerDown={onPress}
      onPointerMove={onMove}
      onPointerUp={() => (pressedAt.current = null)}
      onPointerCancel={() => (pressedAt.current = null)}
    >
      <div
        class="track-slider"
        role="slider"
        tabIndex={0}
        aria-label={t("time.position")}
        aria-valuemin={0}
        aria-valuemax={0}
        aria-valuenow={0}
        ref={slider}
        data-testid="timeline"
        onKeyDown={(event) => {
          if (moveBy(event)) {
            event.preventDefault();
            place();
            tell();
          }
        }}
      >
        <span class="track-bar">
          <i ref={fill} />
        </span>
        <i class="track-thumb" ref={thumb} />
      </div>
      <Marks marks={marks} />
    </div>
  );
}

function Marks({ marks }: { marks: readonly Mark[] }) {
  const { beginS, endS, isReplay } = plotClock();
  return (
    <>
      {marks
        .filter((mark) => mark.timeS >= beginS && mark.timeS <= endS)
        .map((mark) => {
          const text = isReplay ? `${duration(mark.timeS)} ${markText(mark)}` : markText(mark);
          return (
            <button
              key={`${mark.timeS}/${mark.kind}`}
              type="button"
              tabIndex={-1}
              class={`mark is-${mark.kind}`}
              style={{ left: `${100 * shareOf(mark.timeS)}%` }}
              title={text}
              aria-label={text}
              data-time-s={mark.timeS}
              onClick={(event) => event.detail === 0 && seek(mark.timeS)}
            />
          );
        })}
    </>
  );
}

function Place({ playback }: { playback: Playback | null }) {
  const text = useRef<HTMLSpanElement>(null);
  useLive(() => {
    const { endS } = plotClock();
    if (playback !== null) {
      setText(text.current, `${duration(playback.timeS)} / ${duration(playback.durationS)}`);
    } else {
      const isHeld = ui.plotSpan.peek() !== null;
      setText(text.current, isHeld ? t("time.ago", { s: number(endS - thumbS(), 1) }) : t("time.live"));
    }
  }, 80);
  return <span class="place figures" ref={text} data-testid="time" />;
}

/** A recording that has just been made is a click away. */
function LastMade() {
  const id = studio.recordings.lastMade.value;
  return id === null ? null : (
    <button type="button" class="small-button" data-testid="open-last" onClick={() => void openRecording(id)}>
      {t("time.openLast")}
    </button>
  );
}

export function Timeline() {
  const playback = studio.recordings.playback.value;
  const marks = useMarks(playback);
  const isBehind = playback !== null || ui.plotSpan.value !== null;
  if (store.scene.value === null) {
    return null;
  }
  return (
    <section class="timeline" aria-label={t("time.title")}>
      <RecordButton />
      <Transport playback={playback} />
      <Place playback={playback} />
      <Track marks={marks} />
      {playback === null ? null : <Speed playback={playback} />}
      <LastMade />
      <button
        type="button"
        class={`small-button live-button ${isBehind ? "is-main" : ""}`}
        disabled={!isBehind}
        data-testid="live"
        onClick={backToLive}
      >
        {t("time.toLive")}
      </button>
      <button
        type="button"
        class="icon-button"
        aria-label={t("action.recordings")}
        title={t("action.recordings")}
        data-testid="open-recordings"
        onClick={() => runAction(findAction("recordings"))}
      >
        <Icon name="list" />
      </button>
    </section>
  );
}
