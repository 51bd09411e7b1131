#include "app/devices/devices_report.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/output/text_layout.h"
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
    return "deflections, integrated to a position";
  }
  const Vec3 box_mm = 1e3 * profile.workspace;
  return fmt::format("{:.0f} x {:.0f} x {:.0f} mm in steps of {:.3g} um{}", box_mm.x(), box_mm.y(),
                     box_mm.z(), 1e6 * profile.position_resolution,
                     can.senses_rotation ? ", and rotation" : ", no rotation");
}

nlohmann::ordered_json ToJson(const DeviceInfo& info) {
  const device::Capabilities& can = info.capabilities;
  const device::DeviceProfile& profile = info.profile;
  return {{"address", AddressOf(info)},
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

/** Lines that begin at one column, with a word before the first. */
std::string Labelled(const std::string& label, const std::string& text) {
  // A label begins at the first of these columns, and its text at the second, behind the longest
  // label.
  constexpr std::size_t kIndent = 4;
  constexpr std::size_t kTextColumn = 18;
  return Wrap(text, kTextColumn).replace(kIndent, label.size(), label);
}

/** Findings that differ only in what was looked for, or only in where. */
struct FindingGroup {
  std::vector<std::string> names;
  std::vector<std::string> places;
  bool is_found{false};
  std::string note;

  [[nodiscard]] bool IsAlike(const FindingGroup& other) const {
    return is_found == other.is_found && note == other.note;
  }
};

/** The loader's own words say no more than that something is not there. */
std::string NoteForPerson(const Finding& finding) {
  const bool is_loaders = !finding.is_found && finding.note.starts_with(finding.what + ":");
  return is_loaders ? "" : finding.note;
}

std::vector<FindingGroup> GroupFindings(const std::vector<Finding>& findings) {
  std::vector<FindingGroup> by_place;
  for (const Finding& finding : findings) {
    FindingGroup one{{finding.what}, {finding.where}, finding.is_found, NoteForPerson(finding)};
    if (!by_place.empty() && by_place.back().IsAlike(one) && by_place.back().places == one.places) {
      by_place.back().names.push_back(finding.what);
    } else {
      by_place.push_back(std::move(one));
    }
  }
  std::vector<FindingGroup> groups;
  for (FindingGroup& one : by_place) {
    if (!groups.empty() && groups.back().IsAlike(one) && groups.back().names == one.names) {
      groups.back().places.push_back(one.places.front());
    } else {
      groups.push_back(std::move(one));
    }
  }
  return groups;
}

/** What is there comes first. */
std::string DescribeFindings(std::vector<Finding> findings) {
  std::stable_partition(findings.begin(), findings.end(),
                        [](const Finding& finding) { return finding.is_found; });
  std::string text;
  for (const FindingGroup& group : GroupFindings(findings)) {
    const std::string& place = group.places.front();
    const bool is_address = place.find(':') != std::string::npos;
    const std::string where = fmt::format("{}", fmt::join(group.places, ", "));
    text += Labelled(group.is_found ? "there" : "not there",
                     fmt::format("{}{}{}{}", fmt::join(group.names, ", "),
                                 place.empty() ? "" : (is_address ? " at " : " in ") + where,
                                 group.note.empty() ? "" : "; ", group.note));
  }
  return text;
}

/** A problem's place is not told twice: its message or the findings may have it, too. */
bool HasPlace(const ProbeReport& report, const Error& problem) {
  return problem.message.find(problem.where) != std::string::npos ||
         std::any_of(report.looked_for.begin(), report.looked_for.end(), [&](const Finding& f) {
           return !f.where.empty() && problem.where.find(f.where) != std::string::npos;
         });
}

std::string DescribeProblem(const ProbeReport& report, const Error& problem) {
  const bool tells_place = !HasPlace(report, problem);
  const bool is_absent = problem.code == ErrorCode::kNotFound;
  std::string text = Labelled(is_absent ? "none" : "PROBLEM",
                              problem.message + (tells_place ? ": " + problem.where : ""));
  if (!problem.remedy.empty()) {
    text += Labelled("what to do", problem.remedy);
  }
  return text;
}

std::string DescribeReport(const ProbeReport& report) {
  std::string text = fmt::format("{}: {}\n", report.driver, report.title);
  for (const DeviceInfo& info : report.devices) {
    text += DescribeDevice(info);
  }
  for (const Error& problem : report.problems) {
    text += DescribeProblem(report, problem);
  }
  return text + DescribeFindings(report.looked_for) + "\n";
}

/** As a shell takes it for one word. */
std::string Quote(const std::string& word) {
  const bool is_plain = std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("_-./:=@%+,").find(char(c)) != std::string::npos;
  });
  return is_plain ? word : "'" + word + "'";
}

