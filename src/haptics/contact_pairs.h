#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "contact/scene.h"

namespace hvas::haptics {

/** How the contact of two bodies answers, where somebody states it. */
struct ContactPairResponse {
  contact::BodyId a;
  contact::BodyId b;
  std::optional<double> compliance;  ///< Compliance of one contact point [m/N].
  std::optional<double> friction;    ///< Coulomb coefficient, static and kinetic.
};

/** The stated responses of a scene; without any, all contacts answer alike. */
class ContactPairs {
 public:
  /** Later ones replace earlier ones of the same pair. Allocates: before the first tick. */
  void Set(const ContactPairResponse& response) {
    ContactPairResponse sorted = response;
    if (sorted.b < sorted.a) {
      std::swap(sorted.a, sorted.b);
    }
    const auto place = std::lower_bound(pairs_.begin(), pairs_.end(), sorted, IsBefore);
    if (place != pairs_.end() && !IsBefore(sorted, *place)) {
      *place = sorted;
    } else {
      pairs_.insert(place, sorted);
    }
  }

  /** The response of a pair, in either order; null where none is stated. RT-safe. */
  [[nodiscard]] const ContactPairResponse* Find(contact::BodyId a,
                                                contact::BodyId b) const noexcept {
    ContactPairResponse key;
    key.a = std::min(a, b);
    key.b = std::max(a, b);
    const auto place = std::lower_bound(pairs_.begin(), pairs_.end(), key, IsBefore);
    return place != pairs_.end() && !IsBefore(key, *place) ? &*place : nullptr;
  }

 private:
  static bool IsBefore(const ContactPairResponse& x, const ContactPairResponse& y) noexcept {
    return x.a < y.a || (x.a == y.a && x.b < y.b);
  }

  std::vector<ContactPairResponse> pairs_;  // Sorted, the lower id first in each.
};

}  // namespace hvas::haptics
