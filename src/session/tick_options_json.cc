#include "session/tick_options_json.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace hvas::session {
namespace {

constexpr std::array kConditions{"collision", "constraint", "hybrid"};
constexpr std::array kForceMaps{"published", "paper"};

/** Puts fields into an object. */
class JsonMaker {
 public:
  explicit JsonMaker(Json* object) : object_(object) {}

  template <typename T>
  void operator()(const char* name, const T& value) {
    (*object_)[name] = MakeJson(value);
  }

  void operator()(const char* name, const bool& value) { (*object_)[name] = value; }

  void operator()(const char* name, const std::string& value) { (*object_)[name] = value; }

  template <typename E, std::size_t N>
  void operator()(const char* name, const E& value, const std::array<const char*, N>& names) {
    (*object_)[name] = names.at(static_cast<std::size_t>(value));
  }

  [[nodiscard]] JsonMaker Inner(const char* name) {
    return JsonMaker(&((*object_)[name] = Json::object()));
  }

  void Take(const JsonMaker& /*inner*/) {}

 private:
  Json* object_;
};

/** Finds the first field that no tick can work with. */
class UnsoundField {
 public:
  void operator()(const char* name, const double& value) { NoteUnless(!std::isnan(value), name); }

  void operator()(const char* name, const Vec3& value) { NoteUnless(!value.hasNaN(), name); }

  void operator()(const char* name, const Quat& value) {
    NoteUnless(value.coeffs().allFinite(), name);
  }

  void operator()(const char* /*name*/, const spatial::Pose& /*value*/) {}

  void operator()(const char* /*name*/, const bool& /*value*/) {}

  void operator()(const char* /*name*/, const std::string& /*value*/) {}

  template <typename E, std::size_t N>
  void operator()(const char* /*name*/, const E& /*value*/,
                  const std::array<const char*, N>& /*names*/) {}

  [[nodiscard]] UnsoundField Inner(const char* name) const {
    UnsoundField inner;
    inner.path_ = path_ + name + ".";
    return inner;
  }

  void Take(const UnsoundField& inner) { found_ = found_.empty() ? inner.found_ : found_; }

  /** Empty: there is none. */
  [[nodiscard]] const std::string& found() const { return found_; }

 private:
  void NoteUnless(bool is_sound, const char* name) {
    if (!is_sound && found_.empty()) {
      found_ = path_ + name;
    }
  }

  std::string path_;
  std::string found_;
};

/** Visits all fields of each kind of options. Every struct is taken apart into all of its members:
 one that is added there does not compile here until it is written, too. */
struct AllFields {
  template <typename F>
  static void Visit(F& f, haptics::WorkspaceMapping& value) {
    auto& [X_WD, scale, q_index] = value;
    f("X_WD", X_WD);
    f("scale", scale);
    f("q_index", q_index);
  }

  template <typename F, typename T>
  static void VisitInner(F& f, const char* name, T& value) {
    F inner = f.Inner(name);
    Visit(inner, value);
    f.Take(inner);
  }

  template <typename F>
  static void Visit(F& f, haptics::WorkspaceOptions& value) {
    auto& [mapping, box, border_speed, border_force, border_share] = value;
    VisitInner(f, "mapping", mapping);
    f("box_m", box);
    f("border_speed_m_per_s", border_speed);
    f("border_force_n", border_force);
    f("border_share", border_share);
  }

  template <typename F>
  static void Visit(F& f, haptics::CouplingGains& value) {
    auto& [k_lin, b_lin, k_rot, b_rot] = value;
    f("k_lin_n_per_m", k_lin);
    f("b_lin_ns_per_m", b_lin);
    f("k_rot_nm_per_rad", k_rot);
    f("b_rot_nms_per_rad", b_rot);
  }

  template <typename F>
  static void Visit(F& f, mates::CaptureThresholds& value) {
    auto& [angle, axis_distance, axial_gap, face_distance, in_plane_gap, release_ratio] = value;
    f("angle_rad", angle);
    f("axis_distance_m", axis_distance);
    f("axial_gap_m", axial_gap);
    f("face_distance_m", face_distance);
    f("in_plane_gap_m", in_plane_gap);
    f("release_ratio", release_ratio);
  }

  template <typename F>
  static void Visit(F& f, haptics::GuidanceOptions& value) {
    auto& [capture, ramp_time, k_lin, k_rot, max_force, max_torque, attraction_force,
           attraction_torque, seat_distance, seat_angle, match_distance, seat_time, finish_distance,
           contact_in_holes, threads_turn, attracts_in_fits, captures_on_straight_end] = value;
    VisitInner(f, "capture", capture);
    f("ramp_time_s", ramp_time);
    f("k_lin_n_per_m", k_lin);
    f("k_rot_nm_per_rad", k_rot);
    f("max_force_n", max_force);
    f("max_torque_nm", max_torque);
    f("attraction_force_n", attraction_force);
    f("attraction_torque_nm", attraction_torque);
    f("seat_distance_m", seat_distance);
    f("seat_angle_rad", seat_angle);
    f("loose_seat_distance_m", match_distance);  // The name in older records.
    f("seat_time_s", seat_time);
  }

