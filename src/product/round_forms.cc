#include "product/round_forms.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/units.h"
#include "product/mesh_ray.h"

namespace hvas::product {
namespace {

// Countersinks: ISO 15065 and DIN 74 have seats of 1.8 to 2.1 times the through hole, with 82 to
// 120 deg.
constexpr double kLeastCountersink = 1.4;  // Ratio of radii.
constexpr double kLeastCountersinkAngle = units::FromDeg(55);
constexpr double kLargestCountersinkAngle = units::FromDeg(130);
// Counterbores: DIN 974-1 has 1.6 to 2.2 times the through hole.
constexpr double kLeastCounterbore = 1.25;
constexpr double kLargestCounterbore = 2.6;
constexpr double kLargestGrooveWidth = 0.5;  // Of the diameter of its shaft or bore.
constexpr double kLargestGrooveDepth = 0.3;  // Of that diameter.
constexpr double kLargestChamfer = 0.2;      // Radial, of the diameter.
constexpr double kLeastShaftLength = 0.25;   // Of its diameter; shorter ones are rims of discs.

enum class EndState { kUnknown, kOpen, kClosed };

class RoundFormReader {
 public:
  RoundFormReader(const Part& part, const RingSet& set, double tolerance)
      : part_(part), set_(set), tolerance_(tolerance) {}

  void Read(RingChain chain) {
    if (set_.rings[chain.front().ring].is_inward) {
      ReadHole(std::move(chain));
    } else {
      ReadShaft(std::move(chain));
    }
  }

  std::vector<Form> Take() {
    std::vector<Form> forms = std::move(holes_);
    for (std::vector<Form>* more : {&shafts_, &grooves_, &chamfers_}) {
      forms.insert(forms.end(), more->begin(), more->end());
    }
    return forms;
  }

 private:
  struct Step {
    double radius{0};
    double low{0}, high{0};
  };

  /** What a chain is, seen from its entry. */
  struct Account {
    std::vector<const ChainItem*> lead;   // Before the first cylinder.
    std::vector<const ChainItem*> tail;   // After the last.
    std::vector<const ChainItem*> steps;  // Cylinders, without the floors of grooves.
    std::vector<double> radii;            // Of the steps, equal neighbours once.
    bool has_flat_shoulder{false};        // Between the first two steps.
  };

  [[nodiscard]] const Ring& ring(const ChainItem& item) const { return set_.rings[item.ring]; }

  [[nodiscard]] double near_radius(const ChainItem& item) const {
    return ring(item).ends[item.near].radius;
  }

  [[nodiscard]] double far_radius(const ChainItem& item) const {
    return ring(item).ends[item.far()].radius;
  }

  [[nodiscard]] Vec3 near_point(const ChainItem& item) const { return ring(item).point(item.near); }

  [[nodiscard]] Vec3 far_point(const ChainItem& item) const { return ring(item).point(item.far()); }

  static RingChain Reversed(RingChain chain) {
    std::vector<std::vector<FaceId>> shoulders;
    for (const ChainItem& item : chain) {
      shoulders.push_back(item.shoulder);
    }
    std::reverse(chain.begin(), chain.end());
    for (std::size_t i = 0; i < chain.size(); ++i) {
      chain[i].near = chain[i].far();
      chain[i].shoulder = i == 0 ? std::vector<FaceId>{} : shoulders[chain.size() - i];
    }
    return chain;
  }

  /** What is at one end of a chain: by the edges there, else by looking along the axis. */
  [[nodiscard]] EndState FindState(const ChainItem& item, std::size_t end) const {
    const Ring& at = ring(item);
    const RingEnd& seen = at.ends[end];
    if (seen.radius < 0.02 * at.ends[1 - end].radius) {
      return EndState::kClosed;  // The tip of a drill, or of a pointed shaft.
    }
    constexpr double kMost = 0.6;  // Share of the sectors (docs/algorithms/features.md).
    if (seen.convex > kMost * seen.sectors) {
      return EndState::kOpen;
    }
    if (seen.concave > kMost * seen.sectors) {
      return EndState::kClosed;
    }
    if (!at.is_inward || seen.sectors == 0) {
      // The rim of a surface without a solid is an end; what runs on tangentially is not.
      return seen.open > kMost * seen.sectors ? EndState::kOpen : EndState::kUnknown;
    }
    const Vec3 out = (end == 1 ? 1.0 : -1.0) * at.axis_B;
    const Vec3 middle = 0.5 * (at.point(0) + at.point(1));
    const double reach = 0.5 * (at.high - at.low) + 2 * seen.radius;
    return IsBlocked(part_, middle, out, reach) ? EndState::kClosed : EndState::kOpen;
  }

