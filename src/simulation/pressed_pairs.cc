#include "simulation/pressed_pairs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "fits/pressed_parts.h"
#include "mates/elastic_parts.h"
#include "product/mesh_ray.h"
#include "simulation/insert_walk.h"

namespace hvas::simulation {
namespace {

using product::ElasticPart;
using product::OccurrenceId;
using product::Product;

constexpr double kLargestGap = 0.2e-3;  // [m] between parts that touch as drawn. A choice.
constexpr int kTableSteps = 128;        // The force is linear between them. A choice.

/** Points of an end of a part, from which lines look for what touches it, in B. */
std::vector<Vec3> ListEndPoints(const product::Part& part, const ElasticPart& elastic,
                                double sign) {
  constexpr double kBand = 20e-6;          // [m]: an end is as flat as this, or
  constexpr double kShareOfBand = 0.02;    // this share of the length. Choices.
  constexpr std::size_t kMostPoints = 64;  // Lines from an end: a choice.
  const double least = 0.5 * elastic.length - std::max(kBand, kShareOfBand * elastic.length);
  const auto is_end = [&](const Vec3& p) {
    return sign * (p - elastic.centre_B).dot(elastic.axis_B) > least;
  };
  std::vector<Vec3> inside;
  std::vector<Vec3> rim;
  for (const auto& t : part.mesh.triangles) {
    const Vec3& a = part.mesh.vertices[t[0]];
    const Vec3& b = part.mesh.vertices[t[1]];
    const Vec3& c = part.mesh.vertices[t[2]];
    if (is_end(a) && is_end(b) && is_end(c)) {
      inside.push_back((a + b + c) / 3);
    } else if (is_end(a)) {
      rim.push_back(a);
    }
  }
  const std::vector<Vec3>& all = inside.empty() ? rim : inside;
  std::vector<Vec3> points;
  const std::size_t stride = std::max<std::size_t>(1, all.size() / kMostPoints);
  for (std::size_t i = 0; i < all.size(); i += stride) {
    points.push_back(all[i]);
  }
  return points;
}

/** Whether a part has a face that looks at an end of another one and touches it. */
bool TouchesEnd(const Product& product, OccurrenceId other, const ElasticPart& elastic,
                double sign) {
  constexpr double kInto = 1e-3;  // [m]: how far the two may overlap as drawn. A choice.
  const spatial::Pose& X_WB = product.occurrences[elastic.occurrence.index()].X_WB;
  const spatial::Pose X_OB = product.occurrences[other.index()].X_WB.Inverse() * X_WB;
  const Vec3 out_O = X_OB.q() * (sign * elastic.axis_B);
  const double into = std::min(kInto, 0.5 * elastic.length);
  const std::vector<Vec3> points =
      ListEndPoints(product.part_of(elastic.occurrence), elastic, sign);
  return std::any_of(points.begin(), points.end(), [&](const Vec3& p_B) {
    const double rest = 0.5 * elastic.length - sign * (p_B - elastic.centre_B).dot(elastic.axis_B);
    const auto crossings = product::ListCrossings(product.part_of(other), X_OB * p_B - into * out_O,
                                                  out_O, into + rest + kLargestGap);
    return std::any_of(crossings.begin(), crossings.end(),
                       [](const product::Crossing& crossing) { return crossing.is_entering; });
  });
}

/** What stands on the two ends of a part. */
struct Ends {
  std::vector<OccurrenceId> low;   // At the end where its axis comes from.
  std::vector<OccurrenceId> high;  // Where its axis goes to.

  [[nodiscard]] const std::vector<OccurrenceId>& at(double sign) const {
    return sign > 0 ? high : low;
  }
};

class PressSearch {
 public:
  PressSearch(const Product& product, const sequence::Sequence& sequence)
      : product_(product), sequence_(sequence) {
    for (const ElasticPart& part : product.elastic) {
      if (IsPressedAlongAxis(part.kind) && part.occurrence.index() < sequence.neighbours.size()) {
        AddEnds(part);
      }
    }
  }

  std::vector<PressedPair> Run() {
    if (ends_.empty()) {
      return {};
    }
    WalkInserts(product_, sequence_, [this](const InsertStep& insert) {
      for (const auto& [id, ends] : ends_) {
        for (const double sign : {-1.0, 1.0}) {
          FindPress(insert, id, sign);
        }
      }
    });
    return std::move(pairs_);
  }

