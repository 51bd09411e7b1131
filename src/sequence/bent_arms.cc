#include "sequence/bent_arms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "product/mesh_ray.h"
#include "spatial/box.h"

namespace hvas::sequence {
namespace {

using product::Part;

constexpr double kThickRoot = 2.5;       // Times the thinnest section: the body begins. A choice.
constexpr int kStations = 240;           // Looks at an arm along the whole part: a choice.
constexpr int kBisections = 16;          // Of the step between two looks: a choice.
constexpr double kBesideFar = 0.25;      // Share of the wall from its far side, at most: a choice.
constexpr double kLeastBeside = 1e-6;    // [m] from the far side of the wall. A choice.
constexpr int kMostArmTries = 12;        // Contacts from which an arm is looked for: a choice.
constexpr double kShareOfDeepest = 0.3;  // A contact that is less deep bends nothing: a choice.
constexpr double kWeld = 1e-7;           // Corners that are nearer are one [m]. A choice.
constexpr double kBeyondRoot = 1e-5;     // Share of the length of the arm: a choice.

/** A section of a wall at one point along it. */
struct Section {
  double thickness{0};
  Vec3 far_B{Vec3::Zero()};  // Point on its far side.
};

class ArmSearch {
 public:
  ArmSearch(const Part& part, const Vec3& way_B) : part_(part), way_B_(way_B) {
    for (const Vec3& vertex : part.mesh.vertices) {
      low_ = std::min(low_, vertex.dot(way_B));
      high_ = std::max(high_, vertex.dot(way_B));
    }
    WeldCorners();
  }

  /** @param p_B  Contact, on the part or in its material. @param inward_B  Unit, across the way.
   @param depth  How deep the contact may lie in the material [m]. */
  std::optional<BentArm> Find(const Vec3& p_B, const Vec3& inward_B, double depth,
                              std::uint32_t face) {
    const auto first = FindFirstSection(p_B, inward_B, depth);
    if (!first) {
      return std::nullopt;
    }
    const Walk up = WalkAlong(*first, inward_B, way_B_);
    const Walk down = WalkAlong(*first, inward_B, -way_B_);
    // The body is at one end; where it is at none, the arm is as long as the part.
    const bool is_up = up.has_root != down.has_root ? up.has_root : up.length > down.length;
    const Walk& root = is_up ? up : down;
    BentArm arm;
    arm.axis_B = is_up ? Vec3(-way_B_) : way_B_;
    arm.aside_B = inward_B;
    arm.root_B = root.last.far_B - 0.5 * root.last.thickness * inward_B;
    arm.length = (p_B - arm.root_B).dot(arm.axis_B);
    if (!(arm.length > root.thinnest)) {
      return std::nullopt;
    }
    faces_ = CollectFaces(arm, face, p_B);
    SetRanges(&arm);
    // It bends the way that it is thin; at its edges the nearest way out leads along its breadth.
    return root.thinnest < arm.across[1] - arm.across[0] ? std::optional(arm) : std::nullopt;
  }

  /** Faces of the arm that was found last. */
  [[nodiscard]] const std::set<std::uint32_t>& faces() const { return faces_; }

 private:
  struct Walk {
    double length{0};
    bool has_root{false};
    Section last;  // Just before its end.
    double thinnest{0};
  };

  /** The wall behind a contact. */
  std::optional<Section> FindFirstSection(const Vec3& p_B, const Vec3& inward_B, double depth) {
    const double reach = high_ - low_ + 2 * depth;
    const auto crossings =
        product::ListCrossings(part_, p_B - 2 * depth * inward_B, inward_B, reach);
    double entered = 2 * depth;
    for (const product::Crossing& crossing : crossings) {
      if (crossing.is_entering) {
        entered = crossing.distance;
      } else if (crossing.distance > 2 * depth + kLeastBeside) {
        return Section{crossing.distance - entered,
                       p_B + (crossing.distance - 2 * depth) * inward_B};
      }
    }
    return std::nullopt;
  }

  /** The wall at a point that lies in it, just before its far side; none where there is none. */
  [[nodiscard]] std::optional<Section> FindSection(const Vec3& q_B, const Vec3& inward_B) const {
    const double reach = (part_.box_B.high - part_.box_B.low).norm();
    const auto ahead = product::ListCrossings(part_, q_B, inward_B, reach);
    const auto behind = product::ListCrossings(part_, q_B, -inward_B, reach);
    if (ahead.empty() || behind.empty() || ahead[0].is_entering || behind[0].is_entering) {
      return std::nullopt;
    }
    return Section{ahead[0].distance + behind[0].distance, q_B + ahead[0].distance * inward_B};
  }

