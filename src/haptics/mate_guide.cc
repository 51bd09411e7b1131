#include "haptics/mate_guide.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mates/mate_kind.h"

namespace hvas::haptics {
namespace {

constexpr double kAlignedDistance = 20e-6;     // [m] beyond the clearance
constexpr double kAlignedAngle = 1e-3;         // [rad] beyond the clearance: a choice.
constexpr double kLeaveFactor = 10;            // of these, before an aligned mate counts as left
constexpr double kOpening = 0.5e-3;            // [m] of depth over which the play opens
constexpr double kNearRatio = 3;               // of the capture thresholds
constexpr double kHandRatio = 3;               // the hand may stray this far before a mate lets go
constexpr double kFirstStiffness = 1.0;        // [N/m] where the ramp starts
constexpr double kFirstRotStiffness = 2.5e-3;  // [N m/rad], the same at 50 mm: neither goes ahead

using product::MateKind;

/** Radius within which the axis is free: the clearance space S(l) where the shaft is engaged, W(4).
 It opens over the first half millimetre, so that nothing jumps at the rim. */
double FreeRadius(const HeldMate& mate, const MateGeometry& geometry) noexcept {
  if (mate.fit == nullptr || geometry.engaged <= 0) {
    return 0;
  }
  const double clearance = mate.fit->CalcRadialPlay(geometry.engaged);
  return clearance * std::min(1.0, geometry.engaged / kOpening);
}

/** Engaged length from which on the play alone holds a tilt [m]. */
double HoldingLength(const HeldMate& mate) noexcept {
  return mate.breadth > 0 ? mate.breadth : 2 * mate.radius;
}

/** Tilt that the clearance leaves: 2 S over the engaged length. A length of less than a diameter,
 or than the breadth of walls, holds no tilt by itself; there the guidance does (X14). */
double FreeTilt(const HeldMate& mate, const MateGeometry& geometry) noexcept {
  return geometry.engaged > 0
             ? 2 * FreeRadius(mate, geometry) / std::max(geometry.engaged, HoldingLength(mate))
             : 0;
}

/** How stiffly a mate holds at the end of its ramp: as its fit does on the engaged length, which is
 taken no shorter than where the fit's own play begins to count; at most what the options allow. */
double FullStiffness(const HeldMate& mate, const MateGeometry& g, double most) noexcept {
  return mate.fit == nullptr || g.engaged <= 0
             ? most
             : std::min(most, mate.fit->CalcRadialStiffness(std::max(g.engaged, kOpening)));
}

double FullRotStiffness(const HeldMate& mate, const MateGeometry& g, double most) noexcept {
  return mate.fit == nullptr || g.engaged <= 0
             ? most
             : std::min(most,
                        mate.fit->CalcTiltStiffness(std::max(g.engaged, HoldingLength(mate))));
}

/** Geometric ramp: most of the way is made where the mate is as stiff as the hand. */
double RampedStiffness(double first, double full, double ramp) noexcept {
  return ramp <= 0 ? 0 : first * std::pow(full / first, ramp);
}

/** Stiffness that never pulls harder than `max_pull` at this deviation. */
double Bounded(double stiffness, double deviation, double max_pull) noexcept {
  return deviation * stiffness > max_pull ? max_pull / deviation : stiffness;
}

/** A guiding mate holds the part across its way; a stop only squares it. */
bool IsGuide(const HeldMate& mate) noexcept {
  return mate.capture.kind != MateKind::kFaceFace || !mate.is_stop;
}

/** True where the mate takes the place of contact between its faces. Cones and spheres do not: they
 seat the part, and only contact knows when it is there. */
bool ReplacesContact(const HeldMate& mate) noexcept {
  return mates::HasFit(mate.capture.kind) ||
         (mate.capture.kind == MateKind::kFaceFace && !mate.is_stop);
}

/** True where a shaft touches its hole as contact has it, once it is in: it has play all the way.
 */
bool AnswersByContact(const HeldMate& mate) noexcept {
  return mate.capture.kind == MateKind::kAxisHole && mate.fit != nullptr &&
         mate.fit->CalcRadialPlay(mate.fit->length()) > 0;
}

/** Where the hand wants the part, but no further in than its place: whoever pushes on a part that
 is there does not want it to come out. */
spatial::Pose WithoutOvershoot(const HeldPart& part, const spatial::Pose& X_WT) noexcept {
  const Vec3& p_BoBcm_B = part.p_BoBcm_B;
  const Vec3 ahead_W = X_WT * p_BoBcm_B - part.X_WB_goal * p_BoBcm_B;
  const double overshoot = std::max(0.0, ahead_W.dot(part.insertion_W));
  return {X_WT.q(), X_WT.p() - overshoot * part.insertion_W};
}

/** What the spans of a mate share along its way, from the placed origin [m]. */
struct Engagement {
  double low{0};  // Where the sides meet, where they share nothing.
  double high{0};
  double depth{0};  // Negative by how far they are apart.
};

/** @param along  Of the held origin. @param cosine  Of the held way to the placed one. */
Engagement CalcEngagement(const mates::CaptureMate& mate, double along, double cosine) noexcept {
  const double held_low = along + cosine * mate.held_low;
  const double held_high = along + cosine * mate.held_high;
  return {std::clamp(mate.placed_low, held_low, held_high),
          std::clamp(mate.placed_high, held_low, held_high),
          std::min(mate.placed_high, held_high) - std::max(mate.placed_low, held_low)};
}

/** Along x the spans; along z the offset from the middle of the play, which is where it is drawn,
 or nearer to the middle of the slot where the fit leaves less than is drawn. */
void AddPrismaticGeometry(const HeldMate& mate, const spatial::Pose& X_WN,
                          MateGeometry* g) noexcept {
  const Vec3 d = X_WN.p() - mate.X_WM.p();
  const Vec3 held_way = X_WN.q() * Vec3::UnitX();
  g->way_W = mate.X_WM.q() * Vec3::UnitX();
  const double cosine = std::max(0.1, held_way.dot(g->way_W));
  const double along = d.dot(g->way_W);
  const Engagement engagement = CalcEngagement(mate.capture, along, cosine);
  g->engaged = engagement.high - engagement.low;
  g->depth = engagement.depth;
  const double middle = 0.5 * (engagement.low + engagement.high);
  g->p_WQ = X_WN.p() + (middle - along) / cosine * held_way;
  const double free = FreeRadius(mate, *g);
  const double across = (g->p_WQ - mate.X_WM.p()).dot(g->axis_W);
  g->offset_W = (across + std::clamp(mate.shift, -free, free)) * g->axis_W;
}

}  // namespace

MateGeometry CalcMateGeometry(const HeldMate& mate, const spatial::Pose& X_WB) noexcept {
  MateGeometry g;
  const bool is_plane = mate.capture.kind == MateKind::kFaceFace;
  const spatial::Pose X_WN = X_WB * mate.X_BN;
  g.axis_W = mate.X_WM.q() * Vec3::UnitZ();
  g.way_W = g.axis_W;
  const Vec3 held_axis = X_WN.q() * Vec3(0, 0, is_plane ? -1 : 1);
  const Vec3 d = X_WN.p() - mate.X_WM.p();
  const Vec3 cross = held_axis.cross(g.axis_W);
  g.angle = std::atan2(cross.norm(), held_axis.dot(g.axis_W));
  g.tilt_W = cross.norm() > 1e-12 ? Vec3(g.angle / cross.norm() * cross) : Vec3::Zero();
  const double along = d.dot(g.axis_W);
  if (mates::IsCentre(mate.capture.kind)) {
    g.p_WQ = X_WN.p();
    g.offset_W = d;
    g.angle = 0;
    g.tilt_W = Vec3::Zero();
  } else if (is_plane) {
    g.p_WQ = X_WN.p();
    g.offset_W = along * g.axis_W;
  } else if (mate.capture.kind == MateKind::kPrismatic) {
    AddPrismaticGeometry(mate, X_WN, &g);
  } else {
    // Where the axes meet, as recognition has it: the end of the held span that faces the placed
    // one, or the middle of what they share. Further off, a tilt would count as an offset.
    const double cosine = std::max(0.1, held_axis.dot(g.axis_W));
    const Engagement engagement = CalcEngagement(mate.capture, along, cosine);
    g.engaged = engagement.high - engagement.low;
    g.depth = engagement.depth;
    g.p_WQ = X_WN.p() + (0.5 * (engagement.low + engagement.high) - along) / cosine * held_axis;
    g.offset_W = g.p_WQ - mate.X_WM.p();
    g.offset_W -= g.offset_W.dot(g.axis_W) * g.axis_W;
  }
  g.distance = g.offset_W.norm();
  return g;
}

void MateGuide::StartInPlace() noexcept {
  MateState in_place;
  in_place.is_captured = true;
  in_place.is_aligned = true;
  in_place.ramp = 1;
  mates_.fill(in_place);
}

void MateGuide::Update(const HeldPart& part, const GuidanceOptions& options,
                       const spatial::Pose& X_WB, const spatial::Pose& X_WT, double dt) noexcept {
  is_near_ = false;
  is_aligned_ = false;
  captured_count_ = 0;
  insertion_depth_ = 0;
  axis_ = nullptr;
  const spatial::Pose X_WWish = WithoutOvershoot(part, X_WT);
  const double to_go = (X_WB * part.p_BoBcm_B - part.X_WB_goal * part.p_BoBcm_B).norm();
  const bool may_capture = !options.captures_on_straight_end ||
                           to_go <= std::max(part.straight_end, options.match_distance);
  const std::size_t count = std::min(part.mates.size(), kMaxMates);
  for (std::size_t i = 0; i < count; ++i) {
    const HeldMate& mate = part.mates[i];
    MateState& state = mates_[i];
    state.geometry = CalcMateGeometry(mate, X_WB);
    const MateGeometry& g = state.geometry;
    const auto deviation = [&mate](const spatial::Pose& X) {
      return mates::CalcDeviation(mate.capture, mate.X_WM, X * mate.X_BN);
    };
    const MateKind kind = mate.capture.kind;
    const mates::MateDeviation now = deviation(X_WB);
    // An engaged shaft can only be drawn out along its axis; before that the hand's wish counts.
    if (!state.is_captured || g.engaged <= 0) {
      state.is_captured =
          may_capture && mates::IsCaptured(kind, now, state.is_captured, options.capture) &&
          mates::CalcCaptureRatio(kind, deviation(X_WWish), options.capture) < kHandRatio;
    }
    is_near_ = is_near_ || mates::CalcCaptureRatio(kind, now, options.capture) < kNearRatio;
    const double direction = state.is_captured ? 1.0 : -1.0;
    state.ramp = std::clamp(state.ramp + direction * dt / options.ramp_time, 0.0, 1.0);
    if (!state.is_captured) {
      state.is_aligned = false;
      continue;
    }
    ++captured_count_;
    UpdateAlignment(mate, &state);
    is_aligned_ = is_aligned_ || state.is_aligned;
    if (mates::HasFit(kind)) {
      if (axis_ == nullptr || g.engaged > insertion_depth_) {
        axis_ = &state.geometry;
        axis_index_ = i;
      }
      insertion_depth_ = std::max(insertion_depth_, g.engaged);
    }
  }
  ChooseBores(part, options);
}

void MateGuide::ChooseBores(const HeldPart& part, const GuidanceOptions& options) noexcept {
  const std::size_t count = std::min(part.mates.size(), kMaxMates);
  std::size_t bores = 0;
  const auto is_possible = [&](std::size_t i) {
    const MateState& state = mates_[i];
    const MateGeometry& g = state.geometry;
    return options.contact_in_holes && state.is_aligned && g.engaged > 0 &&
           AnswersByContact(part.mates[i]);
  };
  for (std::size_t i = 0; i < count; ++i) {
    mates_[i].is_bore = mates_[i].is_bore && is_possible(i);
    bores += mates_[i].is_bore ? 1 : 0;
  }
  has_guided_bores_ = false;
  for (std::size_t i = 0; i < count; ++i) {
    if (mates_[i].is_bore || !is_possible(i)) {
      continue;
    }
    if (bores == kMaxBores) {
      has_guided_bores_ = true;
      break;
    }
    mates_[i].is_bore = true;
    ++bores;
  }
  has_bores_ = bores > 0;
}

std::size_t MateGuide::CalcContacts(const HeldMate& mate, std::size_t i, const spatial::Pose& X_WB,
                                    double margin, BoreContacts* contacts) const noexcept {
  const spatial::Pose X_WN = X_WB * mate.X_BN;
  const mates::CaptureMate& spans = mate.capture;
  Bore bore;
  bore.hole_radius = mate.radius;
  bore.shaft_radius = mate.radius - mate.fit->CalcRadialPlay(mates_[i].geometry.engaged);
  bore.hole_low = mate.has_shaft ? spans.placed_low : spans.held_low;
  bore.hole_high = mate.has_shaft ? spans.placed_high : spans.held_high;
  bore.shaft_low = mate.has_shaft ? spans.held_low : spans.placed_low;
  bore.shaft_high = mate.has_shaft ? spans.held_high : spans.placed_high;
  const std::size_t count = CalcBoreContacts(bore, mate.has_shaft ? mate.X_WM : X_WN,
                                             mate.has_shaft ? X_WN : mate.X_WM, margin, contacts);
  if (!mate.has_shaft) {
    for (BoreContact& contact : std::span(contacts->data(), count)) {
      contact.nhat_W *= -1;  // It pushes the hole, which is held.
    }
  }
  return count;
}

void MateGuide::UpdateAlignment(const HeldMate& mate, MateState* state) noexcept {
  const MateGeometry& g = state->geometry;
  if (state->is_aligned && g.engaged > 0) {
    return;  // inside a hole, the fit answers until the shaft is out again
  }
  const double slack = state->is_aligned ? kLeaveFactor : 1.0;
  const double free = FreeRadius(mate, g);
  const double tilt_free = FreeTilt(mate, g);
  const bool is_across = !IsGuide(mate) || g.distance < free + slack * kAlignedDistance;
  state->is_aligned = state->ramp >= 1 && is_across && g.angle < tilt_free + slack * kAlignedAngle;
}

void MateGuide::AddTiltSpring(const HeldMate& mate, const MateState& state, double guided,
                              const GuidanceOptions& options, ConstraintSolver* solver) noexcept {
  const MateGeometry& g = state.geometry;
  const double tilt_free = mates::HasFit(mate.capture.kind) ? FreeTilt(mate, g) : 0;
  const double tilt = g.tilt_W.norm();
  if (!mates::HoldsDirection(mate.capture.kind) || (tilt <= tilt_free && tilt_free != 0)) {
    return;
  }
  const double excess = tilt - tilt_free;
  const double k =
      Bounded(guided * RampedStiffness(kFirstRotStiffness, FullRotStiffness(mate, g, options.k_rot),
                                       state.ramp),
              excess, guided * options.max_torque);
  const double part_of = tilt > 0 ? excess / tilt : 1.0;
  const Mat3 across = Mat3::Identity() - g.axis_W * g.axis_W.transpose();
  solver->AddAngularSpring(k * part_of * g.tilt_W, k * across);
}

void MateGuide::AddWallSpring(const HeldMate& mate, const MateState& state,
                              const GuidanceOptions& options, ConstraintSolver* solver) noexcept {
  if (mate.is_stop) {
    return;
  }
  const MateGeometry& g = state.geometry;
  const double k = Bounded(RampedStiffness(kFirstStiffness, options.k_lin, state.ramp), g.distance,
                           options.max_force);
  const Mat3 along = g.axis_W * g.axis_W.transpose();
  solver->AddPointSpring(g.p_WQ, -k * g.offset_W, k * along);
}

void MateGuide::AddOffsetSpring(const HeldMate& mate, const MateState& state, double guided,
                                const GuidanceOptions& options, ConstraintSolver* solver) noexcept {
  // Potential k (r - S)^2 / 2 outside the clearance space, W(5); its exact Hessian is
  // k [(1 - S/r)(I - a a^T) + (S/r) e e^T].
  const MateGeometry& g = state.geometry;
  const double free = FreeRadius(mate, g);
  const double r = g.distance;
  if (r <= free && free != 0) {
    return;
  }
  const double k = Bounded(
      guided * RampedStiffness(kFirstStiffness, FullStiffness(mate, g, options.k_lin), state.ramp),
      r - free, guided * options.max_force);
  const double ratio = r > 0 ? free / r : 0.0;
  const Vec3 e = r > 0 ? Vec3(g.offset_W / r) : Vec3::Zero();
  if (g.engaged > 0 && mates::HasFit(mate.capture.kind)) {
    lateral_force_ += k * (r - free);
  }
  const Mat3 along = g.axis_W * g.axis_W.transpose();
  const Mat3 whole = Mat3::Identity();
  const Mat3 across = whole - along;
  const Mat3& held = mates::IsCentre(mate.capture.kind)      ? whole
                     : mates::HoldsAcross(mate.capture.kind) ? across
                                                             : along;
  solver->AddPointSpring(g.p_WQ, -k * (r - free) * e,
                         k * ((1 - ratio) * held + ratio * e * e.transpose()));
}

void MateGuide::AddSprings(const HeldPart& part, const GuidanceOptions& options,
                           ConstraintSolver* solver) noexcept {
  lateral_force_ = 0;
  const std::size_t count = std::min(part.mates.size(), kMaxMates);
  for (std::size_t i = 0; i < count; ++i) {
    const MateState& state = mates_[i];
    // In the hole contact takes over, over the depth in which the play opens.
    const double guided = state.is_bore ? 1 - std::min(1.0, state.geometry.engaged / kOpening) : 1;
    if (state.ramp <= 0 || guided <= 0) {
      continue;
    }
    const HeldMate& mate = part.mates[i];
    AddTiltSpring(mate, state, guided, options, solver);
    if (mate.capture.kind == MateKind::kFaceFace) {
      AddWallSpring(mate, state, options, solver);
    } else {
      AddOffsetSpring(mate, state, guided, options, solver);
    }
  }
}

double MateGuide::CalcAxisPlay(const HeldPart& part) const noexcept {
  if (axis_ == nullptr) {
    return 0;
  }
  const HeldMate& mate = part.mates[axis_index_];
  return mates::HoldsAcross(mate.capture.kind) ? FreeRadius(mate, *axis_)
                                               : std::numeric_limits<double>::infinity();
}

std::size_t MateGuide::CollectIgnored(const HeldPart& part, std::span<contact::IgnoredPair> pairs,
                                      std::size_t member) const noexcept {
  std::size_t written = 0;
  const std::size_t count = std::min(part.mates.size(), kMaxMates);
  for (std::size_t i = 0; i < count && written + kPairsPerMate <= pairs.size(); ++i) {
    const HeldMate& mate = part.mates[i];
    if (!mates_[i].is_aligned || !ReplacesContact(mate) || mate.member != member) {
      continue;
    }
    pairs[written++] = {mate.body, mate.held_faces->mating, mate.placed_faces->with_neighbours};
    pairs[written++] = {mate.body, mate.held_faces->with_neighbours, mate.placed_faces->mating};
  }
  return written;
}

FitLoad MateGuide::CalcFitLoad(const HeldPart& part, double slip,
                               const PaperFactors& factors) const noexcept {
  FitLoad sum;
  const std::size_t count = std::min(part.mates.size(), kMaxMates);
  for (std::size_t i = 0; i < count; ++i) {
    const HeldMate& mate = part.mates[i];
    if (!mates_[i].is_aligned || mate.fit == nullptr) {
      continue;
    }
    const double depth = mates_[i].geometry.depth;
    const double in = mate.fit->CalcAxialResistance(depth);
    const double out = mate.fit->CalcReleaseForce(depth, slip);
    sum.in += in;
    sum.out += out;
    sum.torque += mate.fit->CalcTorque(depth);
    sum.shown_in += factors.Of(mate.fit_kind) * in;
    sum.shown_out += factors.Of(mate.fit_kind) * out;
  }
  return sum;
}

}  // namespace hvas::haptics
