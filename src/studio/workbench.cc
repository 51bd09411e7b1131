#include "studio/workbench.h"

#include <utility>

namespace hvas::studio {

Workbench::Workbench(const WorkbenchOptions& options)
    : builder_(options.scenes),
      live_({options.scenes.seed, options.rate_hz, options.guidance, options.clock}, &events_),
      hands_(&live_, &events_, &worker_, options.devices),
      notes_(&live_, &events_),
      edits_(&builder_, &live_, &events_, &worker_),
      demo_(&live_, &edits_, &worker_),
      orders_({&builder_, &live_, &edits_, &events_, &worker_}),
      recordings_(options.recordings_folder, &live_, &events_, &worker_),
      trials_({&builder_, &live_, &edits_, &events_, &worker_}, 1 / options.rate_hz),
      saver_(options.work_file, {&live_, &trials_, &notes_}, &events_),
      opener_({&builder_, &live_, &edits_, &notes_, &paths_, &saver_, &events_, &worker_}) {
  events_.Subscribe([this](const Json& event) {  // after the recordings, which subscribe themselves
    if (event["event"] == "notes") {
      saver_.ScheduleSave();
    }
    if (on_event) {
      on_event(event);
    }
  });
  // The saver precedes the demo, whose step may begin another run.
  live_.SetObservers(
      {&hands_, &recordings_, &notes_, &trials_, &edits_, &opener_, &saver_, &demo_, this});
}

Workbench::~Workbench() {
  Stop();
}

void Workbench::Stop() {
  worker_.RequestStop();
  opener_.Cancel();  // after the flag is set, so that nothing else begins
  recordings_.StopDiskWork();
  recordings_.Finish();  // before anything that takes long
  live_.EndRun();
  sweeper_.Stop();
  hands_.Stop();
  worker_.Stop();
  live_.EndRun();  // a run that the worker has just begun
  recordings_.Finish();
  saver_.Stop();
}

void Workbench::OnFrame(const simulation::Frame& frame) {
  paths_.Add(frame);
  if (on_frame) {
    on_frame();
  }
}

std::vector<Json> Workbench::MakeCatchUpEvents() const {
  std::vector<Json> news{edits_.DescribeHistory(), notes_.MakeEvent()};
  if (Json step = live_.DescribeStep(); !step.is_null()) {
    news.push_back(std::move(step));
  }
  for (Json& event : opener_.MakeCatchUpEvents()) {
    news.push_back(std::move(event));
  }
  return news;
}

}  // namespace hvas::studio
