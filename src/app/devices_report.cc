#include "app/devices_report.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text_layout.h"
#include "device/emulation/emulator.h"

namespace hvas::app {
namespace {

using device::DeviceInfo;
using device::Finding;
using device::ProbeReport;

std::string DescribeForces(const DeviceInfo& info) {
  const device::Capabilities& can = info.capabilities;
  const device::DeviceProfile& profile = info.profile;
  if (can.force_axes == 0) {
    return can.can_rumble ? "no forces; vibrates" : "no forces";
  }
  std::string text =
      fmt::format("{:.3g} N ({:.3g} N for long)", profile.max_force, profile.continuous_force);
  text += can.torque_axes > 0 ? fmt::format(", {:.3g} N m", profile.max_torque) : ", no torques";
  return text + fmt::format(", {:.0f} N/m", profile.max_stiffness);
}

std::string DescribeSensing(const DeviceInfo& info) {
  const device::Capabilities& can = info.capabilities;
  const device::DeviceProfile& profile = info.profile;
  if (!can.senses_position) {
    return "deflections, that a position is made of";
  }
  const Vec3 box_mm = 1e3 * profile.workspace;
  return fmt::format("{:.0f} x {:.0f} x {:.0f} mm in steps of {:.3g} um{}", box_mm.x(), box_mm.y(),
                     box_mm.z(), 1e6 * profile.position_resolution,
                     can.senses_rotation ? ", and rotation" : ", no rotation");
}

nlohmann::ordered_json ToJson(const DeviceInfo& info) {
  const device::Capabilities& can = info.capabilities;
  const device::DeviceProfile& profile = info.profile;
  return {{"address", info.driver + ":" + info.address},
          {"model", info.model},
          {"serial", info.serial},
          {"version", info.version},
          {"emulated", info.is_emulated},
          {"force_axes", can.force_axes},
          {"torque_axes", can.torque_axes},
          {"senses_position", can.senses_position},
          {"senses_rotation", can.senses_rotation},
          {"grip", can.has_grip},
          {"rumble", can.can_rumble},
          {"presence_switch", can.has_presence_switch},
          {"emergency_stop", can.has_emergency_stop},
          {"buttons", can.button_count},
          {"profile", profile.id},
          {"profile_note", info.profile_note},
          {"max_force_n", profile.max_force},
          {"continuous_force_n", profile.continuous_force},
          {"max_torque_nm", profile.max_torque},
          {"max_stiffness_n_per_m", profile.max_stiffness},
          {"position_resolution_m", profile.position_resolution},
          {"workspace_m", {profile.workspace.x(), profile.workspace.y(), profile.workspace.z()}},
          {"rate_hz", profile.rate_hz}};
}

nlohmann::ordered_json ToJson(const ProbeReport& report) {
  nlohmann::ordered_json json{{"driver", report.driver},
                              {"title", report.title},
                              {"looked_for", nlohmann::ordered_json::array()},
                              {"devices", nlohmann::ordered_json::array()},
                              {"problems", nlohmann::ordered_json::array()}};
  for (const Finding& finding : report.looked_for) {
    json["looked_for"].push_back({{"what", finding.what},
                                  {"where", finding.where},
                                  {"found", finding.is_found},
                                  {"note", finding.note}});
  }
  for (const DeviceInfo& info : report.devices) {
    json["devices"].push_back(ToJson(info));
  }
  for (const Error& problem : report.problems) {
    json["problems"].push_back(
        {{"message", problem.message}, {"where", problem.where}, {"remedy", problem.remedy}});
  }
  return json;
}

void PrintFinding(const Finding& finding) {
  fmt::print("    {} {}{}{}\n", finding.is_found ? "there:    " : "not there:", finding.what,
             finding.where.empty() ? "" : " in " + finding.where,
             finding.note.empty() ? "" : "; " + finding.note);
}

}  // namespace

void PrintDeviceText(const DeviceInfo& info) {
  fmt::print("    {}{}{}\n", info.is_emulated ? "EMULATED " : "", info.model,
             info.serial.empty() ? "" : ", serial " + info.serial);
  fmt::print("      address   {}\n", info.driver + ":" + info.address);
  if (!info.version.empty()) {
    fmt::print("      software  {}\n", info.version);
  }
  fmt::print("      senses    {}\n", DescribeSensing(info));
  fmt::print("      shows     {}\n", DescribeForces(info));
  if (!info.profile_note.empty()) {
    fmt::print("{}", Wrap(info.profile_note, 6));
  }
}

void PrintProbeText(const std::vector<ProbeReport>& reports, bool has_opened) {
  std::size_t devices = 0;
  std::size_t problems = 0;
  for (const ProbeReport& report : reports) {
    fmt::print("{}  ({})\n", report.title, report.driver);
    for (const Finding& finding : report.looked_for) {
      PrintFinding(finding);
    }
    for (const DeviceInfo& info : report.devices) {
      PrintDeviceText(info);
    }
    for (const Error& problem : report.problems) {
      fmt::print("{}", Wrap((has_opened ? "cannot start: " : "") + problem.ToString(), 4));
    }
    devices += report.devices.size();
    problems += report.problems.size();
    fmt::print("\n");
  }
  if (has_opened) {
    fmt::print("{} started, {} could not.\n", devices, problems);
  } else {
    fmt::print("Nothing was started; --probe starts each device that is there.\n");
  }
  if (devices == 0) {
    fmt::print(
        "Without a device: the mouse works in the studio, a simulated person in `hvas assemble`,\n"
        "and `hvas devices --try emulated:openhaptics` shows a device that is not there.\n");
  }
}

void PrintProbeJson(const std::vector<ProbeReport>& reports, bool has_opened) {
  nlohmann::ordered_json document{{"schema", 1}, {"probed", has_opened}};
  document["drivers"] = nlohmann::ordered_json::array();
  for (const ProbeReport& report : reports) {
    document["drivers"].push_back(ToJson(report));
  }
  document["emulators"] = device::EmulatedDrivers();
  fmt::print("{}\n", document.dump(2));
}

}  // namespace hvas::app
