#include "simulation/deformation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace hvas::simulation {
namespace {

// A part deforms others as far off its way as three times what they give, or this far [m], and so
// tilted: what the tick engages what gives by (haptics/giving_rows.cc).
constexpr double kAside = 1e-3;
constexpr double kAsideOfGiven = 3;
constexpr double kTilt = 0.15;  // [rad]
// The room in which a point counts to an arm beyond the box of its mesh [m]: a choice, more than
// the two meshes of a part differ by.
constexpr double kArmSlack = 20e-6;
// A ring narrows to no less than this share of its radius: a choice.
constexpr double kLeastRadius = 0.5;

/** Deflection of a cantilever at x from its root, by y at l. */
double CalcBeam(double x, double length, double y) {
  if (x <= 0) {
    return 0;
  }
  if (x >= length) {
    return y * (3 * x - length) / (2 * length);
  }
  return y * x * x * (3 * length - x) / (2 * length * length * length);
}

bool IsWithin(double value, const std::array<double, 2>& range) {
  return value >= range[0] - kArmSlack && value <= range[1] + kArmSlack;
}

Vec3 DeformBend(const DeformationForm& form, double amount, const Vec3& p_B) {
  const Vec3 d = p_B - form.origin_B;
  const double x = d.dot(form.axis_B);
  const bool is_arm = x > 0 && IsWithin(d.dot(form.aside_B), form.range) &&
                      IsWithin(d.dot(form.axis_B.cross(form.aside_B)), form.across);
  return is_arm ? Vec3(p_B + CalcBeam(x, form.length, amount) * form.aside_B) : p_B;
}

/** A point by its distance from an axis. */
struct Polar {
  double along{0};
  double radius{0};
  Vec3 outward_B{Vec3::Zero()};  // Unit; zero on the axis.
};

Polar ToPolar(const DeformationForm& form, const Vec3& p_B) {
  const Vec3 d = p_B - form.origin_B;
  const double along = d.dot(form.axis_B);
  const Vec3 radial = d - along * form.axis_B;
  const double radius = radial.norm();
  return {along, radius, radius > 0 ? Vec3(radial / radius) : Vec3(Vec3::Zero())};
}

Vec3 DeformFlare(const DeformationForm& form, double amount, const Vec3& p_B) {
  const Polar polar = ToPolar(form, p_B);
  if (!(polar.along > 0) || !IsWithin(polar.radius, form.range)) {
    return p_B;
  }
  return p_B + form.shares[0] * CalcBeam(polar.along, form.length, amount) * polar.outward_B;
}

/** The share at a radius, between those at the inner and at the outer one. */
double CalcShare(const DeformationForm& form, double radius) {
  const double width = form.range[1] - form.range[0];
  const double at = width > 0 ? std::clamp((radius - form.range[0]) / width, 0.0, 1.0) : 0.0;
  return form.shares[0] + at * (form.shares[1] - form.shares[0]);
}

Vec3 DeformRadial(const DeformationForm& form, double amount, const Vec3& p_B) {
  const Polar polar = ToPolar(form, p_B);
  const double grows = CalcShare(form, polar.radius);
  return p_B + std::max(grows * amount, -polar.radius) * polar.outward_B;
}

/** Angle about the axis from the back of a ring [rad]. */
double AngleFromBack(const DeformationForm& form, const Vec3& outward_B) {
  const Vec3 side_B = form.axis_B.cross(form.aside_B);
  return std::atan2(outward_B.dot(side_B), outward_B.dot(form.aside_B));
}

Vec3 DeformOpen(const DeformationForm& form, double amount, const Vec3& p_B) {
  const Polar polar = ToPolar(form, p_B);
  const double y = std::max(amount, -kLeastRadius * form.length);
  const Vec3 side_B = form.axis_B.cross(form.aside_B);
  const double angle = AngleFromBack(form, polar.outward_B) * form.length / (form.length + y);
  const Vec3 outward_B = std::cos(angle) * form.aside_B + std::sin(angle) * side_B;
  return form.origin_B + polar.along * form.axis_B + (polar.radius + y) * outward_B;
}

/** Where the moved part of a source is on its way, from its place. */
struct Travel {
  double along{0};  // Outwards [m].
  bool is_on_way{false};
};

Travel CalcTravel(const product::Product& product, const DeformationSource& source,
                  std::span<const spatial::Pose> X_WB) {
  const spatial::Pose& X_WA_goal = product.occurrences[source.against.index()].X_WB;
  const spatial::Pose& X_WB_goal = product.occurrences[source.moved.index()].X_WB;
  const spatial::Pose X_AB = X_WB[source.against.index()].Inverse() * X_WB[source.moved.index()];
  const spatial::Pose X_WB_seen = X_WA_goal * X_AB;
  const Vec3 off_W = X_WB_seen.p() - X_WB_goal.p();
  const double along = off_W.dot(source.out_W);
  const double reach = std::max(kAside, kAsideOfGiven * source.widest);
  const double tilt =
      spatial::RotationBetween(X_WB_goal.q(), X_WB_seen.q()).cross(source.out_W).norm();
  const bool is_near = (off_W - along * source.out_W).norm() < reach && tilt < kTilt;
  return {along, is_near && along > -reach};
}

double CalcGivenAt(const DeformationSource& source, double along) {
  const double given = std::min(source.curve->CalcGiven(along), std::max(source.widest, 0.0));
  if (source.own.size() < 2 || !(source.widest > 0)) {
    return std::max(0.0, given);
  }
  const double steps = static_cast<double>(source.own.size() - 1);
  const double at = std::clamp(given / source.widest, 0.0, 1.0) * steps;
  const auto i = std::min(static_cast<std::size_t>(at), source.own.size() - 2);
  return source.own[i] + (at - static_cast<double>(i)) * (source.own[i + 1] - source.own[i]);
}

}  // namespace