  /** A ring between two cylinders that goes further into the material than both: floors of
   rectangular and round grooves. */
  [[nodiscard]] bool IsGroove(const RingChain& chain, std::size_t i) const {
    if (i == 0 || i + 1 >= chain.size()) {
      return false;
    }
    const Ring& floor = ring(chain[i]);
    const Ring& before = ring(chain[i - 1]);
    const Ring& after = ring(chain[i + 1]);
    if (before.kind != SurfaceKind::kCylinder || after.kind != SurfaceKind::kCylinder) {
      return false;
    }
    const double sense = floor.is_inward ? 1 : -1;
    double bottom = floor.surface.radius;
    if (floor.kind == SurfaceKind::kTorus) {
      if (floor.surface.outward > 0) {
        return false;
      }
      bottom += sense * floor.surface.second;
    } else if (floor.kind != SurfaceKind::kCylinder || chain[i].shoulder.empty() ||
               chain[i + 1].shoulder.empty()) {
      return false;
    }
    const double wall = floor.is_inward ? std::max(before.radius(), after.radius())
                                        : std::min(before.radius(), after.radius());
    const double depth = sense * (bottom - wall);
    return depth > tolerance_ && depth <= kLargestGrooveDepth * 2 * wall &&
           floor.high - floor.low <= kLargestGrooveWidth * 2 * wall;
  }

  void AddGroove(const RingChain& chain, std::size_t i) {
    const Ring& floor = ring(chain[i]);
    const double sense = floor.is_inward ? 1 : -1;
    const double bottom =
        floor.radius() + (floor.kind == SurfaceKind::kTorus ? sense * floor.surface.second : 0);
    const double wall = floor.is_inward
                            ? std::max(ring(chain[i - 1]).radius(), ring(chain[i + 1]).radius())
                            : std::min(ring(chain[i - 1]).radius(), ring(chain[i + 1]).radius());
    Form form;
    form.kind = FormKind::kGroove;
    if (floor.feature.is_valid()) {
      form.features.push_back(floor.feature);
    }
    form.faces = floor.faces;
    for (const auto* shoulder : {&chain[i].shoulder, &chain[i + 1].shoulder}) {
      form.faces.insert(form.faces.end(), shoulder->begin(), shoulder->end());
    }
    form.origin_B = 0.5 * (floor.point(0) + floor.point(1));
    form.axis_B = floor.axis_B;
    form.diameter = 2 * bottom;
    form.depth = sense * (bottom - wall);
    grooves_.push_back(std::move(form));
  }

  [[nodiscard]] std::optional<Account> Describe(const RingChain& chain) const {
    Account account;
    for (std::size_t i = 0; i < chain.size(); ++i) {
      if (ring(chain[i]).kind != SurfaceKind::kCylinder) {
        (account.steps.empty() ? account.lead : account.tail).push_back(&chain[i]);
        continue;
      }
      if (IsGroove(chain, i)) {
        continue;
      }
      account.tail.clear();
      const double radius = ring(chain[i]).radius();
      if (account.radii.empty() || std::abs(account.radii.back() - radius) > tolerance_) {
        account.radii.push_back(radius);
        if (account.radii.size() == 2) {
          account.has_flat_shoulder = !chain[i].shoulder.empty();
        }
      }
      account.steps.push_back(&chain[i]);
    }
    return account.steps.empty() ? std::nullopt : std::optional(account);
  }

  /** Radial width of what guides into the first step [m]; positive where it widens a hole or
   narrows a shaft towards the entry. */
  [[nodiscard]] double CalcLeadIn(const Account& account, bool is_hole) const {
    if (account.lead.empty()) {
      return 0;
    }
    const double sense = is_hole ? 1 : -1;
    const double width = sense * (near_radius(*account.lead.front()) - account.radii.front());
    return std::max(0.0, width);
  }

  void AddMembers(const RingChain& chain, Form* form) const {
    for (const ChainItem& item : chain) {
      const Ring& member = ring(item);
      if (member.feature.is_valid()) {
        form->features.push_back(member.feature);
      }
      form->faces.insert(form->faces.end(), item.shoulder.begin(), item.shoulder.end());
      form->faces.insert(form->faces.end(), member.faces.begin(), member.faces.end());
    }
  }

  /** The flat bottom of a blind hole, where it has no other border than the hole's. */
  void AddFloor(const ChainItem& last, Form* form) const {
    for (const auto& [face, count] : ring(last).ends[last.far()].neighbours) {
      if (part_.faces[face.index()].surface.kind != SurfaceKind::kFreeform &&
          std::find(form->faces.begin(), form->faces.end(), face) == form->faces.end()) {
        form->faces.push_back(face);
      }
    }
  }

