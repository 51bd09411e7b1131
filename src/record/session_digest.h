#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "base/digest.h"
#include "record/tick_record.h"

namespace hvas::record {

/** Fingerprint of a session: of its ticks in order and of its events in order, however the two were
 interleaved. Equal inputs to two sessions give equal digests, live or read back from a file. */
class SessionDigest {
 public:
  void AddTick(std::span<const std::byte> packed_tick);
  void AddEvent(const Event& event);

  [[nodiscard]] std::int64_t tick_count() const { return tick_count_; }

  [[nodiscard]] std::int64_t event_count() const { return event_count_; }

  [[nodiscard]] std::string Hex() const;

 private:
  Digest ticks_;
  Digest events_;
  std::int64_t tick_count_{0};
  std::int64_t event_count_{0};
};

/** Checksum of one event's content, as stored beside it. */
[[nodiscard]] std::uint64_t CalcChecksum(const Event& event);

}  // namespace hvas::record
