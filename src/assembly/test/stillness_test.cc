// A part of each shape in products/ is held by a hand that stands still: it comes to rest, wherever
// it is, whatever it weighs and however often the tick is called.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "assembly/open_product.h"
#include "assembly/prepare_model.h"
#include "base/random.h"
#include "contact/test/parts.h"
#include "haptics/haptic_tick.h"
#include "simulation/fit_of_mate.h"
#include "simulation/held_part_maker.h"

namespace hvas::assembly {
namespace {

using haptics::HeldPart;
using simulation::Model;
using simulation::SequenceStep;
using spatial::Pose;

constexpr double kRestDistance = 1e-6;  // [m]
constexpr double kRestAngle = 10e-6;    // [rad]
constexpr double kRestTime = 0.5;       // [s]
constexpr double kHalf = 5;             // [s] before the kick, and after it.
constexpr double kKick = 50e-3;         // [rad]
constexpr double kPress = 3e-3;         // [m] of the hand into what is in its way.
constexpr double kLead = 0.5;           // [s] for the hand to get where it stands still.

enum class Place { kFree, kCaptured, kTable, kWall, kHole, kCorner };

/** Where the part is held, how it gets there, and what it weighs there. */
struct Still {
  Place place{Place::kFree};
  int variant{0};
  double start{0};  ///< Captured: from its place, [m] and [rad].
  int rate_hz{1000};
  double mass{0};  ///< [kg]; 0: as it is.
};

std::ostream& operator<<(std::ostream& out, const Still& still) {
  static constexpr const char* kNames[] = {"free", "captured", "table", "wall", "hole", "corner"};
  return out << kNames[static_cast<int>(still.place)] << ' ' << still.variant << ", start "
             << still.start << ", " << still.rate_hz << " Hz, " << still.mass << " kg";
}

/** Twenty poses, with rates and masses that differ from shape to shape. */
std::vector<Still> ListStills(std::size_t shape, const std::vector<int>& rates) {
  static constexpr std::array kMasses{0.0, 1e-3, 0.1, 1.0, 10.0};
  static constexpr std::array kStarts{1e-12, 1e-9, 1e-7, 1e-5, 1e-3, 1e-2, 1e-1};
  std::vector<Still> stills;
  const auto add = [&](Place place, int count) {
    for (int i = 0; i < count; ++i) {
      Still still{place, i, 0, 0, 0};
      still.rate_hz = rates[(stills.size() + shape) % rates.size()];
      still.mass = kMasses[(stills.size() * 2 + shape) % kMasses.size()];
      stills.push_back(still);
    }
  };
  add(Place::kFree, 3);
  add(Place::kCaptured, static_cast<int>(kStarts.size()));
  add(Place::kTable, 3);
  add(Place::kWall, 2);
  add(Place::kHole, 3);
  add(Place::kCorner, 2);
  for (Still& still : stills) {
    if (still.place == Place::kCaptured) {
      still.start = kStarts[static_cast<std::size_t>(still.variant)];
    }
  }
  return stills;
}

/** A box from -half to half, as a wall or a floor. */
const std::shared_ptr<const contact::Shape>& WallShape() {
  static const auto shape = contact::testing::Build(contact::testing::Block(Vec3(0.5, 0.5, 0.05)));
  return shape;
}

/** Lowest and highest of a part's box along a direction, from its origin [m]. */
std::pair<double, double> CalcExtent(const contact::Shape& shape, const Quat& q_WB,
                                     const Vec3& along_W) {
  const spatial::Box& box = shape.box_B();
  const Vec3 along_B = q_WB.conjugate() * along_W;
  const double middle = along_B.dot(box.centre());
  const double half = 0.5 * along_B.cwiseAbs().dot(box.size());
  return {middle - half, middle + half};
}

/** The product with all that comes before a part in its place, and the part in the hand. */
class StillHold {
 public:
  StillHold(const Model& model, const SequenceStep& step, const Still& still, std::uint64_t seed)
      : still_(still), step_(step), random_(seed) {
    MakeScene(model);
    MakePart(model);
    options_.dt = 1.0 / still.rate_hz;
  }

  /** Runs, and says what did not come to rest; empty: everything has. */
  std::string Run() {
    tick_ = std::make_unique<haptics::HapticTick>(options_, &scene_);
    for (const simulation::Body& body : bodies_) {
      tick_->SetProperties(contact::BodyId(body.occurrence.index()),
                           {body.mass.mass, body.mass.p_BoBcm_B, body.mass.I_BBcm_B,
                            haptics::BodyProperties().surface});
    }
    X_WH_ = {part_.X_WB_start.q(), part_.X_WB_start * part_.p_BoBcm_B};
    tick_->Take(&part_);
    if (!lead_W_.isZero(0)) {
      const Vec3 p_from = X_WH_.p();
      const int count = Ticks(kLead);
      for (int i = 1; i <= count; ++i) {
        X_WH_ = {X_WH_.q(), p_from + static_cast<double>(i) / count * lead_W_};
        Tick(lead_W_ / kLead);
      }
    }
    std::string trouble = HoldStill("held");
    const Vec3 axis = RandomUnit();
    X_WH_ = {(spatial::RotationFromVector(kKick * axis) * X_WH_.q()).normalized(), X_WH_.p()};
    return trouble + HoldStill("kicked");
  }

