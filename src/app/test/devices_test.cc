#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "app/devices/devices_report.h"
#include "app/test/json_schema.h"
#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"
#include "device/emulation/library_emulator.h"
#include "record/reader.h"

namespace hvas::app {
namespace {

using device::Driver;
using device::Drivers;
using device::Emulator;
using device::EmulatorOptions;
using device::LibraryManners;
using device::ProbeReport;
using device::Surroundings;
using hvas::testing::TemporaryFolder;
using nlohmann::json;
using testing::ProductFile;
using testing::Ran;
using testing::ReadSchema;
using testing::RunHvas;
using testing::RunHvasJson;
using testing::Validate;

using Lines = std::vector<std::string>;

/** A folder that stands for a whole machine. The test works beside it, so that the paths that are
 told have the same length everywhere. */
class BareMachine : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::current_path(folder_.path());
    std::filesystem::create_directory("pc");
    surroundings_.root = "pc";
    ::setenv("COLUMNS", "100", 1);
  }

  void TearDown() override {
    std::filesystem::current_path(before_);
    ::unsetenv("COLUMNS");
  }

  static void Put(const std::string& file, const std::string& text) {
    std::filesystem::create_directories(std::filesystem::path(file).parent_path());
    std::ofstream(file) << text;
  }

  [[nodiscard]] ProbeReport Probe(const std::string& name, bool opens = true) const {
    const auto& drivers = Drivers();
    const auto driver = std::find_if(drivers.begin(), drivers.end(),
                                     [&](const Driver* d) { return d->name() == name; });
    return (*driver)->Probe(surroundings_, opens);
  }

  [[nodiscard]] std::vector<ProbeReport> ProbeAll(bool opens) const {
    std::vector<ProbeReport> reports;
    for (const Driver* driver : Drivers()) {
      reports.push_back(driver->Probe(surroundings_, opens));
    }
    return reports;
  }

 private:
  TemporaryFolder folder_;
  const std::filesystem::path before_{std::filesystem::current_path()};
  Surroundings surroundings_;
};

