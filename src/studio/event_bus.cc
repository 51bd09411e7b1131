#include "studio/event_bus.h"

#include <string_view>

namespace hvas::studio {

void EventBus::Publish(const Json& event) const {
  for (const Listener& listener : listeners_) {
    listener(event);
  }
}

cad::ProgressFn MakeProgressListener(const EventBus* events, const std::string& name) {
  return [events, name](std::string_view stage, double fraction) {
    events->Publish(
        {{"event", "progress"}, {"stage", stage}, {"fraction", fraction}, {"file", name}});
  };
}

}  // namespace hvas::studio