Vec3 Deform(const DeformationForm& form, double amount, const Vec3& p_B) {
  if (amount == 0) {
    return p_B;
  }
  switch (form.kind) {
    case DeformationKind::kBend:
      return DeformBend(form, amount, p_B);
    case DeformationKind::kFlare:
      return DeformFlare(form, amount, p_B);
    case DeformationKind::kRadial:
      return DeformRadial(form, amount, p_B);
    case DeformationKind::kOpen:
      return DeformOpen(form, amount, p_B);
    case DeformationKind::kPress: {
      const double along = (p_B - form.origin_B).dot(form.axis_B);
      return p_B + amount * std::clamp(along / form.length, 0.0, 1.0) * form.axis_B;
    }
    case DeformationKind::kCone:
      return p_B + amount * CalcShare(form, ToPolar(form, p_B).radius) * form.axis_B;
    case DeformationKind::kHelix: {
      const double turned = form.shares[0] * AngleFromBack(form, ToPolar(form, p_B).outward_B);
      return p_B + amount * (0.5 + turned / (2 * std::numbers::pi)) * form.axis_B;
    }
    case DeformationKind::kShift:
      return p_B + amount * form.axis_B;
  }
  return p_B;
}

double CalcGiven(const product::Product& product, const DeformationSource& source,
                 std::span<const spatial::Pose> X_WB) {
  const Travel travel = CalcTravel(product, source, X_WB);
  return travel.is_on_way && source.curve != nullptr ? CalcGivenAt(source, travel.along) : 0;
}

std::vector<double> CalcDeformations(const product::Product& product,
                                     const std::vector<Deformable>& deformables,
                                     std::span<const spatial::Pose> X_WB,
                                     const std::vector<bool>* present) {
  const auto is_there = [present](const DeformationSource& source) {
    return present == nullptr ||
           ((*present)[source.moved.index()] && (*present)[source.against.index()]);
  };
  std::vector<double> amounts;
  for (const Deformable& part : deformables) {
    double amount = part.free;
    if (part.form.kind == DeformationKind::kShift) {
      double carried = 0;
      for (const std::size_t below : part.below) {
        carried += amounts[below];
      }
      const DeformationSource& place = part.sources.front();
      const Travel travel = CalcTravel(product, place, X_WB);
      // What comes down on a stack that is longer than drawn rests on it before its place.
      if (travel.is_on_way && is_there(place)) {
        amount = std::max(std::min(carried, 0.0), carried - std::max(0.0, travel.along));
      }
    } else {
      double given = 0;
      for (const DeformationSource& source : part.sources) {
        given = std::max(given, is_there(source) ? CalcGiven(product, source, X_WB) : 0.0);
      }
      amount += part.sign * given;
    }
    amounts.push_back(std::abs(amount) < kLeastDrawn ? 0.0 : amount);
  }
  return amounts;
}

std::function<Vec3(const Vec3& p_B)> MakePointMap(const std::vector<Deformable>& deformables,
                                                  const std::vector<double>& amounts,
                                                  product::OccurrenceId id) {
  std::vector<std::pair<const DeformationForm*, double>> own;
  for (std::size_t i = 0; i < deformables.size(); ++i) {
    if (deformables[i].occurrence == id && amounts[i] != 0) {
      own.emplace_back(&deformables[i].form, amounts[i]);
    }
  }
  if (own.empty()) {
    return {};
  }
  return [own = std::move(own)](const Vec3& p_B) {
    Vec3 p = p_B;
    for (const auto& [form, amount] : own) {
      p = Deform(*form, amount, p);
    }
    return p;
  };
}

}  // namespace hvas::simulation
