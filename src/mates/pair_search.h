#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/work_watch.h"
#include "mates/limits.h"
#include "mates/plane_overlap.h"
#include "product/product.h"

/** What two parts have to do with each other, from their features and their relative pose alone. */
namespace hvas::mates {

/** A hole and a shaft that engage: on one axis, or the shaft off the hole's axis, by no more than
 its play lets it. */
struct AxisHit {
  bool is_hole_in_a{true};  ///< False where the hole is the second part's.
  product::FeatureId hole;
  product::FeatureId shaft;
  double low{0};  ///< Engaged interval along the hole's axis from the hole's origin [m].
  double high{0};
  bool is_off_axis{false};
};

/** Two holes on one axis that follow each other. */
struct HoleHit {
  product::FeatureId a;
  product::FeatureId b;
};

/** A taper in a conical seat, or a ball in a socket. */
struct SeatHit {
  product::MateKind kind{product::MateKind::kConeSeat};
  bool is_seat_in_a{true};
  product::FeatureId seat;
  product::FeatureId body;
};

/** Two planes that oppose each other and overlap. */
struct PlaneHit {
  product::FeatureId a;
  product::FeatureId b;
  double area{0};  ///< [m^2]
  double gap{0};   ///< Gap at the centroid [m]; negative: each inside the other part.
  Vec3 centroid_A{Vec3::Zero()};  ///< Coordinates in the first part's frame.
};

struct PairHits {
  std::vector<AxisHit> axes;
  std::vector<HoleHit> holes;
  std::vector<SeatHit> seats;
  std::vector<PlaneHit> planes;         ///< That touch.
  std::vector<PlaneHit> walls;          ///< That do not, but could hold a part between them.
  std::optional<PlaneHit> nearest;      ///< The planes with the largest area that nearly touch.
  std::optional<PlaneHit> overlapping;  ///< The hit of those that lie inside each other.

  [[nodiscard]] bool is_empty() const {
    return axes.empty() && holes.empty() && seats.empty() && planes.empty() && walls.empty() &&
           !nearest && !overlapping;
  }
};

/** Searches pairs of occurrences. Pairs of the same two parts that lie equally to each other
 (within 1 nm), as in all instances of a subassembly, are looked at once; the answer is exactly that
 of the first, in the frame of the first part. Answers are incomplete once the watch has ended it.
 */
class PairSearch {
 public:
  /** @pre product outlives this and does not change. */
  PairSearch(const product::Product& product, const InferenceLimits& limits,
             WorkWatch* watch = nullptr);

  /** The answer stays valid until the next call. */
  [[nodiscard]] const PairHits& Find(product::OccurrenceId a, product::OccurrenceId b);

  /** Pairs that were looked at, not answered from memory. */
  [[nodiscard]] std::size_t searched() const { return searched_; }

 private:
  struct SearchFeature {
    product::FeatureId id;
    product::FeatureKind kind{product::FeatureKind::kPlane};
    const product::Feature* feature{nullptr};
    spatial::Box box;
    Vec3 arc_B{Vec3::Zero()};  ///< Middle of a round end; of all others zero.
  };

  struct SearchPart {
    bool is_ready{false};
    double size{0};
    std::vector<SearchFeature> features;
  };

  /** A feature of the second part in the frame of the first. */
  struct MovedFeature {
    const SearchFeature* own;
    spatial::Box box;
    Vec3 origin, axis;
  };

  struct PairKey {
    std::uint32_t a{0}, b{0};
    std::int64_t x{0}, y{0}, z{0};

    bool operator==(const PairKey&) const = default;
  };

  struct PairKeyHash {
    std::size_t operator()(const PairKey& key) const noexcept;
  };

  struct Known {
    product::Pose X_AB;
    PairHits hits;
  };

  struct Context;

  const SearchPart& Prepare(product::PartId id);
  void Search(product::PartId a, product::PartId b, const product::Pose& X_AB, PairHits* hits);
  void TestPair(const Context& context, const SearchFeature& a, const MovedFeature& b,
                PairHits* hits);
  void TestBall(const Context& context, const SearchFeature& a, const MovedFeature& b,
                bool is_seat_in_a, PairHits* hits) const;
  /** Tests a shaft in a hole, or a taper in a seat, whose axes are parallel. */
  void TestOnAxis(const Context& context, const SearchFeature& a, const MovedFeature& b,
                  bool is_seat_in_a, PairHits* hits) const;
  void TestHoles(const Context& context, const std::vector<const SearchFeature*>& of_a,
                 const std::vector<MovedFeature>& of_b, PairHits* hits) const;
  void TestPlanes(const Context& context, const SearchFeature& a, const MovedFeature& b,
                  PairHits* hits);
  const std::vector<Triangle2>& FlattenOnce(product::PartId part, const SearchFeature& feature);

  const product::Product& product_;
  InferenceLimits limits_;
  WorkWatch* watch_;
  double cos_angle_{1};
  std::size_t searched_{0};
  std::vector<SearchPart> parts_;
  std::unordered_map<PairKey, std::vector<Known>, PairKeyHash> known_;  // Looked up only.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Triangle2>> triangles_;
  PairHits last_;
};

}  // namespace hvas::mates