TEST_F(BareMachine, WithoutAnyDeviceItExplainsItself) {
  EXPECT_EQ(DescribeProbe(ProbeAll(true), true), R"TEXT(openhaptics: OpenHaptics (3D Systems)
    none          the library of OpenHaptics (3D Systems) (libHD.so.3*, libHD.so) is not installed
    what to do    install the Touch Device Driver and OpenHaptics Developer Edition of 3D Systems,
                  and set GTDD_HOME to their folder when that is not below /usr or /opt
    not there     USB device 2988:* of 3D Systems in pc/sys/bus/usb/devices
    not there     libHD.so.3*, libHD.so in pc/opt/geomagic_touch_device_driver/lib,
                  pc/opt/OpenHaptics/Developer/lib, pc/usr/local/lib, pc/usr/lib, pc/usr/lib64,
                  pc/usr/lib/x86_64-linux-gnu, pc/usr/lib/aarch64-linux-gnu

forcedimension: Force Dimension (DHD/DRD)
    none          the library of Force Dimension (DHD/DRD) (libdrd.so.3*, libdrd.so) is not
                  installed
    what to do    install the SDK of Force Dimension, and set FORCEDIM_SDK to its folder when that
                  is not below /usr/local
    not there     USB device 1451:* of Force Dimension in pc/sys/bus/usb/devices
    not there     libdrd.so.3*, libdrd.so in pc/usr/local/lib, pc/usr/lib, pc/usr/lib64,
                  pc/usr/lib/x86_64-linux-gnu, pc/usr/lib/aarch64-linux-gnu

virtuose: Haption Virtuose (VirtuoseAPI 4)
    none          the library of Haption Virtuose (VirtuoseAPI 4) (virtuoseAPI.so) is not installed
    what to do    install VirtuoseAPI 4 of Haption, and set VIRTUOSE_API to the folder of
                  virtuoseAPI.so when that is not below /usr or /opt
    not there     virtuoseAPI.so in pc/opt/haption, pc/opt/haption/lib, pc/usr/local/lib,
                  pc/usr/lib, pc/usr/lib64, pc/usr/lib/x86_64-linux-gnu,
                  pc/usr/lib/aarch64-linux-gnu

haply: Haply Inverse3 (Inverse Service)
    none          the Inverse Service is not running (no program listens on this address: Connection
                  refused)
    what to do    start Haply's Inverse Service on this machine (haply-inverse-service), or give its
                  address: haply:HOST:PORT
    not there     Inverse Service at ws://localhost:10001, ws://localhost:10000; no program listens
                  on this address: Connection refused

spacemouse: 3Dconnexion SpaceMouse (spacenavd)
    none          spacenavd is not running: its socket does not exist
    what to do    install and start it: apt install spacenavd; systemctl start spacenavd
    not there     spacenavd's socket in pc/var/run/spnav.sock

gamepad: Gamepad or joystick (Linux evdev)
    none          no gamepad or joystick is connected: pc/dev/input
    what to do    connect one, or pair it by Bluetooth

network: Network device (HVAS's own UDP protocol)
    none          there is no key for network devices
    what to do    make one with (umask 077; head -c 32 /dev/urandom > FILE), and give the device's
                  program the same file
    not there     key in pc/etc/hvas/network.key

plugin: Plug-in (a shared library for a device that HVAS does not know)
    none          no plug-in is installed
    what to do    put the library of a plug-in there, or give its path: plugin:/path/to/device.so
    not there     plug-ins in pc/usr/lib/hvas/plugins

No device is usable now. Follow the "what to do" of your device, and run this command again.
Without a device, the simulated person works alone or with an emulated device:
  hvas assemble FILE
  hvas assemble FILE --device emulated:openhaptics:touch_x
  hvas devices --try emulated:openhaptics --seconds 5
)TEXT");
}

TEST_F(BareMachine, WithoutProbingItSaysThatNothingWasStarted) {
  const std::string text = DescribeProbe(ProbeAll(false), false);
  EXPECT_TRUE(
      text.ends_with("\n\nNo device was started. To start each one that was found, without force:\n"
                     "  hvas devices --probe\n"))
      << text;
}

TEST_F(BareMachine, JsonFitsItsSchemaAndKeepsEveryPlace) {
  const auto reports = ProbeAll(true);
  const json document = json::parse(MakeProbeJson(reports, true).dump());
  EXPECT_EQ(Validate(ReadSchema("devices"), document), Lines{});
  ASSERT_EQ(document["drivers"].size(), Drivers().size());
  for (std::size_t i = 0; i < reports.size(); ++i) {
    const json& driver = document["drivers"][i];
    EXPECT_EQ(driver["looked_for"].size(), reports[i].looked_for.size());
    ASSERT_EQ(driver["problems"].size(), 1U) << driver.dump(1);
    EXPECT_NE(driver["problems"][0]["where"], "") << driver.dump(1);
    EXPECT_NE(driver["problems"][0]["remedy"], "") << driver.dump(1);
  }
}

TEST_F(BareMachine, DeviceThatThisUserMayNotUseIsToldWithTheRule) {
  Put("pc/sys/bus/usb/devices/1-2/idVendor", "2988\n");
  Put("pc/sys/bus/usb/devices/1-2/idProduct", "0302\n");
  Put("pc/sys/bus/usb/devices/1-2/product", "Touch\n");
  Put("pc/sys/bus/usb/devices/1-2/busnum", "1\n");
  Put("pc/sys/bus/usb/devices/1-2/devnum", "7\n");
  const std::string text = DescribeProbe({Probe("openhaptics")}, true);
  EXPECT_PRED_FORMAT2(
      ::testing::IsSubstring,
      "    PROBLEM       USB device 2988:0302 of 3D Systems has no device file\n"
      "    what to do    as root, put the line SUBSYSTEM==\"usb\", ATTR{idVendor}==\"2988\", "
      "MODE=\"0666\" into\n"
      "                  /etc/udev/rules.d/60-hvas-2988.rules, run \"udevadm control --reload\", "
      "and connect\n"
      "                  the device again\n",
      text);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "    there         USB device 2988:0302 in ", text);
}

TEST_F(BareMachine, KeyThatOthersCanReadIsAProblemAndNotAbsent) {
  Put("pc/etc/hvas/network.key", std::string(32, 'k'));
  std::filesystem::permissions("pc/etc/hvas/network.key", std::filesystem::perms(0644));
  const std::string text = DescribeProbe({Probe("network")}, true);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring,
                      "network: Network device (HVAS's own UDP protocol)\n"
                      "    PROBLEM       other users can read this key, so it is not secret\n"
                      "    what to do    make a new key with access for you only: chmod 600 "
                      "pc/etc/hvas/network.key\n"
                      "    not there     key in pc/etc/hvas/network.key\n",
                      text);
}

std::unique_ptr<Emulator> StartTouchX(const LibraryManners& manners) {
  EmulatorOptions options;
  options.profile = device::FindProfile("touch_x")->profile;
  auto emulator = device::StartLibraryEmulator("openhaptics", options, manners);
  EXPECT_TRUE(emulator.has_value());
  return emulator ? std::move(*emulator) : nullptr;
}