  template <typename F>
  static void Visit(F& f, fits::FrictionLaw& value) {
    auto& [static_coefficient, kinetic_coefficient, stribeck_speed, viscous, stiffness] = value;
    f("static_coefficient", static_coefficient);
    f("kinetic_coefficient", kinetic_coefficient);
    f("stribeck_speed_m_per_s", stribeck_speed);
    f("viscous_s_per_m", viscous);
    f("stiffness_n_per_m", stiffness);
  }

  template <typename F>
  static void Visit(F& f, haptics::ContactOptions& value) {
    auto& [compliance, settling_time, friction, rolling_arm, recovery_speed, max_depth, edge_break,
           min_margin, max_speed, max_turn_rate, max_free_speed, rest_time, stop_depth] = value;
    f("compliance_m_per_n", compliance);
    f("settling_time_s", settling_time);
    VisitInner(f, "friction", friction);
    f("rolling_arm_m", rolling_arm);
    f("recovery_speed_m_per_s", recovery_speed);
    f("max_depth_m", max_depth);
    f("edge_break_m", edge_break);
    f("min_margin_m", min_margin);
    f("max_speed_m_per_s", max_speed);
    f("max_turn_rate_rad_per_s", max_turn_rate);
    f("max_free_speed_m_per_s", max_free_speed);
    f("rest_time_s", rest_time);
    f("stop_depth_m", stop_depth);
  }

  template <typename F>
  static void Visit(F& f, device::DeviceProfile& value) {
    auto& [id, name, max_force, continuous_force, max_torque, continuous_torque, max_stiffness,
           max_damping, max_rotational_stiffness, max_rotational_damping, position_resolution,
           rotation_resolution, q_UD, workspace, rate_hz, mass, inertia, damping,
           rotational_damping, friction, rotational_friction, delay] = value;
    f("id", id);
    f("name", name);
    f("max_force_n", max_force);
    f("continuous_force_n", continuous_force);
    f("max_torque_nm", max_torque);
    f("continuous_torque_nm", continuous_torque);
    f("max_stiffness_n_per_m", max_stiffness);
    f("max_damping_ns_per_m", max_damping);
    f("max_rotational_stiffness_nm_per_rad", max_rotational_stiffness);
    f("max_rotational_damping_nms_per_rad", max_rotational_damping);
    f("position_resolution_m", position_resolution);
    f("rotation_resolution_rad", rotation_resolution);
    f("q_UD", q_UD);
    f("workspace_m", workspace);
    f("rate_hz", rate_hz);
    f("mass_kg", mass);
    f("inertia_kg_m2", inertia);
    f("damping_ns_per_m", damping);
    f("rotational_damping_nms_per_rad", rotational_damping);
    f("friction_n", friction);
    f("rotational_friction_nm", rotational_friction);
    f("delay_s", delay);
  }

  template <typename F>
  static void Visit(F& f, haptics::KickThresholds& value) {
    auto& [resolution, mass, min_force, jerk, blow] = value;
    f("resolution_m", resolution);
    f("mass_kg", mass);
    f("min_force_n", min_force);
    f("jerk_m_per_s3", jerk);
    f("blow_m_per_s2", blow);
  }

  // Of motion along, or about, an axis: the unit of the first two is that of the field it is in.
  template <typename F>
  static void Visit(F& f, haptics::BuzzThresholds& value) {
    auto& [speed, force, window] = value;
    f("speed_si", speed);
    f("force_si", force);
    f("window_s", window);
  }

  template <typename F>
  static void Visit(F& f, haptics::SafetyLimits& value) {
    auto& [max_force, max_torque, max_force_rate, max_torque_rate, continuous_force,
           continuous_torque, thermal_time, soft_start_time, engage_force_rate, engage_torque_rate,
           cut_time, fade_speed, cut_speed, model_hold, model_fade, client_hold, client_fade,
           has_detectors, kick, buzz, turn_buzz] = value;
    f("max_force_n", max_force);
    f("max_torque_nm", max_torque);
    f("max_force_rate_n_per_s", max_force_rate);
    f("max_torque_rate_nm_per_s", max_torque_rate);
    f("continuous_force_n", continuous_force);
    f("continuous_torque_nm", continuous_torque);
    f("thermal_time_s", thermal_time);
    f("soft_start_time_s", soft_start_time);
    f("engage_force_rate_n_per_s", engage_force_rate);
    f("engage_torque_rate_nm_per_s", engage_torque_rate);
    f("cut_time_s", cut_time);
    f("fade_speed_m_per_s", fade_speed);
    f("cut_speed_m_per_s", cut_speed);
    f("model_hold_s", model_hold);
    f("model_fade_s", model_fade);
    f("client_hold_s", client_hold);
    f("client_fade_s", client_fade);
    f("has_detectors", has_detectors);
    VisitInner(f, "kick", kick);
    VisitInner(f, "buzz", buzz);
    VisitInner(f, "turn_buzz", turn_buzz);
  }

