// What devices say of themselves, whoever made their drivers: nothing impossible comes in (N8).
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/random.h"
#include "device/driver.h"
#include "device/emulation/emulator.h"

namespace hvas::device {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kEndless = std::numeric_limits<double>::infinity();

/** A figure of a profile by its key. */
struct Claim {
  std::string key;
  double* (*find)(DeviceProfile* profile);
};

template <double DeviceProfile::*kMember>
double* Find(DeviceProfile* profile) {
  return &(profile->*kMember);
}

template <int kEdge>
double* FindEdge(DeviceProfile* profile) {
  return &profile->workspace[kEdge];
}

const std::vector<Claim>& Claims() {
  static const std::vector<Claim> claims{
      {"max_force_n", Find<&DeviceProfile::max_force>},
      {"continuous_force_n", Find<&DeviceProfile::continuous_force>},
      {"max_torque_nm", Find<&DeviceProfile::max_torque>},
      {"continuous_torque_nm", Find<&DeviceProfile::continuous_torque>},
      {"max_stiffness_n_per_m", Find<&DeviceProfile::max_stiffness>},
      {"max_damping_ns_per_m", Find<&DeviceProfile::max_damping>},
      {"max_rotational_stiffness_nm_per_rad", Find<&DeviceProfile::max_rotational_stiffness>},
      {"max_rotational_damping_nms_per_rad", Find<&DeviceProfile::max_rotational_damping>},
      {"position_resolution_m", Find<&DeviceProfile::position_resolution>},
      {"rotation_resolution_rad", Find<&DeviceProfile::rotation_resolution>},
      {"rate_hz", Find<&DeviceProfile::rate_hz>},
      {"delay_s", Find<&DeviceProfile::delay>},
      {"workspace_m", FindEdge<0>},
      {"workspace_m", FindEdge<1>},
      {"workspace_m", FindEdge<2>},
      {"mass_kg", Find<&DeviceProfile::mass>},
      {"inertia_kg_m2", Find<&DeviceProfile::inertia>},
      {"damping_ns_per_m", Find<&DeviceProfile::damping>},
      {"rotational_damping_nms_per_rad", Find<&DeviceProfile::rotational_damping>},
      {"friction_n", Find<&DeviceProfile::friction>},
      {"rotational_friction_nm", Find<&DeviceProfile::rotational_friction>},
  };
  return claims;
}

/** Claims that a device can make in all drivers' interfaces: figures of its mechanism are not asked
 for. */
constexpr std::size_t kToldClaims = 15;

constexpr std::array kAbsurd{kNoNumber, kEndless, -kEndless, -1.0, -1e300, 1e300, 1e9, 1e-300};

/** A device that says of itself what the test wants. */
class ClaimingDevice final : public Device {
 public:
  explicit ClaimingDevice(DeviceInfo info) : info_(std::move(info)) {}

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }

  [[nodiscard]] DeviceState Read() noexcept override { return {}; }

  void Write(const spatial::Wrench&) noexcept override {}

 private:
  DeviceInfo info_;
};

/** A driver that passes on what its devices say, as one would that somebody adds. */
class CredulousDriver final : public Driver {
 public:
  CredulousDriver() : Driver({"credulous", "Credulous", ""}) {
    info.driver = "credulous";
    info.model = "Arm 7";
    info.capabilities.force_axes = 3;
  }

  DeviceInfo info;

 protected:
  [[nodiscard]] ProbeReport ProbeUnchecked(const Surroundings&, bool) const override {
    ProbeReport report = BeginReport();
    report.devices = {info};
    return report;
  }

  [[nodiscard]] Result<std::unique_ptr<Device>> OpenUnchecked(const std::string&,
                                                              const Surroundings&) const override {
    return std::make_unique<ClaimingDevice>(info);
  }
};

/** Expects that neither opening nor probing lets the device in, and that both say why. */
void ExpectRefused(const CredulousDriver& driver, const std::string& key,
                   const std::string& value) {
  SCOPED_TRACE(key + " " + value);
  const auto device = driver.Open("", {});
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().code, ErrorCode::kInvalid);
  const ProbeReport report = driver.Probe({}, true);
  EXPECT_TRUE(report.devices.empty());
  ASSERT_EQ(report.problems.size(), 1u);
  for (const Error& error : {device.error(), report.problems.front()}) {
    EXPECT_NE(error.where.find("credulous"), std::string::npos) << error.where;
    EXPECT_NE(error.message.find("\"" + key + "\""), std::string::npos) << error.message;
    EXPECT_NE(error.message.find(value), std::string::npos) << error.message;
    EXPECT_NE(error.message.find("must be"), std::string::npos) << error.message;
    EXPECT_FALSE(error.remedy.empty());
  }
}

TEST(DeviceClaimsTest, EveryImpossibleFigureIsRefusedByName) {
  for (const Claim& claim : Claims()) {
    for (const double value : kAbsurd) {
      CredulousDriver driver;
      *claim.find(&driver.info.profile) = value;
      ExpectRefused(driver, claim.key, fmt::format("{}", value));
    }
  }
  for (const char* key : {"rate_hz", "workspace_m", "mass_kg", "inertia_kg_m2"}) {
    for (const Claim& claim : Claims()) {
      if (claim.key == key) {
        CredulousDriver driver;
        *claim.find(&driver.info.profile) = 0;
        ExpectRefused(driver, key, "0");
      }
    }
  }
}

