#include "haptics/write_pace.h"

#include "haptics/safety_gate.h"

namespace hvas::haptics {

std::int64_t WritePace::CalcGap(std::int64_t now_ns) const noexcept {
  return has_written_ ? now_ns - written_ns_ : 0;
}

std::int64_t WritePace::Begin(std::int64_t now_ns) noexcept {
  begun_ns_ = now_ns;
  const std::int64_t gap_ns = has_withheld_ ? kUnknownNs : CalcGap(now_ns);
  starts_anew_ = SafetyGate::IsStall(gap_ns);
  return gap_ns;
}

spatial::Wrench WritePace::Admit(const spatial::Wrench& F_H_D, std::int64_t now_ns) noexcept {
  has_withheld_ = SafetyGate::IsStall(now_ns - begun_ns_) ||
                  (!starts_anew_ && SafetyGate::IsStall(CalcGap(now_ns)));
  has_written_ = true;
  written_ns_ = now_ns;
  return has_withheld_ ? spatial::Wrench() : F_H_D;
}

}  // namespace hvas::haptics