  [[nodiscard]] Walk WalkAlong(const Section& first, const Vec3& inward_B,
                               const Vec3& along_B) const {
    const double step = (high_ - low_) / kStations;
    Walk walk{0, false, first, first.thickness};
    const auto look = [&](double further) {
      const double beside = std::max(kLeastBeside, kBesideFar * walk.thinnest);
      return FindSection(walk.last.far_B + further * along_B - beside * inward_B, inward_B);
    };
    const auto is_arm = [&](const std::optional<Section>& section) {
      return section && section->thickness <= kThickRoot * walk.thinnest;
    };
    while (walk.length <= high_ - low_) {
      const auto next = look(step);
      if (is_arm(next)) {
        walk.length += step;
        walk.last = *next;
        walk.thinnest = std::min(walk.thinnest, next->thickness);
        continue;
      }
      walk.has_root = next.has_value();
      double low = 0;
      double high = step;
      std::optional<Section> last;
      for (int i = 0; i < kBisections; ++i) {
        const double middle = 0.5 * (low + high);
        const auto section = look(middle);
        if (is_arm(section)) {
          low = middle;
          last = section;
        } else {
          high = middle;
        }
      }
      walk.length += low;
      walk.last = last.value_or(walk.last);
      break;
    }
    return walk;
  }

  /** Numbers the corners of the mesh: those of several faces in one place are one. */
  void WeldCorners() {
    std::map<std::array<std::int64_t, 3>, std::uint32_t> numbers;
    for (const Vec3& vertex : part_.mesh.vertices) {
      const auto key = [&](Eigen::Index k) { return std::llround(vertex[k] / kWeld); };
      const std::array<std::int64_t, 3> at{key(0), key(1), key(2)};
      corners_.push_back(
          numbers.try_emplace(at, static_cast<std::uint32_t>(numbers.size())).first->second);
    }
    corner_count_ = numbers.size();
  }

  [[nodiscard]] bool IsBeyond(const BentArm& arm, std::uint32_t vertex) const {
    return (part_.mesh.vertices[vertex] - arm.root_B).dot(arm.axis_B) > kBeyondRoot * arm.length;
  }

  /** Finds the corner beyond the root that is nearest to a place on a face; of all faces where the
   part has no such one. */
  [[nodiscard]] std::optional<std::uint32_t> FindCornerBeyond(const BentArm& arm,
                                                              std::uint32_t face,
                                                              const Vec3& p_B) const {
    std::size_t begin = 0;
    std::size_t end = part_.mesh.triangles.size();
    if (face < part_.faces.size()) {
      begin = part_.faces[face].first_triangle;
      end = begin + part_.faces[face].triangle_count;
    }
    double nearest = std::numeric_limits<double>::infinity();
    std::optional<std::uint32_t> corner;
    for (std::size_t t = begin; t < end; ++t) {
      for (const std::uint32_t v : part_.mesh.triangles[t]) {
        const double distance = (part_.mesh.vertices[v] - p_B).norm();
        if (IsBeyond(arm, v) && distance < nearest) {
          nearest = distance;
          corner = corners_[v];
        }
      }
    }
    return corner;
  }

  [[nodiscard]] bool HasCornerOfArm(const std::array<std::uint32_t, 3>& triangle) const {
    return std::any_of(triangle.begin(), triangle.end(),
                       [this](std::uint32_t v) { return is_arm_[corners_[v]]; });
  }

  /** Marks the corners of the mesh that hang together with one beyond the root. */
  void MarkArm(const BentArm& arm, std::uint32_t seed) {
    is_arm_[seed] = true;
    for (bool has_grown = true; has_grown;) {
      has_grown = false;
      for (const auto& triangle : part_.mesh.triangles) {
        if (!HasCornerOfArm(triangle)) {
          continue;
        }
        for (const std::uint32_t v : triangle) {
          if (!is_arm_[corners_[v]] && IsBeyond(arm, v)) {
            is_arm_[corners_[v]] = true;
            has_grown = true;
          }
        }
      }
    }
  }

  /** Lists the faces that hang together beyond the root with a place on a face. */
  std::set<std::uint32_t> CollectFaces(const BentArm& arm, std::uint32_t face, const Vec3& p_B) {
    is_arm_.assign(corner_count_, false);
    const std::optional<std::uint32_t> seed = FindCornerBeyond(arm, face, p_B);
    if (!seed) {
      return {};
    }
    MarkArm(arm, *seed);
    std::set<std::uint32_t> faces;
    for (std::uint32_t f = 0; f < part_.faces.size(); ++f) {
      const product::Face& of = part_.faces[f];
      const auto begin = part_.mesh.triangles.begin() + of.first_triangle;
      if (std::any_of(begin, begin + of.triangle_count,
                      [this](const auto& triangle) { return HasCornerOfArm(triangle); })) {
        faces.insert(f);
      }
    }
    return faces;
  }