 private:
  void MakeScene(const Model& model) {
    bodies_ = model.bodies;
    parts_.resize(model.bodies.size());
    for (const simulation::Body& body : model.bodies) {
      const contact::BodyId id = scene_.Add(body.shape, body.X_WB_goal);
      scene_.SetOffsets(id, body.faces);
      scene_.SetEnabled(id, false);
      parts_[id.index()].X_WB = body.X_WB_start;
    }
    const auto place = [&](product::OccurrenceId id) {
      parts_[id.index()] = {simulation::Placement::kPlaced, model.bodies[id.index()].X_WB_goal, {}};
      scene_.SetEnabled(contact::BodyId(id.index()), true);
    };
    for (const SequenceStep& before : model.sequence.steps) {
      if (&before == &step_) {
        break;
      }
      if (before.kind == SequenceStep::Kind::kBase || before.kind == SequenceStep::Kind::kInsert) {
        place(before.occurrence);
        std::for_each(before.members.begin(), before.members.end(), place);
      }
    }
    scene_.SetGround(model.table_z);
    table_z_ = model.table_z;
  }

  void MakePart(const Model& model) {
    simulation::HeldPartMaker maker(model, parts_);
    SequenceStep step = step_;
    if (still_.place == Place::kHole && still_.variant != 2) {
      step.kind = SequenceStep::Kind::kRemove;
      parts_[step.occurrence.index()] = {simulation::Placement::kPlaced,
                                         model.bodies[step.occurrence.index()].X_WB_goal,
                                         {}};
    }
    part_ = *maker.Make(step, false);
    part_.drives.clear();
    for (const contact::BodyId body : part_.bodies) {
      scene_.SetEnabled(body, true);
    }
    if (still_.mass > 0) {
      part_.I_BBcm_B *= still_.mass / part_.mass;
      part_.mass = still_.mass;
    }
    Lay(model);
  }

  /** Sets where the part begins and where the hand leads it. */
  void Lay(const Model& model) {
    const Vec3 out_W = step_.extraction_W;
    const Pose X_goal = part_.X_WB_goal;
    const double engaged = std::clamp(step_.engage_distance, 2e-3, 0.1);
    const Vec3 p_free = model.centre_W + Vec3(1, 1, 0.5);
    switch (still_.place) {
      case Place::kFree:
        part_.X_WB_start = {RandomTurn(), p_free};
        break;
      case Place::kCaptured: {
        // Over its place along its way, with a goal that is so far away.
        part_.X_WB_start = {X_goal.q(), X_goal.p() + (engaged + 5e-3) * out_W};
        part_.X_WB_goal = {
            (spatial::RotationFromVector(still_.start * out_W) * X_goal.q()).normalized(),
            part_.X_WB_start.p() - still_.start * out_W};
        part_.lacks_partners = true;
        break;
      }
      case Place::kTable: {
        const Quat q = still_.variant == 0
                           ? model.bodies[step_.occurrence.index()].X_WB_start.q()
                           : RandomTurn();
        const double low = CalcExtent(*part_.shape, q, Vec3::UnitZ()).first;
        part_.X_WB_start = {q, Vec3(p_free.x(), p_free.y(), table_z_ - low + 1e-3)};
        lead_W_ = Vec3(0, 0, -1e-3 - kPress);
        break;
      }
      case Place::kWall:
      case Place::kCorner: {
        const Quat q = still_.variant == 0
                           ? model.bodies[step_.occurrence.index()].X_WB_start.q()
                           : RandomTurn();
        part_.X_WB_start = {q, p_free};
        AddWall(Vec3::UnitX());
        lead_W_ = Vec3(1e-3 + kPress, 0, 0);
        if (still_.place == Place::kCorner) {
          AddWall(Vec3::UnitY());
          AddWall(-Vec3::UnitZ());
          lead_W_ = (1e-3 + kPress) * Vec3(1, 1, -1);
        }
        break;
      }
      case Place::kHole:
        if (still_.variant == 1) {
          lead_W_ = 0.5 * engaged * out_W;
        } else if (still_.variant == 2) {
          part_.X_WB_start = {X_goal.q(), X_goal.p() + (engaged + 2e-3) * out_W};
          lead_W_ = -(0.5 * engaged + 2e-3) * out_W;
        }
        break;
    }
  }

  /** A wall at 1 mm from the part in a direction. */
  void AddWall(const Vec3& to_W) {
    const double high = CalcExtent(*part_.shape, part_.X_WB_start.q(), to_W).second;
    scene_.Add(WallShape(), {Quat::FromTwoVectors(Vec3::UnitZ(), to_W),
                             part_.X_WB_start.p() + (high + 1e-3 + 0.05) * to_W});
  }

