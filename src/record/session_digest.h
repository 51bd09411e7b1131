#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "base/digest.h"
#include "record/tick_record.h"

namespace hvas::record {

/** Fingerprint of a session: of its ticks, its events and its commands, each in order, however they
 were interleaved. Equal inputs to two sessions give equal digests, live or read back from a file.
 What was shown, and what goes with the record, is not in it. */
class SessionDigest {
 public:
  void AddTick(std::span<const std::byte> packed_tick);
  void AddEvent(const Event& event);
  void AddCommand(const Command& command);

  [[nodiscard]] std::int64_t tick_count() const { return tick_count_; }

  [[nodiscard]] std::int64_t event_count() const { return event_count_; }

  [[nodiscard]] std::string Hex() const;

 private:
  Digest ticks_;
  Digest events_;
  Digest commands_;
  std::int64_t tick_count_{0};
  std::int64_t event_count_{0};
  std::int64_t command_count_{0};
};

/** Checksum of one event's or command's content, as stored beside it. */
[[nodiscard]] std::uint64_t CalcChecksum(const Event& event);
[[nodiscard]] std::uint64_t CalcChecksum(const Command& command);

}  // namespace hvas::record
