#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "base/job_thread.h"
#include "studio/event_bus.h"
#include "studio/json.h"
#include "studio/live_scene.h"
#include "studio/paths.h"
#include "studio/scene_builder.h"
#include "studio/scene_observer.h"
#include "studio/scene_opener.h"
#include "studio/work_saver.h"
#include "studio/workbench_demo.h"
#include "studio/workbench_edits.h"
#include "studio/workbench_hands.h"
#include "studio/workbench_notes.h"
#include "studio/workbench_orders.h"
#include "studio/workbench_recordings.h"
#include "studio/workbench_trials.h"

namespace hvas::studio {

struct WorkbenchOptions {
  SceneBuilder::Options scenes;
  std::filesystem::path recordings_folder;  ///< Empty: recording is switched off.
  std::filesystem::path work_file;  ///< File that SavedWork is saved to after changes; empty: none.
  std::vector<std::string> devices;  ///< Addresses that the host offers; see DeviceList.
  double rate_hz{1000};              ///< X4 asks for 1 kHz.
  haptics::PaperGuidance guidance;   ///< Guidance of all hands outside the trials of a study.
  /** Clock of the loops, of the age of inputs, and of a study's training; outlives the workbench.
   */
  LoopClock* clock{&MachineClock()};
};

/** Connects the parts of the workbench, each of which has its own state and its own mutex, and
 stops them. Any thread may call any function of this class and of its parts, unless they state
 otherwise. All but Stop() return at once: slow work is queued for a worker thread, which reports by
 events (docs/protocol.md). No part calls another one, an observer or a listener while it holds its
 mutex. */
class Workbench : private SceneObserver {
 public:
  explicit Workbench(const WorkbenchOptions& options);
  ~Workbench() override;

  /** Callbacks for every event and every new frame, on any thread; to be set before a file is
   opened. */
  std::function<void(Json)> on_event;
  std::function<void()> on_frame;

  /** Ends the run and drops the queue; no event or frame follows. */
  void Stop();

  /** Makes the events that a client needs which joins later: the present state, in the form of
   events. */
  [[nodiscard]] std::vector<Json> MakeCatchUpEvents() const;

  [[nodiscard]] EventBus& events() { return events_; }

  [[nodiscard]] LiveScene& live() { return live_; }

  [[nodiscard]] SceneOpener& opener() { return opener_; }

  [[nodiscard]] WorkbenchHands& hands() { return hands_; }

  [[nodiscard]] WorkbenchNotes& notes() { return notes_; }

  [[nodiscard]] WorkbenchEdits& edits() { return edits_; }

  [[nodiscard]] WorkbenchDemo& demo() { return demo_; }

  [[nodiscard]] WorkbenchOrders& orders() { return orders_; }

  [[nodiscard]] WorkbenchRecordings& recordings() { return recordings_; }

  [[nodiscard]] WorkbenchTrials& trials() { return trials_; }

  /** Paths of the parts of the open product. */
  [[nodiscard]] const PathLog& paths() const { return paths_; }

  [[nodiscard]] Sweeper& sweeper() { return sweeper_; }

 private:
  void OnFrame(const simulation::Frame& frame) override;

  // The worker is stopped by Stop(), before any of these is destroyed.
  JobThread worker_;
  EventBus events_;
  SceneBuilder builder_;  ///< Used by the worker thread only.
  LiveScene live_;
  WorkbenchHands hands_;
  WorkbenchNotes notes_;
  WorkbenchEdits edits_;
  WorkbenchDemo demo_;
  WorkbenchOrders orders_;
  WorkbenchRecordings recordings_;
  WorkbenchTrials trials_;
  WorkSaver saver_;
  PathLog paths_;
  Sweeper sweeper_;
  SceneOpener opener_;
};

}  // namespace hvas::studio