  /** Chamfers among the rings before the first and after the last step. */
  void AddChamfers(const Account& account, bool is_hole) {
    const auto add = [&](const ChainItem& item, double step_radius) {
      const Ring& cone = ring(item);
      const double width = std::abs(near_radius(item) - far_radius(item));
      const double outer = std::max(near_radius(item), far_radius(item));
      const double inner = std::min(near_radius(item), far_radius(item));
      const bool widens =
          is_hole ? inner > step_radius - 2 * tolerance_ : outer < step_radius + 2 * tolerance_;
      if (cone.kind != SurfaceKind::kCone || !widens || width > kLargestChamfer * 2 * step_radius) {
        return;
      }
      Form form;
      form.kind = FormKind::kChamfer;
      form.features.push_back(cone.feature);
      form.faces = cone.faces;
      form.origin_B = 0.5 * (cone.point(0) + cone.point(1));
      form.axis_B = cone.axis_B;
      form.angle = 2 * cone.surface.second;
      form.depth = cone.high - cone.low;
      form.lead_in = width;
      chamfers_.push_back(std::move(form));
    };
    for (const ChainItem* item : account.lead) {
      add(*item, account.radii.front());
    }
    for (const ChainItem* item : account.tail) {
      add(*item, account.radii.back());
    }
  }

  /** The entry of a hole that is open at both ends: the wide one, then the one with a lead-in, then
   the one at the positive end of the axis. */
  [[nodiscard]] bool IsEntryAtBack(const RingChain& chain) const {
    const auto front = Describe(chain);
    const RingChain reversed = Reversed(chain);
    const auto back = Describe(reversed);
    const double wide_front = std::max(front->radii.front(), near_radius(chain.front()));
    const double wide_back = std::max(back->radii.front(), near_radius(reversed.front()));
    if (std::abs(wide_front - wide_back) > tolerance_) {
      return wide_back > wide_front;
    }
    return chain.front().near == 0;
  }

  void ReadHole(RingChain chain) {
    if (!Describe(chain)) {
      return;
    }
    EndState entry = FindState(chain.front(), chain.front().near);
    EndState far = FindState(chain.back(), chain.back().far());
    const bool turn = entry == EndState::kOpen && far == EndState::kOpen ? IsEntryAtBack(chain)
                                                                         : far == EndState::kOpen;
    if (turn) {
      chain = Reversed(std::move(chain));
      std::swap(entry, far);
    }
    for (std::size_t i = 0; i < chain.size(); ++i) {
      if (IsGroove(chain, i)) {
        AddGroove(chain, i);
      }
    }
    const Account account = *Describe(chain);
    AddChamfers(account, true);
    if (entry != EndState::kOpen || far == EndState::kUnknown) {
      return;
    }
    Form form;
    const bool is_blind = far == EndState::kClosed;
    form.kind = is_blind ? FormKind::kBlindHole : FormKind::kThroughHole;
    form.origin_B = near_point(chain.front());
    form.axis_B = (chain.front().near == 0 ? 1.0 : -1.0) * ring(chain.front()).axis_B;
    form.diameter = 2 * *std::min_element(account.radii.begin(), account.radii.end());
    form.count = static_cast<int>(account.radii.size());
    form.lead_in = CalcLeadIn(account, true);
    const ChainItem& bottom = FindBottom(chain, is_blind);
    form.depth = (far_point(bottom) - form.origin_B).dot(form.axis_B);
    const double sink = account.lead.size() == 1 ? FindCountersink(account) : 0;
    const double ratio = account.radii.size() == 2 ? account.radii[0] / account.radii[1] : 0;
    if (sink > 0) {
      form.kind = FormKind::kCountersunkHole;
      form.angle = sink;
    } else if (account.radii.size() == 2 && account.has_flat_shoulder &&
               ratio >= kLeastCounterbore && ratio <= kLargestCounterbore) {
      form.kind = FormKind::kCounterboredHole;
    } else if (account.radii.size() > 1) {
      form.kind = FormKind::kSteppedHole;
    }
    AddMembers(chain, &form);
    if (is_blind) {
      AddFloor(chain.back(), &form);
    }
    holes_.push_back(std::move(form));
  }

  /** The last ring that counts for the depth: not the tip that a drill leaves. */
  [[nodiscard]] const ChainItem& FindBottom(const RingChain& chain, bool is_blind) const {
    const ChainItem& last = chain.back();
    const bool is_tip = is_blind && chain.size() > 1 && ring(last).kind == SurfaceKind::kCone &&
                        far_radius(last) < near_radius(last);
    return is_tip ? chain[chain.size() - 2] : last;
  }

