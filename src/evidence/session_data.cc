#include "evidence/session_data.h"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/parse_json.h"
#include "haptics/constraint_solver.h"
#include "session/json_values.h"

namespace hvas::evidence {
namespace {

using record::TickRecord;
using T = const TickRecord&;

constexpr std::array kColumns{
    Column{"time_s", "s", "session time", [](T t) { return 1e-9 * static_cast<double>(t.t_ns); }},
    Column{"hand", "1", "index of the hand", [](T t) { return static_cast<double>(t.hand); }},
    Column{
        "occurrence", "1", "id of the part in the hand; -1: none",
        [](T t) { return t.held == record::kNoOccurrence ? -1.0 : static_cast<double>(t.held); }},
    Column{"state", "1", "0 empty, 1 free, 2 near, 3 captured, 4 mating, 5 seated",
           [](T t) { return static_cast<double>(t.state); }},
    Column{"hand_x_m", "m", "pose of the hand, or the tracked part, in the world",
           [](T t) { return t.X_WH.p().x(); }},
    Column{"hand_y_m", "m", "likewise", [](T t) { return t.X_WH.p().y(); }},
    Column{"hand_z_m", "m", "likewise", [](T t) { return t.X_WH.p().z(); }},
    Column{"hand_qw", "1", "its rotation, a unit quaternion", [](T t) { return t.X_WH.q().w(); }},
    Column{"hand_qx", "1", "likewise", [](T t) { return t.X_WH.q().x(); }},
    Column{"hand_qy", "1", "likewise", [](T t) { return t.X_WH.q().y(); }},
    Column{"hand_qz", "1", "likewise", [](T t) { return t.X_WH.q().z(); }},
    Column{"shown_x_m", "m", "displayed pose of the part, or of the pointer",
           [](T t) { return t.X_WD.p().x(); }},
    Column{"shown_y_m", "m", "likewise", [](T t) { return t.X_WD.p().y(); }},
    Column{"shown_z_m", "m", "likewise", [](T t) { return t.X_WD.p().z(); }},
    Column{"shown_qw", "1", "its rotation", [](T t) { return t.X_WD.q().w(); }},
    Column{"shown_qx", "1", "likewise", [](T t) { return t.X_WD.q().x(); }},
    Column{"shown_qy", "1", "likewise", [](T t) { return t.X_WD.q().y(); }},
    Column{"shown_qz", "1", "likewise", [](T t) { return t.X_WD.q().z(); }},
    Column{"true_fx_n", "N", "true force, in the world", [](T t) { return t.F_true_W.f.x(); }},
    Column{"true_fy_n", "N", "likewise", [](T t) { return t.F_true_W.f.y(); }},
    Column{"true_fz_n", "N", "likewise", [](T t) { return t.F_true_W.f.z(); }},
    Column{"true_tx_nm", "N m", "torque about the displayed part's centre of mass",
           [](T t) { return t.F_true_W.t.x(); }},
    Column{"true_ty_nm", "N m", "likewise", [](T t) { return t.F_true_W.t.y(); }},
    Column{"true_tz_nm", "N m", "likewise", [](T t) { return t.F_true_W.t.z(); }},
    Column{"felt_fx_n", "N", "force rendered to the hand, in the world",
           [](T t) { return t.F_felt_W.f.x(); }},
    Column{"felt_fy_n", "N", "likewise", [](T t) { return t.F_felt_W.f.y(); }},
    Column{"felt_fz_n", "N", "likewise", [](T t) { return t.F_felt_W.f.z(); }},
    Column{"felt_tx_nm", "N m", "torque rendered to the hand, about its point",
           [](T t) { return t.F_felt_W.t.x(); }},
    Column{"felt_ty_nm", "N m", "likewise", [](T t) { return t.F_felt_W.t.y(); }},
    Column{"felt_tz_nm", "N m", "likewise", [](T t) { return t.F_felt_W.t.z(); }},
    Column{"insertion_m", "m", "depth of insertion, positive inwards", [](T t) { return t.depth; }},
    Column{"gap_m", "m", "smallest gap, negative for penetration; infinite: no contact near",
           [](T t) { return t.deepest; }},
    Column{"contacts", "1", "number of contacts with force",
           [](T t) { return static_cast<double>(t.contact_count); }},
    Column{"status", "1", "bit mask of the safety gate's actions (docs/record.md)",
           [](T t) { return static_cast<double>(t.status); }},
    Column{"device_x_m", "m", "pose of the handle in the device's base",
           [](T t) { return t.device_pose.p().x(); }},
    Column{"device_y_m", "m", "likewise", [](T t) { return t.device_pose.p().y(); }},
    Column{"device_z_m", "m", "likewise", [](T t) { return t.device_pose.p().z(); }},
    Column{"device_qw", "1", "its rotation", [](T t) { return t.device_pose.q().w(); }},
    Column{"device_qx", "1", "likewise", [](T t) { return t.device_pose.q().x(); }},
    Column{"device_qy", "1", "likewise", [](T t) { return t.device_pose.q().y(); }},
    Column{"device_qz", "1", "likewise", [](T t) { return t.device_pose.q().z(); }},
    Column{"device_vx_m_per_s", "m/s", "its velocity", [](T t) { return t.device_twist.v.x(); }},
    Column{"device_vy_m_per_s", "m/s", "likewise", [](T t) { return t.device_twist.v.y(); }},
    Column{"device_vz_m_per_s", "m/s", "likewise", [](T t) { return t.device_twist.v.z(); }},
    Column{"device_flags", "1", "1 gripping, 2 clutching, 4 no valid pose",
           [](T t) { return static_cast<double>(t.device_flags); }},
    Column{"device_condition", "1", "0: ready",
           [](T t) { return static_cast<double>(t.device_condition); }},
    Column{"model_age_s", "s", "time since the last update by the physics loop",
           [](T t) { return 1e-9 * static_cast<double>(t.model_age_ns); }},
    Column{"effort_level", "1", "level of load shedding in the tick; 0: none",
           [](T t) { return static_cast<double>(t.effort_level); }},
};

}  // namespace

std::size_t HandOf(const TickRecord& tick) {
  return std::min<std::size_t>(tick.hand, haptics::kMaxHands - 1);
}

std::span<const Column> TickColumns() {
  return kColumns;
}

Result<void> ForEachSelected(record::Reader* reader, const Selection& selection,
                             const std::function<void(const record::TickRecord&)>& visit) {
  std::array<std::int64_t, std::numeric_limits<std::uint8_t>::max() + 1> counts{};  // by hand
  return reader->ForEachTick(selection.span, [&](const TickRecord& tick) {
    if (counts[tick.hand]++ % selection.every == 0) {
      visit(tick);
    }
    return true;
  });
}

std::vector<std::string> ReadPaths(const record::Reader& reader) {
  std::vector<std::string> paths;
  const auto found = reader.meta().find("model_json");
  if (found == reader.meta().end()) {
    return paths;
  }
  const auto parts = ParseJson<nlohmann::json>(found->second);
  for (const auto& part : parts) {
    paths.push_back(session::TextOr(part, "path", ""));
  }
  return paths;
}

std::string NameOf(const std::vector<std::string>& paths, std::uint32_t occurrence) {
  return occurrence < paths.size() && !paths[occurrence].empty() ? paths[occurrence]
                                                                 : fmt::format("o{}", occurrence);
}

}  // namespace hvas::evidence
