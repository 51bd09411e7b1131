#include "app/devices/devices.h"

#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/devices/device_trial.h"
#include "app/devices/devices_report.h"
#include "app/output/json_flag.h"
#include "app/output/progress.h"
#include "app/output/text_layout.h"

namespace hvas::app {
namespace {

struct DevicesOptions {
  bool is_probe{false};
  bool is_json{false};
  DeviceTrialOptions trial;
};

/** Devices and systems may call themselves by bytes that are no text. */
void PrintJson(const nlohmann::ordered_json& document) {
  fmt::print("{}\n", document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

int RunDevices(const DevicesOptions& options) {
  if (!options.trial.address.empty()) {
    return RunDeviceTrial(options.trial);
  }
  const device::Surroundings surroundings;
  std::vector<device::ProbeReport> reports;
  for (const device::Driver* driver : device::Drivers()) {
    if (options.is_probe && IsWatched() && !options.is_json) {
      fmt::print(stderr, "looking for {} ...\033[K\r", driver->title());
    }
    reports.push_back(driver->Probe(surroundings, options.is_probe));
  }
  if (options.is_probe && IsWatched() && !options.is_json) {
    fmt::print(stderr, "\033[K");
  }
  if (options.is_json) {
    PrintJson(MakeProbeJson(reports, options.is_probe));
  } else {
    fmt::print("{}", DescribeProbe(reports, options.is_probe));
  }
  return 0;
}

std::string AddressHelp() {
  std::string text = "Addresses:\n";
  for (const device::Driver* driver : device::Drivers()) {
    text += Wrap(fmt::format("{}: {}", driver->name(), driver->address_help()), 2);
  }
  return text + "  emulated:DRIVER[:PROFILE], as in emulated:forcedimension:sigma7\n";
}

}  // namespace

void AddDevices(CLI::App* app, int* status) {
  CLI::App* command =
      app->add_subcommand("devices", "List haptic devices: what was found, and problems");
  const auto options = std::make_shared<DevicesOptions>();
  command->add_flag("--probe", options->is_probe,
                    "Start each device that was found, without force, and stop it again");
  AddJsonFlag(command, &options->is_json, "devices");
  command->add_option(
      "--try", options->trial.address,
      "Render a horizontal floor on the device with this address, and print its samples");
  command->add_option("--seconds", options->trial.seconds, "Duration of the trial [s]")
      ->check(CLI::Range(0.5, 3600.0))
      ->capture_default_str();
  command->add_option("--rate", options->trial.rate_hz, "Rate of the loop [Hz]")
      ->check(CLI::Range(1000.0, 8000.0))
      ->capture_default_str();
  command->footer(AddressHelp() +
                  "Examples:\n"
                  "  hvas devices\n"
                  "  hvas devices --probe\n"
                  "  hvas devices --probe --json | jq '.drivers[].problems'\n"
                  "  hvas devices --try openhaptics --seconds 30\n"
                  "  hvas devices --try emulated:haply");
  command->callback([options, status] { *status = RunDevices(*options); });
}

}  // namespace hvas::app