std::string NameOf(const DeviceInfo& info) {
  return (info.is_emulated ? "EMULATED " : "") + info.model;
}

std::string DescribeUse(const DeviceInfo& info) {
  const std::string address = Quote(AddressOf(info));
  return fmt::format(
      "Try it with a virtual floor first, then use it:\n"
      "  hvas devices --try {0} --seconds 30\n"
      "  hvas assemble FILE --device {0} --realtime\n",
      address);
}

constexpr const char* kWithoutDevice =
    "Without a device, the simulated person works alone or with an emulated device:\n"
    "  hvas assemble FILE\n"
    "  hvas assemble FILE --device emulated:openhaptics:touch_x\n"
    "  hvas devices --try emulated:openhaptics --seconds 5\n";

}  // namespace

std::string AddressOf(const DeviceInfo& info) {
  if (info.address.empty()) {
    return info.driver;
  }
  const std::string driver = info.driver + ":";
  return info.address.starts_with(driver) ? info.address : driver + info.address;
}

std::string DescribeDevice(const DeviceInfo& info) {
  std::string text = Labelled(info.is_emulated ? "EMULATED" : "DEVICE",
                              info.model + (info.serial.empty() ? "" : ", serial " + info.serial));
  text += fmt::format("    {:<14}{}\n", "address", AddressOf(info));  // whole, to be copied
  if (!info.version.empty()) {
    text += Labelled("software", info.version);
  }
  text += Labelled("senses", DescribeSensing(info));
  text += Labelled("shows", DescribeForces(info));
  if (!info.profile_note.empty()) {
    text += Labelled("profile", info.profile_note);
  }
  return text;
}

std::string DescribeProbe(const std::vector<ProbeReport>& reports, bool has_opened) {
  std::string text;
  std::vector<DeviceInfo> devices;
  for (const ProbeReport& report : reports) {
    text += DescribeReport(report);
    devices.insert(devices.end(), report.devices.begin(), report.devices.end());
  }
  if (!has_opened) {
    return text +
           "No device was started. To start each one that was found, without force:\n"
           "  hvas devices --probe\n";
  }
  if (devices.empty()) {
    return text +
           "No device is usable now. Follow the \"what to do\" of your device, and run this "
           "command again.\n" +
           kWithoutDevice;
  }
  const auto real = std::find_if(devices.begin(), devices.end(),
                                 [](const DeviceInfo& info) { return !info.is_emulated; });
  const DeviceInfo& first = real != devices.end() ? *real : devices.front();
  return text +
         fmt::format("{} usable.\n", devices.size() == 1
                                         ? NameOf(first) + " is"
                                         : fmt::format("{} devices are", devices.size())) +
         DescribeUse(first);
}

nlohmann::ordered_json MakeProbeJson(const std::vector<ProbeReport>& reports, bool has_opened) {
  nlohmann::ordered_json document{{"schema", 1}, {"probed", has_opened}};
  document["drivers"] = nlohmann::ordered_json::array();
  for (const ProbeReport& report : reports) {
    document["drivers"].push_back(ToJson(report));
  }
  document["emulators"] = device::EmulatedDrivers();
  return document;
}

}  // namespace hvas::app