  /** All but the fields that may be missing. */
  template <typename F>
  static void Visit(F& f, haptics::TickOptions& value) {
    auto& [condition, renders_fits, workspace, coupling, guidance, contact, gravity_W,
           max_virtual_mass, force_map, paper_factors, device, limits, controls_passivity, p_HG,
           dt] = value;
    static_cast<void>(limits);
    static_cast<void>(renders_fits);
    static_cast<void>(paper_factors);
    f("condition", condition, kConditions);
    VisitInner(f, "workspace", workspace);
    VisitInner(f, "coupling", coupling);
    VisitInner(f, "guidance", guidance);
    VisitInner(f, "contact", contact);
    f("gravity_W_m_per_s2", gravity_W);
    f("max_virtual_mass_kg", max_virtual_mass);
    f("force_map", force_map, kForceMaps);
    VisitInner(f, "device", device);
    f("controls_passivity", controls_passivity);
    f("p_HG_m", p_HG);
    f("dt_s", dt);
  }
};

std::string FindUnsound(haptics::TickOptions* options) {
  constexpr double kShortestTick = 1e-5;  // [s], a hundred times 1 kHz: a choice.
  constexpr double kLongestTick = 0.1;    // [s]; slower than this nothing is felt.
  UnsoundField unsound;
  AllFields::Visit(unsound, *options);
  const bool has_period = options->dt >= kShortestTick && options->dt <= kLongestTick;
  return unsound.found().empty() && !has_period ? "dt_s" : unsound.found();
}

constexpr const char* kLimits = "limits";
constexpr const char* kRendersFits = "renders_fits";          // Only where they are not.
constexpr const char* kFinishDistance = "finish_distance_m";  // Only where parts are moved home.
constexpr const char* kAttractsInFits = "attracts_in_fits";   // Only where it does.
constexpr const char* kContactInHoles = "contact_in_holes";   // Only where it answers there.
constexpr const char* kThreadsTurn = "threads_turn";          // Only where they do.
constexpr const char* kCapturesOnStraightEnd = "captures_on_straight_end";  // Only where it is so.
constexpr const char* kPaperKOfInterference = "paper_k_r";  // Only where it is not the usual one.
constexpr const char* kPaperKOfTransition = "paper_k_s";

}  // namespace

Json MakeTickOptionsJson(const haptics::TickOptions& options) {
  haptics::TickOptions copy = options;  // visited by both ways as what may be written to
  Json json = Json::object();
  JsonMaker maker(&json);
  AllFields::Visit(maker, copy);
  if (copy.limits) {
    AllFields::VisitInner(maker, kLimits, *copy.limits);
  }
  if (!copy.renders_fits) {
    maker(kRendersFits, copy.renders_fits);
  }
  if (copy.guidance.finish_distance > 0) {
    maker(kFinishDistance, copy.guidance.finish_distance);
  }
  if (copy.guidance.attracts_in_fits) {
    maker(kAttractsInFits, copy.guidance.attracts_in_fits);
  }
  if (copy.guidance.contact_in_holes) {
    maker(kContactInHoles, copy.guidance.contact_in_holes);
  }
  if (copy.guidance.threads_turn) {
    maker(kThreadsTurn, copy.guidance.threads_turn);
  }
  if (copy.guidance.captures_on_straight_end) {
    maker(kCapturesOnStraightEnd, copy.guidance.captures_on_straight_end);
  }
  if (copy.paper_factors != haptics::PaperFactors()) {
    maker(kPaperKOfInterference, copy.paper_factors.interference);
    maker(kPaperKOfTransition, copy.paper_factors.transition);
  }
  return json;
}

Result<haptics::TickOptions> ParseTickOptions(const Json& json) {
  haptics::TickOptions options;
  JsonFields fields(json);
  AllFields::Visit(fields, options);
  if (fields.has(kLimits)) {
    AllFields::VisitInner(fields, kLimits, options.limits.emplace());
  }
  if (fields.has(kRendersFits)) {
    fields(kRendersFits, options.renders_fits);
  }
  if (fields.has(kFinishDistance)) {
    fields(kFinishDistance, options.guidance.finish_distance);
  }
  if (fields.has(kAttractsInFits)) {
    fields(kAttractsInFits, options.guidance.attracts_in_fits);
  }
  if (fields.has(kContactInHoles)) {
    fields(kContactInHoles, options.guidance.contact_in_holes);
  }
  if (fields.has(kThreadsTurn)) {
    fields(kThreadsTurn, options.guidance.threads_turn);
  }
  if (fields.has(kCapturesOnStraightEnd)) {
    fields(kCapturesOnStraightEnd, options.guidance.captures_on_straight_end);
  }
  if (fields.has(kPaperKOfInterference) || fields.has(kPaperKOfTransition)) {
    fields(kPaperKOfInterference, options.paper_factors.interference);
    fields(kPaperKOfTransition, options.paper_factors.transition);
  }
  const std::string refused = fields.refused().empty() ? FindUnsound(&options) : fields.refused();
  if (!refused.empty()) {
    return Fail(ErrorCode::kUnreadable,
                fmt::format("the options of a hand have no valid \"{}\"", refused));
  }
  return options;
}

}  // namespace hvas::session