 private:
  void AddEnds(const ElasticPart& part) {
    Ends ends;
    for (const OccurrenceId other : sequence_.neighbours[part.occurrence.index()]) {
      if (TouchesEnd(product_, other, part, -1)) {
        ends.low.push_back(other);
      }
      if (TouchesEnd(product_, other, part, 1)) {
        ends.high.push_back(other);
      }
    }
    ends_[part.occurrence] = std::move(ends);
  }

  [[nodiscard]] Vec3 AxisOf(OccurrenceId id) const {
    return product_.occurrences[id.index()].X_WB.q() * FindElastic(product_, id)->axis_B;
  }

  [[nodiscard]] bool IsElastic(OccurrenceId id) const { return ends_.count(id) > 0; }

  /** How far two parts overlap as drawn [m]. */
  [[nodiscard]] double CalcOverlap(OccurrenceId a, OccurrenceId b) const {
    for (const sequence::DrawnOverlap& overlap : sequence_.overlaps) {
      if (overlap.Joins(a, b)) {
        return overlap.depth;
      }
    }
    return 0;
  }

  /** Finds whether a step presses a part at one of its ends. */
  void FindPress(const InsertStep& insert, OccurrenceId id, double sign) {
    const sequence::SequenceStep& step = *insert.step;
    const bool is_own = insert.Moves(id);
    if (!is_own && !insert.HasPlaced(id)) {
      return;
    }
    // What moves comes onto the end, or the end comes onto what is in its place.
    const double along = -step.extraction_W.dot(sign * AxisOf(id));
    if (is_own ? along < kAlongAxis : along > -kAlongAxis) {
      return;
    }
    const std::vector<OccurrenceId>& met = ends_.at(id).at(sign);
    const auto presser = std::find_if(met.begin(), met.end(), [&](OccurrenceId part) {
      return !IsElastic(part) &&
             (is_own ? insert.HasPlaced(part) && !insert.Moves(part) : insert.Moves(part));
    });
    if (presser == met.end()) {
      return;
    }
    PressedPair pair;
    pair.moved = step.occurrence;
    pair.compression = CalcOverlap(id, *presser);
    pair.against = *presser;
    OccurrenceId at = id;
    double end = -sign;
    while (true) {
      pair.parts.push_back(at);
      pair.compression += mates::CalcCompression(*FindElastic(product_, at));
      const std::vector<OccurrenceId>& behind = ends_.at(at).at(end);
      const auto next = std::find_if(behind.begin(), behind.end(), [&](OccurrenceId part) {
        const bool is_there =
            is_own ? insert.Moves(part) : insert.HasPlaced(part) && !insert.Moves(part);
        return is_there &&
               std::find(pair.parts.begin(), pair.parts.end(), part) == pair.parts.end();
      });
      if (next == behind.end()) {
        return;  // Nothing holds it against what presses.
      }
      pair.compression += CalcOverlap(at, *next);
      if (!IsElastic(*next)) {
        pair.support = *next;
        pair.against = is_own ? pair.against : pair.support;
        break;
      }
      end = AxisOf(*next).dot(end * AxisOf(at)) > 0 ? 1 : -1;
      at = *next;
    }
    Finish(std::move(pair));
  }

  void Finish(PressedPair pair) {
    std::vector<fits::PressedPart> laws;
    for (const OccurrenceId id : pair.parts) {
      if (const auto law = mates::MakePressedPart(*FindElastic(product_, id))) {
        laws.push_back(*law);
        const std::string source = fits::DescribeForce(*law);
        if (pair.source.find(source) == std::string::npos) {
          pair.source += (pair.source.empty() ? "" : "; ") + source;
        }
      }
    }
    if (pair.compression < kLeastPressed) {
      return;
    }
    auto curve = std::make_shared<haptics::GivingCurve>();
    curve->pressed = fits::MakePressTable(laws, pair.compression, kTableSteps);
    curve->compression = pair.compression;
    if (curve->pressed.empty()) {
      return;
    }
    pair.force = curve->pressed.back();
    pair.curve = std::move(curve);
    pairs_.push_back(std::move(pair));
  }

  const Product& product_;
  const sequence::Sequence& sequence_;
  std::map<OccurrenceId, Ends> ends_;
  std::vector<PressedPair> pairs_;
};

}  // namespace

std::vector<PressedPair> ListPressedPairs(const Product& product,
                                          const sequence::Sequence& sequence) {
  return PressSearch(product, sequence).Run();
}

}  // namespace hvas::simulation
