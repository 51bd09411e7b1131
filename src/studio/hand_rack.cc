#include "studio/hand_rack.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/check.h"
#include "studio/event_json.h"
#include "studio/protocol.h"

namespace hvas::studio {

static_assert(HandRack::kMaxHands == protocol::kMaxHands, "the page has room for as many");

namespace {

/** Describes the pointer in the form of a device. */
device::DeviceInfo MakePointerInfo() {
  device::DeviceInfo info;
  info.model = "Mouse, touch or controller";
  info.capabilities.force_axes = 3;  // forces are computed, and displayed as arrows and sounds
  info.capabilities.torque_axes = 3;
  return info;
}

Json DescribeDevice(std::size_t device, const device::DeviceInfo& info,
                    const haptics::TickOptions* tick) {
  Json json{{"index", device},
            {"name", info.profile.name.empty() ? info.model : info.profile.name},
            {"model", info.model},
            {"serial", info.serial},
            {"is_emulated", info.is_emulated},
            {"has_force", info.capabilities.force_axes > 0},
            {"has_torque", info.capabilities.torque_axes > 0},
            {"max_force_n", nullptr},
            {"scale", nullptr},
            {"notes", Json::array()}};
  if (tick != nullptr) {
    json["max_force_n"] = tick->limits ? tick->limits->max_force : tick->device.max_force;
    json["scale"] = tick->workspace.mapping.scale;
    json["notes"] = device == DeviceList::kPointer ? std::vector<std::string>()
                                                   : simulation::DescribeRendering(info, *tick);
  }
  return json;
}

std::string DescribeProbe(const device::ProbeReport& report) {
  if (!report.problems.empty()) {
    const Error& problem = report.problems.front();
    return problem.remedy.empty() ? problem.message
                                  : fmt::format("{}: {}", problem.message, problem.remedy);
  }
  std::vector<std::string> found;
  for (const device::Finding& finding : report.looked_for) {
    if (finding.is_found) {
      found.push_back(finding.what);
    }
  }
  return found.empty() ? "" : fmt::format("found {}", fmt::join(found, ", "));
}

/** Describes a device for the page, and looks whether it is there. */
Json Probe(std::size_t index, const DeviceList::Entry& entry) {
  Json json{{"index", index},
            {"driver", entry.driver},
            {"name", entry.name},
            {"detail", "named when the studio was started"},
            {"is_emulated", entry.is_emulated},
            {"is_ready", true}};
  if (entry.is_emulated) {
    json["detail"] = "not connected: simulated, and held by the pointer or the simulated person";
  }
  if (entry.probed != nullptr) {
    const device::ProbeReport report = entry.probed->Probe(device::Surroundings(), false);
    const bool is_found =
        std::any_of(report.looked_for.begin(), report.looked_for.end(),
                    [](const device::Finding& finding) { return finding.is_found; });
    json["detail"] = HideFolders(DescribeProbe(report));
    json["is_ready"] = is_found && report.problems.empty();
  }
  return json;
}

}  // namespace

DeviceList::DeviceList(const std::vector<std::string>& named)
    : entries_{{"", "", MakePointerInfo().model}} {
  for (const std::string& address : named) {
    const std::string driver = address.substr(0, address.find(':'));
    entries_.push_back(
        {address, driver, fmt::format("Device {} of the command line", entries_.size()), false});
  }
  for (const device::Driver* driver : device::Drivers()) {
    entries_.push_back({std::string(driver->name()), std::string(driver->name()),
                        std::string(driver->title()), false, driver});
  }
  for (const device::SourcedProfile& profile : device::KnownProfiles()) {
    entries_.push_back({fmt::format("emulated:{}:{}", profile.driver, profile.profile.id),
                        profile.driver, profile.profile.name, true});
  }
}

std::size_t HandRack::count() const {
  const std::lock_guard lock(mutex_);
  return slots_.size();
}

void HandRack::SetCount(std::size_t count) {
  HVAS_DEMAND(count >= 1 && count <= kMaxHands);
  std::vector<Slot> closed;  // destroyed after the lock is released: closing takes time
  const std::lock_guard lock(mutex_);
  while (slots_.size() > count) {
    closed.push_back(std::move(slots_.back()));
    slots_.pop_back();
  }
  slots_.resize(count);
}

Result<void> HandRack::Use(std::size_t hand, std::size_t device, double scale, bool is_live) {
  const DeviceList::Entry& entry = list_->entries()[device];
  Slot slot;
  slot.device = device;
  {
    const std::lock_guard lock(mutex_);
    if (hand >= slots_.size()) {
      return Fail(ErrorCode::kInvalid, "there is no such hand", fmt::format("hand {}", hand),
                  "add a hand first");
    }
    for (std::size_t i = 0; i < slots_.size() && device != DeviceList::kPointer; ++i) {
      if (slots_[i].device == device && i != hand) {
        return Fail(ErrorCode::kInvalid, "another hand uses this device", entry.name,
                    "choose another device for that hand first");
      }
    }
    if (slots_[hand].device == device) {
      slot = slots_[hand];
    }
  }
  if (device != DeviceList::kPointer && slot.setup.device == nullptr) {
    auto opened = device::OpenAnyDevice(entry.address, is_live);
    if (!opened) {
      return Unexpected(opened.error());
    }
    slot.setup.device = std::make_shared<device::OpenedDevice>(std::move(*opened));
  }
  slot.setup.scale = scale;
  const std::lock_guard lock(mutex_);
  std::swap(slots_[hand], slot);
  return {};
}

std::vector<HandSetup> HandRack::setups() const {
  const std::lock_guard lock(mutex_);
  std::vector<HandSetup> setups;
  for (const Slot& slot : slots_) {
    setups.push_back(slot.setup);
  }
  return setups;
}

std::string HandRack::SetState(std::size_t hand, device::Condition condition,
                               std::int32_t vendor_code) {
  const std::lock_guard lock(mutex_);
  if (hand >= slots_.size() || slots_[hand].setup.device == nullptr) {
    return {};
  }
  slots_[hand].condition = condition;
  device::DeviceState state;
  state.condition = condition;
  state.vendor_code = vendor_code;
  return slots_[hand].setup.device->device->Explain(state);
}

Json HandRack::Describe(const std::vector<const haptics::TickOptions*>& hands) const {
  const std::lock_guard lock(mutex_);
  Json list = Json::array();
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    const Slot& slot = slots_[i];
    const haptics::TickOptions* tick = i < hands.size() ? hands[i] : nullptr;
    const device::DeviceInfo info =
        slot.setup.device != nullptr ? slot.setup.device->device->info() : MakePointerInfo();
    list.push_back({{"hand", i},
                    {"device", DescribeDevice(slot.device, info, tick)},
                    {"condition", device::ToString(slot.condition)}});
  }
  return list;
}

bool DeviceSearch::Begin() {
  const std::lock_guard lock(mutex_);
  return !std::exchange(is_searching_, true);
}

void DeviceSearch::Run() {
  Json found = Json::array();
  for (std::size_t i = 0; i < list_->entries().size(); ++i) {
    if (i != DeviceList::kPointer) {
      found.push_back(Probe(i, list_->entries()[i]));
    }
  }
  const std::lock_guard lock(mutex_);
  found_ = std::move(found);
  is_searching_ = false;
}

Json DeviceSearch::Describe() const {
  const std::lock_guard lock(mutex_);
  return {{"devices", found_}, {"is_searching", is_searching_}};
}

}  // namespace hvas::studio