ProbeReport ProbeOpenHaptics(const Emulator& emulator) {
  const Driver& driver = *Drivers().front();
  EXPECT_EQ(driver.name(), "openhaptics");
  return driver.Probe(emulator.surroundings(), true);
}

TEST(ProbeTest, EmulatorIsMarkedAndTriedNext) {
  const auto emulator = StartTouchX({});
  const std::vector<ProbeReport> reports{ProbeOpenHaptics(*emulator)};
  const std::string text = DescribeProbe(reports, true);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring,
                      "openhaptics: OpenHaptics (3D Systems)\n"
                      "    EMULATED      PHANTOM Desktop, serial EMULATED0\n",
                      text);
  EXPECT_EQ(text.find("DEVICE"), std::string::npos);
  EXPECT_EQ(text.find("what to do"), std::string::npos);
  EXPECT_TRUE(
      text.ends_with("\n\nEMULATED PHANTOM Desktop is usable.\n"
                     "Try it with a virtual floor first, then use it:\n"
                     "  hvas devices --try openhaptics --seconds 30\n"
                     "  hvas assemble FILE --device openhaptics --realtime\n"))
      << text;
  const json document = json::parse(MakeProbeJson(reports, true).dump());
  EXPECT_EQ(Validate(ReadSchema("devices"), document), Lines{});
  const json& found = document["drivers"][0]["devices"].at(0);
  EXPECT_EQ(found["emulated"], true);
  EXPECT_EQ(found["address"], "openhaptics");
  EXPECT_EQ(found["profile"], "touch_x");
}

TEST(ProbeTest, LicenceThatIsMissingIsTold) {
  LibraryManners manners;
  manners.is_licensed = false;
  const auto emulator = StartTouchX(manners);
  ::setenv("COLUMNS", "100", 1);
  const std::string text = DescribeProbe({ProbeOpenHaptics(*emulator)}, true);
  ::unsetenv("COLUMNS");
  EXPECT_PRED_FORMAT2(
      ::testing::IsSubstring,
      "    PROBLEM       the first device of OpenHaptics could not be started: OpenHaptics has no "
      "valid\n"
      "                  licence (its error 0x0600)\n"
      "    what to do    install the licence that 3D Systems gave you (its License Installer), or "
      "the free\n"
      "                  Developer Edition\n"
      "    there         libHD.so in ",
      text);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "No device is usable now.", text);
}

TEST(ProbeTest, RealDeviceIsProposedBeforeAnEmulatedOne) {
  ProbeReport report{"forcedimension", "Force Dimension", {}, {}, {}};
  device::DeviceInfo info;
  info.driver = "forcedimension";
  info.address = "0";
  info.model = "sigma.7";
  info.is_emulated = true;
  report.devices = {info, info};
  report.devices[1].address = "1";
  report.devices[1].is_emulated = false;
  const std::string text = DescribeProbe({report}, true);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "2 devices are usable.\n", text);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "    DEVICE        sigma.7\n", text);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "--try forcedimension:1 --seconds", text);
  report.devices = {info};
  report.devices[0].address = "Default Device";
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "--try 'forcedimension:Default Device' --seconds",
                      DescribeProbe({report}, true));
}

TEST(ProbeTest, AddressHasItsDriverOnce) {
  device::DeviceInfo info;
  info.driver = "haply";
  EXPECT_EQ(AddressOf(info), "haply");
  info.address = "localhost:10001/049D";
  EXPECT_EQ(AddressOf(info), "haply:localhost:10001/049D");
  info.address = "haply:localhost:10001/049D";
  EXPECT_EQ(AddressOf(info), "haply:localhost:10001/049D");
}

TEST(DevicesSchema, RealOutputIsValid) {
  for (const bool is_probe : {false, true}) {
    const json document = is_probe ? RunHvasJson({"devices", "--probe"}) : RunHvasJson({"devices"});
    EXPECT_EQ(Validate(ReadSchema("devices"), document), Lines{});
    EXPECT_EQ(document["probed"], is_probe);
    EXPECT_EQ(document["drivers"].size(), Drivers().size());
  }
}

TEST(DevicesSchema, MistakesAreFound) {
  const json schema = ReadSchema("devices");
  const json good = RunHvasJson({"devices"});
  json bad = good;
  bad["drivers"][0].erase("problems");
  EXPECT_EQ(Validate(schema, bad).size(), 1U);
  bad = good;
  bad["drivers"][0]["looked_for"][0]["found"] = "no";
  EXPECT_EQ(Validate(schema, bad).size(), 1U);
  bad = good;
  bad["drivers"][0]["colour"] = 7;
  EXPECT_EQ(Validate(schema, bad).size(), 1U);
}

