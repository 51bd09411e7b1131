import { useEffect, useRef } from "preact/hooks";
import { canSteer, store, studio, ui } from "./app_state";
import { Banners, LiveRegion, Notice, useStatusPolling } from "./banners";
import { ConstraintList } from "./constraint_list";
import { Overlays } from "./dialogs";
import { GuideCard } from "./guide_card";
import { Header } from "./header";
import { HintBar } from "./hint_bar";
import { t } from "./i18n";
import { Inspector } from "./inspector";
import { Lazy } from "./lazy";
import { ModelTree } from "./model_tree";
import { EmptyState, LoadingDrawer } from "./opening";
import { PhoneBar, PhoneHeader, PhoneSheet } from "./phone";
import { Plots } from "./plots";
import { isPhone } from "./screen";
import { sizeOf, Splitter } from "./splitter";
import { StatusBar } from "./status_bar";
import { Timeline } from "./timeline";
import { ToolRail } from "./tool_rail";
import { FloatRow, ViewPanels } from "./view_panels";
import { ViewportHost } from "./viewport_host";

/** A file that is dragged onto the page is opened. */
function useDrop(root: { current: HTMLElement | null }): void {
  useEffect(() => {
    const element = root.current;
    const mark = (isOver: boolean) => element?.classList.toggle("is-dropping", isOver && canSteer());
    const over = (event: DragEvent) => {
      event.preventDefault();
      mark(true);
    };
    const leave = (event: DragEvent) => {
      if (event.relatedTarget === null) {
        mark(false);
      }
    };
    const drop = (event: DragEvent) => {
      event.preventDefault();
      mark(false);
      const file = event.dataTransfer?.files[0];
      if (file !== undefined && canSteer()) {
        void studio.opening.upload(file);
      }
    };
    addEventListener("dragover", over);
    addEventListener("dragleave", leave);
    addEventListener("drop", drop);
    return () => {
      removeEventListener("dragover", over);
      removeEventListener("dragleave", leave);
      removeEventListener("drop", drop);
    };
  }, []);
}

export function App() {
  const root = useRef<HTMLDivElement>(null);
  useDrop(root);
  useStatusPolling();
  const hasScene = store.scene.value !== null;
  const isStudy = studio.study.experimenter.value !== null;
  const { model, inspector, plots } = ui.panels;
  const isOnPhone = isPhone.value && !isStudy;
  const shows = (flag: { value: boolean }) => hasScene && !isOnPhone && flag.value && !(isStudy && flag !== plots);
  return (
    <div
      ref={root}
      style={{
        "--model-width": sizeOf("model"),
        "--inspector-width": sizeOf("inspector"),
        "--plots-height": sizeOf("plots"),
      }}
      class={`app ${shows(model) ? "has-model" : ""} ${shows(inspector) ? "has-inspector" : ""} ${shows(plots) ? "has-plots" : ""} ${isStudy ? "has-study" : ""} ${isOnPhone ? "is-phone" : ""}`}
    >
      {isOnPhone ? <PhoneHeader /> : <Header />}
      <main class="workspace">
        {shows(model) ? (
          <aside class="model-panel" aria-label={t("action.panelModel")}>
            <ModelTree />
            <ConstraintList />
          </aside>
        ) : null}
        <div class="centre">
          <ViewportHost />
          <div class="top-stack">
            <Banners />
            <FloatRow />
          </div>
          {hasScene ? <ToolRail /> : isStudy ? null : <EmptyState />}
          <ViewPanels />
          <div class="view-foot">
            <Notice />
            <GuideCard />
            <HintBar />
          </div>
          <LoadingDrawer />
          <div class="drop-veil" aria-hidden="true">
            {t("drop.here")}
          </div>
          {shows(model) ? <Splitter name="model" /> : null}
          {shows(inspector) ? <Splitter name="inspector" /> : null}
          {shows(plots) ? <Splitter name="plots" /> : null}
        </div>
        {shows(inspector) ? <Inspector /> : null}
        {isOnPhone ? <PhoneSheet /> : null}
        {isStudy ? <Lazy load={() => import("./study/experimenter")} /> : null}
      </main>
      {shows(plots) ? <Plots /> : null}
      {isOnPhone ? (
        <PhoneBar />
      ) : (
        <div class="foot">
          {isStudy ? null : <Timeline />}
          <StatusBar />
        </div>
      )}
      <Overlays />
      <LiveRegion />
    </div>
  );
}
