#include "record/session_digest.h"

namespace hvas::record {

void SessionDigest::AddTick(std::span<const std::byte> packed_tick) {
  ticks_.AddBytes(packed_tick);
  ++tick_count_;
}

void SessionDigest::AddEvent(const Event& event) {
  events_.AddInt(event.t_ns);
  events_.AddText(event.kind);
  events_.AddInt(event.occurrence);
  events_.AddText(event.json);
  ++event_count_;
}

std::string SessionDigest::Hex() const {
  Digest both;
  both.AddInt(tick_count_);
  both.AddText(ticks_.Hex());
  both.AddInt(event_count_);
  both.AddText(events_.Hex());
  return both.Hex();
}

std::uint64_t CalcChecksum(const Event& event) {
  SessionDigest one;
  one.AddEvent(event);
  const std::string hex = one.Hex();
  return Checksum64(std::as_bytes(std::span(hex)));
}

}  // namespace hvas::record