TEST(DeviceClaimsTest, ImpossibleAxesAndButtonsAreRefusedByName) {
  for (const int value : {-1, 1, 2, 4, std::numeric_limits<int>::max()}) {
    CredulousDriver driver;
    driver.info.capabilities.force_axes = value;
    ExpectRefused(driver, "force_axes", std::to_string(value));
    CredulousDriver other;
    other.info.capabilities.torque_axes = value;
    ExpectRefused(other, "torque_axes", std::to_string(value));
  }
  for (const int value : {-1, 33, std::numeric_limits<int>::min()}) {
    CredulousDriver driver;
    driver.info.capabilities.button_count = value;
    ExpectRefused(driver, "button_count", std::to_string(value));
  }
}

// A name ends in JSON, in a record and at a terminal.
TEST(DeviceClaimsTest, TextsThatAreNoTextAreRefused) {
  const std::vector<std::string> bad{
      "\x1b[2J",  "a\nb",     std::string("a\0b", 3), "\xff\xfe",
      "\xc3",     "\xc0\xaf", "\xed\xa0\x80",         "\xf4\x90\x80\x80",
      "\xc2\x9b", "\x7f",     std::string(300, 'x')};
  using Text = std::string& (*)(DeviceInfo*);
  const std::vector<std::pair<const char*, Text>> texts{
      {"model", [](DeviceInfo* info) -> std::string& { return info->model; }},
      {"serial", [](DeviceInfo* info) -> std::string& { return info->serial; }},
      {"version", [](DeviceInfo* info) -> std::string& { return info->version; }},
      {"name", [](DeviceInfo* info) -> std::string& { return info->profile.name; }}};
  for (const auto& [key, text] : texts) {
    for (const std::string& value : bad) {
      CredulousDriver driver;
      text(&driver.info) = value;
      ExpectRefused(driver, key, "UTF-8");
      const auto device = driver.Open("", {});
      const std::string error = device.error().ToString();
      EXPECT_EQ(error.find('\x1b'), std::string::npos);
      EXPECT_EQ(error.find('\xff'), std::string::npos);
    }
    CredulousDriver driver;
    text(&driver.info) = "Größe 7 – 触覚 🖐";
    EXPECT_TRUE(driver.Open("", {})) << key;
  }
}

TEST(DeviceClaimsTest, ContinuousLimitAboveItsPeakIsRefused) {
  CredulousDriver driver;
  driver.info.profile.continuous_force = 2 * driver.info.profile.max_force;
  EXPECT_NE(driver.Open("", {}).error().message.find("above its peak"), std::string::npos);
  CredulousDriver other;
  other.info.profile.continuous_torque = 2 * other.info.profile.max_torque;
  EXPECT_NE(other.Open("", {}).error().message.find("above its peak"), std::string::npos);
}

TEST(DeviceClaimsTest, EveryKnownDeviceIsPossible) {
  for (const SourcedProfile& known : KnownProfiles()) {
    const auto checked = CheckProfile(known.profile, known.profile.id);
    EXPECT_TRUE(checked) << checked.error().ToString();
  }
  EXPECT_TRUE(CheckProfile(DeviceProfile(), "the simulated device"));
}

/** Opens the emulated device of a driver that claims something.
 @returns whether it was refused; what came in can be. */
bool IsRefused(const std::string& driver, const Claim& claim, double value) {
  EmulatorOptions options;
  const SourcedProfile* known = FindProfileOfDriver(driver);
  const bool has_model = known != nullptr && driver != "network";  // else one that has torques
  options.profile = has_model ? known->profile : FindProfile("sigma7")->profile;
  options.claim = options.profile;
  *claim.find(&*options.claim) = value;
  const auto emulator = StartEmulator(driver, options);
  EXPECT_TRUE(emulator) << emulator.error().ToString();
  const auto device = OpenDevice((*emulator)->address(), (*emulator)->surroundings());
  if (!device) {
    EXPECT_EQ(device.error().code, ErrorCode::kInvalid) << device.error().ToString();
    EXPECT_NE(device.error().where.find(driver), std::string::npos) << device.error().ToString();
    // A peak below the continuous limit is as impossible as a limit above the peak.
    const bool is_named = device.error().message.find(claim.key) != std::string::npos ||
                          device.error().message.find("above its peak") != std::string::npos;
    EXPECT_TRUE(is_named) << device.error().message;
    return true;
  }
  EXPECT_TRUE(CheckInfo((*device)->info()));
  return false;
}

class DriverClaimsTest : public ::testing::TestWithParam<std::string> {};

// Each driver's own interface, from the device's end: the vendor's library, the wire, the plug-in.
TEST_P(DriverClaimsTest, NothingImpossibleComesIn) {
  const bool tells_all = GetParam() == "plugin" || GetParam() == "network";
  std::size_t refused = 0;
  for (std::size_t i = 0; i < kToldClaims; ++i) {
    const Claim& claim = Claims()[i];
    for (const double value : {kNoNumber, -1.0, 1e300}) {
      SCOPED_TRACE(claim.key + fmt::format(" {}", value));
      const bool is_refused = IsRefused(GetParam(), claim, value);
      refused += is_refused ? 1 : 0;
      // A device without force has no peak that could be wrong.
      const bool has_axes = value > 0 || !claim.key.starts_with("max_");
      EXPECT_TRUE(is_refused || !tells_all || !has_axes);
    }
  }
  const bool tells_some =
      tells_all || GetParam() == "openhaptics" || GetParam() == "forcedimension";
  EXPECT_EQ(refused > 0, tells_some);
}

INSTANTIATE_TEST_SUITE_P(Drivers, DriverClaimsTest, ::testing::ValuesIn(EmulatedDrivers()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace hvas::device
