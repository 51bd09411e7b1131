#include "record/session_digest.h"

namespace hvas::record {
namespace {

std::uint64_t ChecksumOf(const SessionDigest& one) {
  const std::string hex = one.Hex();
  return Checksum64(std::as_bytes(std::span(hex)));
}

}  // namespace

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

void SessionDigest::AddCommand(const Command& command) {
  commands_.AddInt(command.t_ns);
  commands_.AddInt(command.number);
  commands_.AddText(command.kind);
  commands_.AddText(command.json);
  ++command_count_;
}

std::string SessionDigest::Hex() const {
  Digest all;
  all.AddInt(tick_count_);
  all.AddText(ticks_.Hex());
  all.AddInt(event_count_);
  all.AddText(events_.Hex());
  if (command_count_ > 0) {  // those of older schemas have none
    all.AddInt(command_count_);
    all.AddText(commands_.Hex());
  }
  return all.Hex();
}

std::uint64_t CalcChecksum(const Event& event) {
  SessionDigest one;
  one.AddEvent(event);
  return ChecksumOf(one);
}

std::uint64_t CalcChecksum(const Command& command) {
  SessionDigest one;
  one.AddCommand(command);
  return ChecksumOf(one);
}

}  // namespace hvas::record
