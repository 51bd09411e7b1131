#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "cad/import.h"
#include "studio/json.h"

namespace hvas::studio {

/** Passes the events of docs/protocol.md from the parts of the workbench to the listeners. Any
 thread may call Publish() while it holds no lock; the listeners are called on that thread, in the
 order in which they subscribed. */
class EventBus {
 public:
  using Listener = std::function<void(const Json& event)>;

  /** Adds a listener. @pre no event has been published. */
  void Subscribe(Listener listener) { listeners_.push_back(std::move(listener)); }

  void Publish(const Json& event) const;

 private:
  std::vector<Listener> listeners_;
};

/** Makes a function that publishes the event "progress". @param name  Display name of the file, or
 of the edit, that takes the time. */
[[nodiscard]] cad::ProgressFn MakeProgressListener(const EventBus* events, const std::string& name);

}  // namespace hvas::studio