TEST(DeviceProfileSchema, EveryProfileIsValid) {
  const json schema = ReadSchema("device_profile");
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(HVAS_SOURCE_DIR) / "data" / "devices")) {
    const json document = json::parse(testing::ReadText(entry.path()));
    EXPECT_EQ(Validate(schema, document), Lines{}) << entry.path();
    EXPECT_EQ(document["id"], entry.path().stem().string());
    ++count;
  }
  EXPECT_EQ(count, device::KnownProfiles().size());
}

TEST(DeviceProfileSchema, MistakesAreFound) {
  const json schema = ReadSchema("device_profile");
  const json good = json::parse(testing::ReadText(std::filesystem::path(HVAS_SOURCE_DIR) / "data" /
                                                  "devices" / "touch.json"));
  json bad = good;
  bad["id"] = "Touch X";
  EXPECT_EQ(Validate(schema, bad).size(), 1U);
  bad = good;
  bad["figures"]["max_force_n"].erase("source");
  EXPECT_EQ(Validate(schema, bad).size(), 1U);
  bad = good;
  bad["figures"]["mass_kg"]["value"] = -1;
  EXPECT_EQ(Validate(schema, bad).size(), 1U);
  bad = good;
  bad["axes"]["value"][0] = "right";
  EXPECT_EQ(Validate(schema, bad).size(), 1U);
}

class EmulatedTrialTest : public ::testing::TestWithParam<std::string> {};

TEST_P(EmulatedTrialTest, IsMarkedAndRuns) {
  const Ran ran = RunHvas({"devices", "--try", "emulated:" + GetParam(), "--seconds", "1"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(ran.err, "");
  EXPECT_TRUE(ran.out.starts_with("    EMULATED      ")) << ran.out;
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "address       " + GetParam() + ":", ran.out);
  EXPECT_EQ(ran.out.find(GetParam() + ":" + GetParam() + ":"), std::string::npos) << ran.out;
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "A horizontal floor of ", ran.out);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, " s  at ", ran.out);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "wake-up after the deadline: median", ran.out);
}

INSTANTIATE_TEST_SUITE_P(Drivers, EmulatedTrialTest, ::testing::ValuesIn(device::EmulatedDrivers()),
                         [](const auto& instance) { return instance.param; });

json AssembleWith(const std::string& device) {
  return RunHvasJson({"assemble", ProductFile("bushing"), "-q", "--device", device});
}

TEST(AssembleWithDevice, EmulatedForceDeviceSeatsAllPartsTheSameWayEachTime) {
  const json first = AssembleWith("emulated:openhaptics:touch_x");
  EXPECT_EQ(first["seated"], 3);
  EXPECT_EQ(first["device"]["address"], "emulated:openhaptics:touch_x");
  EXPECT_EQ(first["device"]["model"], "PHANTOM Desktop");
  EXPECT_EQ(first["device"]["emulated"], true);
  EXPECT_EQ(first["device"]["notes"][0], "this is an EMULATED device");
  EXPECT_EQ(AssembleWith("emulated:openhaptics:touch_x")["digest"], first["digest"]);
  const json alone = RunHvasJson({"assemble", ProductFile("bushing"), "-q"});
  EXPECT_FALSE(alone.contains("device"));
  EXPECT_NE(alone["digest"], first["digest"]);
}

TEST(AssembleWithDevice, DeviceWithoutForcesSeatsAllParts) {
  const json run = AssembleWith("emulated:spacemouse");
  EXPECT_EQ(run["seated"], 3);
  EXPECT_EQ(run["device"]["emulated"], true);
}