  /** Included angle of a cone at the entry that can seat a head [rad]; 0 where there is none. */
  [[nodiscard]] double FindCountersink(const Account& account) const {
    const ChainItem& item = *account.lead.front();
    const double angle = 2 * ring(item).surface.second;
    const bool is_sink = ring(item).kind == SurfaceKind::kCone &&
                         near_radius(item) >= kLeastCountersink * account.radii.front() &&
                         angle >= kLeastCountersinkAngle && angle <= kLargestCountersinkAngle;
    return is_sink ? angle : 0;
  }

  void ReadShaft(RingChain chain) {
    if (!Describe(chain)) {
      return;
    }
    EndState tip = FindState(chain.front(), chain.front().near);
    EndState base = FindState(chain.back(), chain.back().far());
    // A point is the end of a shaft as well as a flat is.
    const auto is_free = [&](EndState state, const ChainItem& item, std::size_t end) {
      return state == EndState::kOpen || ring(item).ends[end].radius < tolerance_;
    };
    const bool front_free = is_free(tip, chain.front(), chain.front().near);
    const bool back_free = is_free(base, chain.back(), chain.back().far());
    if ((back_free && !front_free) || (front_free && back_free && IsTipAtBack(chain))) {
      chain = Reversed(std::move(chain));
      std::swap(tip, base);
    }
    for (std::size_t i = 0; i < chain.size(); ++i) {
      if (IsGroove(chain, i)) {
        AddGroove(chain, i);
      }
    }
    const Account account = *Describe(chain);
    AddChamfers(account, false);
    const bool stands = !(front_free && back_free) && base == EndState::kClosed;
    if (!(front_free || back_free) || (!stands && !(front_free && back_free))) {
      return;
    }
    Form form;
    form.origin_B = near_point(chain.front());
    form.axis_B = (chain.front().near == 0 ? -1.0 : 1.0) * ring(chain.front()).axis_B;
    form.diameter = 2 * *std::max_element(account.radii.begin(), account.radii.end());
    form.depth = (form.origin_B - far_point(chain.back())).dot(form.axis_B);
    form.count = static_cast<int>(account.radii.size());
    form.lead_in = CalcLeadIn(account, false);
    form.kind = !stands || IsTurned(form) ? FormKind::kShaft : FormKind::kBoss;
    if (form.kind == FormKind::kShaft && form.depth < kLeastShaftLength * form.diameter) {
      return;
    }
    AddMembers(chain, &form);
    shafts_.push_back(std::move(form));
  }

  /** Of two free ends the slimmer is the tip, then the one with a lead-in, then the positive. */
  [[nodiscard]] bool IsTipAtBack(const RingChain& chain) const {
    const RingChain reversed = Reversed(chain);
    const auto front = Describe(chain);
    const auto back = Describe(reversed);
    if (std::abs(front->radii.front() - back->radii.front()) > tolerance_) {
      return back->radii.front() < front->radii.front();
    }
    const double lead = CalcLeadIn(*front, false) - CalcLeadIn(*back, false);
    return std::abs(lead) > tolerance_ ? lead < 0 : chain.front().near == 0;
  }

  /** Whether a shaft that stands on a face is the body of its part (a bolt), not a boss on it: half
   as long as the part along the axis, and not under a quarter of its size across. */
  [[nodiscard]] bool IsTurned(const Form& form) const {
    double along_low = 0;
    double along_high = 0;
    double across = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p((corner & 1) != 0 ? part_.box_B.high.x() : part_.box_B.low.x(),
                   (corner & 2) != 0 ? part_.box_B.high.y() : part_.box_B.low.y(),
                   (corner & 4) != 0 ? part_.box_B.high.z() : part_.box_B.low.z());
      const Vec3 q = p - form.origin_B;
      const double z = q.dot(form.axis_B);
      along_low = corner == 0 ? z : std::min(along_low, z);
      along_high = corner == 0 ? z : std::max(along_high, z);
      across = std::max(across, (q - z * form.axis_B).norm());
    }
    return form.depth >= 0.5 * (along_high - along_low) && 4 * form.diameter >= 2 * across;
  }

  const Part& part_;
  const RingSet& set_;
  double tolerance_;
  std::vector<Form> holes_, shafts_, grooves_, chamfers_;
};

}  // namespace

std::vector<Form> FindRoundForms(const Part& part, const RingSet& set,
                                 const std::vector<RingChain>& chains, double tolerance) {
  RoundFormReader reader(part, set, tolerance);
  for (const RingChain& chain : chains) {
    reader.Read(chain);
  }
  return reader.Take();
}

}  // namespace hvas::product
