#include "simulation/tool_mates.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/units.h"

namespace hvas::simulation {
namespace {

using product::DriveForm;
using product::DriveKind;

constexpr double kCircle = units::kTurn;  // [rad]: a full turn.
constexpr double kSeated = 0.9;  // Share of the depth that is engaged: a bit does not rest on the
                                 // bottom, a ring not on the flange. A choice.

double CalcPitch(DriveKind kind) {
  switch (kind) {
    case DriveKind::kHexagon:
      return kCircle / 6;
    case DriveKind::kCross:
      return kCircle / 4;
    case DriveKind::kSlot:
      break;
  }
  return kCircle / 2;
}

}  // namespace

std::optional<double> CalcDrivePlay(const DriveForm& recess, const DriveForm& bit) {
  constexpr double kRounding = 1e-6;  // Share of the width by which drawn sizes err.
  const double S = recess.width;
  const double s = bit.width;
  if (recess.kind != bit.kind || !recess.is_recess || bit.is_recess || s > S * (1 + kRounding)) {
    return std::nullopt;
  }
  if (recess.kind == DriveKind::kHexagon) {
    // A corner of the bit, s/sqrt(3) from the axis and 30 degrees from the flat's normal, meets the
    // flat at S/2.
    const double cosine = std::max(S / s, 1.0) * 0.5 * std::numbers::sqrt3;
    if (cosine >= 1) {
      return std::nullopt;
    }
    return 2 * (kCircle / 12 - std::acos(cosine));
  }
  // The corner (L/2, s/2) of a blade of length L turns until it is S/2 from the middle.
  const double L = std::min(recess.span, bit.span);
  const double corner = 0.5 * std::hypot(L, s);
  if (L <= 0 || corner <= 0.5 * S) {
    return std::nullopt;
  }
  return 2 * std::max(0.0, std::asin(0.5 * S / corner) - std::atan2(s, L));
}

std::optional<ToolMate> MakeToolMate(const DriveForm& fastener, const DriveForm& tool) {
  const auto play =
      fastener.is_recess ? CalcDrivePlay(fastener, tool) : CalcDrivePlay(tool, fastener);
  if (!play) {
    return std::nullopt;
  }
  return ToolMate{fastener, tool, kSeated * std::min(fastener.depth, tool.depth), *play,
                  CalcPitch(fastener.kind)};
}

std::vector<ToolMate> ListToolMates(const std::vector<DriveForm>& fastener,
                                    const std::vector<DriveForm>& tool) {
  std::vector<ToolMate> mates;
  for (const DriveForm& on : fastener) {
    for (const DriveForm& of : tool) {
      if (auto mate = MakeToolMate(on, of)) {
        mates.push_back(std::move(*mate));
      }
    }
  }
  return mates;
}

double FindLead(const product::Part& fastener) {
  double lead = 0;
  for (const product::Feature& feature : fastener.features) {
    lead = feature.thread != product::ThreadKind::kNone ? feature.thread_pitch : lead;
  }
  return lead;
}

}  // namespace hvas::simulation