TEST(AssembleWithDevice, TableSaysThatItWasEmulated) {
  const Ran ran = RunHvas(
      {"assemble", ProductFile("bushing"), "-q", "--device", "emulated:openhaptics:touch_x"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_PRED_FORMAT2(::testing::IsSubstring,
                      "in the hand: EMULATED PHANTOM Desktop (emulated:openhaptics:touch_x)\n",
                      ran.out);
}

TEST(AssembleWithTwoDevices, BothHandsWorkAndTheRecordHasBoth) {
  const TemporaryFolder folder;
  const std::string file = (folder / "session").string();
  const auto assemble = [](std::vector<std::string> more) {
    std::vector<std::string> arguments{
        "assemble",        ProductFile("bushing"), "-q", "--device", "emulated:openhaptics:touch_x",
        "--second-device", "emulated:haply"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunHvasJson(arguments);
  };
  const json run = assemble({"--record", file});
  EXPECT_EQ(run["seated"], 3);
  EXPECT_EQ(run["hands"], 2);
  EXPECT_EQ(run["parts"][1]["hand"], 0);
  EXPECT_EQ(run["parts"][2]["hand"], 1);
  EXPECT_EQ(run["device"]["profile"], "touch_x");
  EXPECT_EQ(run["second_device"]["profile"], "inverse3");
  EXPECT_EQ(run["second_device"]["address"], "emulated:haply");
  EXPECT_EQ(run["second_device"]["notes"][0], "this is an EMULATED device");
  EXPECT_EQ(assemble({})["digest"], run["digest"]);

  auto reader = record::Reader::Open(file);
  ASSERT_TRUE(reader.has_value()) << reader.error().ToString();
  EXPECT_EQ(reader->Verify().value_or(""), run["digest"]);
  EXPECT_EQ(reader->meta().at("second_device"), "emulated:haply");
  EXPECT_EQ(reader->tick_count(), 2 * run["ticks"].get<int>());
  std::array<int, 2> with_part{};
  (void)reader->ForEachTick({}, [&](const record::TickRecord& tick) {
    with_part.at(tick.hand) += tick.held != record::kNoOccurrence ? 1 : 0;
    return true;
  });
  EXPECT_GT(with_part[0], 1000);
  EXPECT_GT(with_part[1], 1000);
  std::array<int, 2> taken{};
  const auto events = reader->ReadEvents();
  ASSERT_TRUE(events.has_value());
  for (const record::Event& event : *events) {
    if (event.kind == "taken") {
      ++taken.at(json::parse(event.json).at("hand"));
    }
  }
  EXPECT_EQ(taken, (std::array<int, 2>{1, 1}));
}

TEST(AssembleWithTwoDevices, TableSaysWhatWasInWhichHand) {
  const Ran ran =
      RunHvas({"assemble", ProductFile("bushing"), "-q", "--device", "emulated:openhaptics",
               "--second-device", "emulated:openhaptics:touch", "--limit", "0.1"});
  EXPECT_EQ(ran.status, 2) << ran.err;
  EXPECT_PRED_FORMAT2(
      ::testing::IsSubstring,
      "in the first hand: EMULATED PHANTOM Omni (emulated:openhaptics); parts put in", ran.out);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "\nin the second hand: EMULATED", ran.out);
}

void ExpectRefused(const std::vector<std::string>& options, const std::string& error,
                   int status = 1) {
  std::vector<std::string> arguments{"assemble", ProductFile("bushing"), "-q"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Ran ran = RunHvas(arguments);
  EXPECT_EQ(ran.status, status);
  EXPECT_EQ(ran.out, "");
  EXPECT_EQ(ran.err, error);
}

TEST(AssembleWithDevice, WhatCannotBeOpenedIsNamedWithTheRemedy) {
  const std::string drivers =
      "(one of: openhaptics, forcedimension, virtuose, haply, spacemouse, gamepad, network, "
      "plugin)\n";
  ExpectRefused({"--device", "phantom"},
                "hvas: phantom: there is no driver \"phantom\" " + drivers);
  ExpectRefused({"--device", "emulated:phantom:touch"},
                "hvas: there is no emulator for \"phantom\" " + drivers);
  ExpectRefused({"--device", "emulated:openhaptics:sigma7"},
                "hvas: openhaptics:sigma7: openhaptics has no device profile \"sigma7\" (one of: "
                "omni, premium15, premium30, touch, touch_x)\n");
  ExpectRefused(
      {"--device", "openhaptics"},
      "hvas: openhaptics: a real device needs the real-time loop (add --realtime, or leave out "
      "--clock)\n");
  ExpectRefused({"--device", "emulated:haply", "--second-device", "haply"},
                "hvas: haply: a real device needs the real-time loop (add --realtime, or leave out "
                "--clock)\n");
  ExpectRefused({"--second-device", "emulated:haply"},
                "hvas assemble: --second-device requires --device\n"
                "Run hvas assemble --help for the commands and options.\n",
                64);
}

TEST(AssembleWithDevice, LibraryThatIsMissingIsNamedWithTheRemedy) {
  const Ran ran =
      RunHvas({"assemble", ProductFile("bushing"), "-q", "--device", "virtuose", "--realtime"});
  EXPECT_EQ(ran.status, 1);
  EXPECT_EQ(ran.out, "");
  EXPECT_PRED_FORMAT2(::testing::IsSubstring,
                      "the library of Haption Virtuose (VirtuoseAPI 4) (virtuoseAPI.so) is not "
                      "installed",
                      ran.err);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "install VirtuoseAPI 4 of Haption", ran.err);
}

}  // namespace
}  // namespace hvas::app
