#include "simulation/person_task.h"

#include <algorithm>
#include <cmath>

namespace hvas::simulation {

spatial::Pose PersonTask::WayAt(double travel) const noexcept {
  return way != nullptr ? way->At(travel)
                        : spatial::Pose(X_WG_goal.q(), X_WG_goal.p() + travel * extraction_W);
}

double PersonTask::TravelOf(const spatial::Pose& X_WG, double near) const noexcept {
  return way != nullptr ? way->CalcTravel(X_WG, near)
                        : (X_WG.p() - X_WG_goal.p()).dot(extraction_W);
}

Vec3 PersonTask::OutwardAt(double travel) const noexcept {
  if (way == nullptr) {
    return extraction_W;
  }
  const Vec3 v_W = way->RateAt(travel).v;
  return v_W.norm() > sequence::GripWay::kTurningShare ? Vec3(v_W.normalized()) : extraction_W;
}

Vec3 PersonTask::CalcLifted() const noexcept {
  return X_WG_start.p() + Vec3(0, 0, lift_height);
}

Vec3 PersonTask::CalcPointAside(double distance) const noexcept {
  const Vec3 from_centre = CalcLifted() - centre_W;
  const double aside = std::hypot(from_centre.x(), from_centre.y());
  if (from_centre.z() >= kLeastRiseAside * aside) {
    return centre_W + distance * from_centre.normalized();
  }
  // Straight up to it from the table never comes nearer to the centre than this.
  const Vec3 out(from_centre.x() / aside, from_centre.y() / aside, kLeastRiseAside);
  return centre_W + distance * out;
}

double PersonTask::CalcWayToSphere(double least) const noexcept {
  const double length = way != nullptr ? way->length() : 0;
  const Vec3 from_centre = WayAt(length).p() - centre_W;
  const double b = from_centre.dot(extraction_W);
  const double discriminant = b * b - from_centre.squaredNorm() + transfer_radius * transfer_radius;
  return std::max(least, length - b + std::sqrt(std::max(0.0, discriminant)));
}

}  // namespace hvas::simulation