  [[nodiscard]] int Ticks(double time) const {
    return static_cast<int>(std::lround(time * still_.rate_hz));
  }

  haptics::TickOutput Tick(const Vec3& v = Vec3::Zero()) {
    device::DeviceState state;
    state.t_ns = t_ns_ += 1'000'000'000 / still_.rate_hz;
    state.X_DH = X_WH_;
    state.V_DH.v = v;
    state.is_valid = true;
    return tick_->Tick(state);
  }

  /** The hand stands still; where the part is each tick is compared with where it is in the end. */
  std::string HoldStill(const std::string& when) {
    std::vector<Pose> poses;
    haptics::HoldState state = haptics::HoldState::kEmpty;
    for (int i = 0, count = Ticks(kHalf); i < count; ++i) {
      const haptics::TickOutput out = Tick();
      poses.push_back(out.X_WD);
      state = out.state;
    }
    const Pose X_end = poses.back();
    const auto moved = [&](const Pose& X) {
      return (X * part_.p_BoBcm_B - X_end * part_.p_BoBcm_B).norm();
    };
    const auto turned = [&](const Pose& X) {
      return spatial::RotationBetween(X_end.q(), X.q()).norm();
    };
    double last = 0;      // Time of the last unrest [s].
    double farthest = 0;  // In the second half: it does not come to rest at all.
    double most_turned = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const double d = moved(poses[i]);
      const double angle = turned(poses[i]);
      if (d > kRestDistance || angle > kRestAngle) {
        last = options_.dt * static_cast<double>(i + 1);
      }
      if (i >= poses.size() / 2) {
        farthest = std::max(farthest, d);
        most_turned = std::max(most_turned, angle);
      }
    }
    if (last <= kRestTime) {
      return {};
    }
    return when + " at rest after " + std::to_string(last) + " s in state " +
           haptics::ToString(state) + ", in the second half moved " + std::to_string(1e6 * farthest) +
           " um, turned " + std::to_string(1e6 * most_turned) + " urad; ";
  }

  Vec3 RandomUnit() {
    return Vec3(random_.Normal(), random_.Normal(), random_.Normal()).normalized();
  }

  Quat RandomTurn() {
    return Quat(random_.Normal(), random_.Normal(), random_.Normal(), random_.Normal())
        .normalized();
  }

  Still still_;
  const SequenceStep& step_;
  Random random_;
  haptics::TickOptions options_;
  contact::Scene scene_;
  std::vector<simulation::Body> bodies_;
  std::vector<simulation::PartState> parts_;
  HeldPart part_;
  std::unique_ptr<haptics::HapticTick> tick_;
  Pose X_WH_;
  Vec3 lead_W_{Vec3::Zero()};
  double table_z_{0};
  std::int64_t t_ns_{0};
};

std::shared_ptr<const Model> OpenModel(const std::string& name) {
  OpenOptions open;
  open.file = std::filesystem::path(HVAS_SOURCE_DIR) / "products" / (name + ".step");
  Diagnostics diagnostics;
  auto product = OpenProduct(open, &diagnostics);
  EXPECT_TRUE(product.has_value());
  auto model = PrepareModel(*std::move(product), {}, &diagnostics);
  EXPECT_TRUE(model.has_value());
  return *std::move(model);
}

/** The first insertion of each shape. */
std::vector<const SequenceStep*> ListShapes(const Model& model) {
  std::map<const contact::Shape*, const SequenceStep*> seen;
  std::vector<const SequenceStep*> steps;
  for (const SequenceStep& step : model.sequence.steps) {
    if (step.kind != SequenceStep::Kind::kInsert) {
      continue;
    }
    if (seen.emplace(model.bodies[step.occurrence.index()].shape.get(), &step).second) {
      steps.push_back(&step);
    }
  }
  return steps;
}

void ExpectRest(const std::string& name, const std::vector<std::string>& parts,
                const std::vector<int>& rates) {
  const auto model = OpenModel(name);
  std::size_t shape = 0;
  for (const SequenceStep* step : ListShapes(*model)) {
    const std::string path = model->product->occurrences[step->occurrence.index()].path;
    const bool is_wanted =
        parts.empty() || std::any_of(parts.begin(), parts.end(), [&](const std::string& part) {
          return path.find(part) != std::string::npos;
        });
    if (!is_wanted) {
      continue;
    }
    std::uint64_t seed = 1;
    for (const Still& still : ListStills(shape, rates)) {
      StillHold hold(*model, *step, still, seed++);
      EXPECT_EQ(hold.Run(), "") << path << ", " << still;
    }
    ++shape;
  }
}

TEST(StillnessTest, ABushingComesToRestInAStillHand) {
  ExpectRest("bushing", {}, {1000});
}

}  // namespace
}  // namespace hvas::assembly