  void SetRanges(BentArm* arm) const {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    arm->range = {kNone, -kNone};
    arm->across = {kNone, -kNone};
    const Vec3 across_B = arm->axis_B.cross(arm->aside_B);
    for (std::size_t v = 0; v < part_.mesh.vertices.size(); ++v) {
      if (!is_arm_[corners_[v]]) {
        continue;
      }
      const Vec3 d = part_.mesh.vertices[v] - arm->root_B;
      const auto extend = [](double value, std::array<double, 2>* range) {
        *range = {std::min((*range)[0], value), std::max((*range)[1], value)};
      };
      extend(d.dot(arm->aside_B), &arm->range);
      extend(d.dot(across_B), &arm->across);
    }
  }

  const Part& part_;
  Vec3 way_B_;
  double low_{std::numeric_limits<double>::infinity()};
  double high_{-std::numeric_limits<double>::infinity()};
  std::vector<std::uint32_t> corners_;  // Indexed by vertex.
  std::size_t corner_count_{0};
  std::vector<bool> is_arm_;  // Indexed by corner.
  std::set<std::uint32_t> faces_;
};

/** Whether a contact is on an arm, as far as the two overlap. */
bool IsOnArm(const BentArm& arm, const Vec3& p_B) {
  constexpr double kBeside = 1e-3;  // [m]: what overlaps lies beside the part. A choice.
  const Vec3 d = p_B - arm.root_B;
  const auto is_in = [](double value, const std::array<double, 2>& range) {
    return value > range[0] - kBeside && value < range[1] + kBeside;
  };
  return d.dot(arm.axis_B) > 0 && is_in(d.dot(arm.aside_B), arm.range) &&
         is_in(d.dot(arm.axis_B.cross(arm.aside_B)), arm.across);
}

/** Makes an arm that goes all the way round one: its axis in the middle of it, and radii. */
void MakeRound(const Vec3& p_B, const Vec3& inward_B, BentArm* arm) {
  const Vec3 across_B = arm->axis_B.cross(arm->aside_B);
  arm->root_B += 0.5 * (arm->range[0] + arm->range[1]) * arm->aside_B +
                 0.5 * (arm->across[0] + arm->across[1]) * across_B;
  const double outer =
      0.5 * std::max(arm->range[1] - arm->range[0], arm->across[1] - arm->across[0]);
  // All of it bends, whatever its section is: from the axis to the corners of a square.
  arm->range = {0, std::sqrt(2.0) * outer};
  arm->across = {0, 0};
  arm->is_round = true;
  arm->bends_inwards = inward_B.dot(p_B - arm->root_B) < 0;
}

}  // namespace

std::vector<BentArm> FindBentArms(const product::Product& product, const GivingPair& give,
                                  const GivingSamples& samples, double inward_sign,
                                  const Vec3& way_W) {
  const spatial::Pose X_BW = product.occurrences[give.flexible.index()].X_WB.Inverse();
  const Part& part = product.part_of(give.flexible);
  ArmSearch search(part, X_BW.q() * way_W);
  std::vector<std::pair<double, std::uint32_t>> order;  // By depth, the deepest first.
  double deepest = 0;
  for (const auto& [face, met] : samples.by_face) {
    order.emplace_back(met.contact.distance, face);
    deepest = std::max(deepest, -met.contact.distance);
  }
  std::sort(order.begin(), order.end());
  const bool is_own = give.moved == give.flexible;
  const auto place = [&](const contact::Contact& contact, double travelled) {
    return X_BW * (is_own ? Vec3(contact.p_WC - travelled * way_W) : contact.p_WC);
  };
  std::vector<BentArm> arms;
  std::set<std::uint32_t> known;  // Faces of the arms.
  int tries = 0;
  for (const auto& [distance, face] : order) {
    const MetFace& at = samples.by_face.at(face);
    const contact::Contact& contact = at.contact;
    if (-distance < kShareOfDeepest * deepest || known.count(face) > 0 || tries >= kMostArmTries) {
      continue;
    }
    ++tries;
    const Vec3 aside_W = contact.nhat_W - contact.nhat_W.dot(way_W) * way_W;
    const Vec3 inward_B = X_BW.q() * (inward_sign * aside_W.normalized());
    const Vec3 p_B = place(contact, at.travelled);
    auto arm = search.Find(p_B, inward_B, -distance, face);
    if (!arm) {
      continue;
    }
    // A wall all around is met from opposite sides.
    const auto is_opposite = [&](const contact::Contact& other, double other_travelled) {
      return other.distance < 0 && other.nhat_W.dot(contact.nhat_W) < kOppositeNormals &&
             IsOnArm(*arm, place(other, other_travelled));
    };
    const bool is_round =
        std::any_of(samples.by_face.begin(), samples.by_face.end(), [&](const auto& other) {
          const MetFace& met = other.second;
          return is_opposite(met.contact, met.travelled) ||
                 is_opposite(met.opposite, met.opposite_travelled);
        });
    if (is_round) {
      MakeRound(p_B, inward_B, &*arm);
    }
    known.insert(search.faces().begin(), search.faces().end());
    known.insert(face);
    arms.push_back(*arm);
  }
  return arms;
}

}  // namespace hvas::sequence
