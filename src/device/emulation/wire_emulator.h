#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "device/emulation/emulator.h"

namespace hvas::device {

/** The far side of a wire: what a vendor's service, the kernel or a plug-in would be. One thread at
 a time calls it. */
class WireServer {
 public:
  WireServer() = default;
  WireServer(const WireServer&) = delete;
  WireServer& operator=(const WireServer&) = delete;
  virtual ~WireServer() = default;

  /** "DRIVER:ADDRESS" */
  [[nodiscard]] virtual std::string address() const = 0;

  /** Answers all that has arrived since the last time, and returns without waiting. */
  virtual void Serve() = 0;

  /** The device has moved on by so much: sends what it sends by itself. */
  virtual void Emit(std::int64_t step_ns) = 0;
};

/** Where a server lives. */
struct WireSite {
  EmulatedDevice* device;
  std::filesystem::path root;  ///< An empty folder of its own, the driver's Surroundings.root.
  spatial::Pose X_DH;          ///< First pose of the handle.
};

/** Starts an emulator of "haply", "spacemouse", "gamepad", "network" or "plugin". In virtual time
 Advance first answers what was sent before it, then moves the physics, then sends; faults are best
 set between Advance and Read, so that runs repeat exactly. A thread answers whoever connects, since
 Driver::Open waits for that.
 Errors: kNotFound for another driver; kOutOfResource where a socket or a folder cannot be made. */
Result<std::unique_ptr<Emulator>> StartWireEmulator(std::string_view driver,
                                                    const EmulatorOptions& options);

/** Runs any server as an emulator. */
using MakeWireServer = Result<std::unique_ptr<WireServer>> (*)(const WireSite& site);
Result<std::unique_ptr<Emulator>> StartWireEmulator(MakeWireServer make,
                                                    const EmulatorOptions& options);

}  // namespace hvas::device
