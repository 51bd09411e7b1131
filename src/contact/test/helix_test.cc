// Threads that are modelled: found in meshes, and their contact against closed forms.

#include "contact/helix.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "contact/helix_fit.h"
#include "contact/scene.h"
#include "contact/shape_data.h"
#include "contact/shape_io.h"
#include "contact/test/parts.h"
#include "contact/test/thread_mesh.h"

namespace hvas::contact {
namespace {

using testing::ThreadMesh;
using testing::ThreadSize;

constexpr double kNutOutside = 8e-3;  // [m]

std::vector<Helix> Find(ShapeSource source, const spatial::Pose& X_WB = {}) {
  for (Vec3& v : source.vertices) {
    v = X_WB * v;
  }
  for (spatial::Surface& face : source.faces) {
    face = spatial::Transform(X_WB, face);
  }
  return FindHelices(MakeMesh(source, Vec3::Zero()), source.faces);
}

TEST(HelixFit, FindsBoltsAndNutsOfBothSensesAnywhere) {
  Random random(3);
  for (const ThreadSize& size :
       {ThreadSize{}, ThreadSize{2e-3, 8e-3, 1.2e-3, 0.2, 1},
        ThreadSize{1.25e-3, 4e-3, 0.7e-3, 0.25, -1}, ThreadSize{0.7e-3, 2e-3, 0.38e-3, 0.2, 1},
        ThreadSize{3e-3, 6e-3, 1.0e-3, 0.4, 1}}) {
    for (const double outside : {0.0, 2 * size.crest}) {
      const spatial::Pose X_WB(
          spatial::RotationFromVector(
              Vec3(random.Uniform(-2, 2), random.Uniform(-2, 2), random.Uniform(-2, 2))),
          Vec3(random.Uniform(-0.1, 0.1), random.Uniform(-0.1, 0.1), 0.05));
      const auto found = Find(ThreadMesh(size, 6 * size.pitch, 0, outside), X_WB);
      ASSERT_EQ(found.size(), 1u) << "pitch " << size.pitch << ", outside " << outside;
      const Helix& helix = found[0];
      EXPECT_NEAR(helix.pitch, size.pitch, 1e-3 * size.pitch);
      EXPECT_EQ(helix.sense, size.sense);
      EXPECT_EQ(helix.outward, outside > 0 ? -1 : 1);
      EXPECT_NEAR(helix.largest_radius, size.crest, 0.01 * size.depth);
      EXPECT_NEAR(helix.least_radius, size.crest - size.depth, 0.02 * size.depth);
      const Vec3 axis_W = X_WB.q() * Vec3::UnitZ();
      EXPECT_LT(helix.axis.cross(axis_W).norm(), 1e-3);
      EXPECT_LT(axis_W.cross(helix.origin - X_WB.p()).norm(), 0.01 * size.depth);
      EXPECT_GT(helix.high - helix.low, 4.5 * size.pitch);
    }
  }
}

TEST(HelixFit, FindsShortOnes) {
  const ThreadSize size;
  for (const double turns : {2.0, 2.5, 3.0, 4.0, 5.0}) {
    for (const double outside : {0.0, kNutOutside}) {
      const auto found = Find(ThreadMesh(size, turns * size.pitch, 60e-6, outside));
      ASSERT_EQ(found.size(), 1u) << turns << " turns, outside " << outside;
      EXPECT_NEAR(found[0].pitch, size.pitch, 1e-3 * size.pitch);
      EXPECT_NEAR(found[0].high - found[0].low, turns * size.pitch, 0.1 * size.pitch);
    }
  }
}

TEST(HelixFit, FindsNoneInWhatIsTurned) {
  EXPECT_TRUE(Find(testing::Bushing(5e-3, 10e-3, 30e-3)).empty());
  // Grooves side by side, as threads are drawn that do not rise.
  ShapeSource grooves;
  constexpr int kN = 48;
  constexpr int kRows = 240;
  for (int k = 0; k <= kRows; ++k) {
    for (int j = 0; j < kN; ++j) {
      const double z = k * 1.25e-3 / kN;
      const double r = ThreadSize{}.RadiusAt(z);
      const double angle = 2 * std::numbers::pi * j / kN;
      grooves.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  }
  const auto at = [](int k, int j) { return static_cast<std::uint32_t>(k * kN + j % kN); };
  for (int k = 0; k < kRows; ++k) {
    for (int j = 0; j < kN; ++j) {
      grooves.triangles.push_back({at(k, j), at(k, j + 1), at(k + 1, j + 1)});
      grooves.triangles.push_back({at(k, j), at(k + 1, j + 1), at(k + 1, j)});
    }
  }
  grooves.triangle_face.assign(grooves.triangles.size(), 0);
  grooves.faces.resize(2);
  grooves.faces[1] = {spatial::SurfaceKind::kCylinder, Vec3::Zero(), Vec3::UnitZ(), 4e-3, 0, 1};
  EXPECT_TRUE(Find(grooves).empty());
}

TEST(Helix, DistanceGrowsAlongItsGradientAsItself) {
  const auto found = Find(ThreadMesh({}, 8e-3, 0, 0));
  ASSERT_EQ(found.size(), 1u);
  const Helix& helix = found[0];
  Random random(5);
  double worst = 0;
  for (int i = 0; i < 5000; ++i) {
    // From a place beside the thread to its surface, and from there along the normal.
    const double angle = random.Uniform(0, 2 * std::numbers::pi);
    const double r = random.Uniform(3.2e-3, 4.1e-3);
    Vec3 p(r * std::cos(angle), r * std::sin(angle), random.Uniform(2e-3, 6e-3));
    for (int step = 0; step < 5; ++step) {
      const HelixDistance at = CalcHelixDistance(helix, p);
      EXPECT_NEAR(at.gradient.norm(), 1, 1e-12);
      p -= at.distance * at.gradient;
    }
    const HelixDistance on = CalcHelixDistance(helix, p);
    ASSERT_LT(std::abs(on.distance), 1e-9);
    constexpr double kOff = 20e-6;
    const HelixDistance off = CalcHelixDistance(helix, p + kOff * on.gradient);
    // In the root the other flank may be nearer from there.
    if (off.gradient.dot(on.gradient) > 0.999) {
      worst = std::max(worst, std::abs(off.distance - kOff));
    } else {
      EXPECT_LT(off.distance, kOff + 0.1e-6);
    }
    // The same after any part of a turn with its share of the pitch.
    const double turn = random.Uniform(-1, 1);
    const Vec3 turned = helix.origin + turn * helix.pitch * helix.axis +
                        Eigen::AngleAxisd(2 * std::numbers::pi * turn, helix.axis) *
                            (p + kOff * on.gradient - helix.origin);
    // To what the arc tangent is exact to.
    EXPECT_NEAR(CalcHelixDistance(helix, turned).distance, off.distance, 1e-11);
  }
  EXPECT_LT(worst, 0.1e-6);
}

TEST(Helix, LimitChangesNothingBelowIt) {
  const auto found = Find(ThreadMesh({}, 8e-3, 0, kNutOutside));
  ASSERT_EQ(found.size(), 1u);
  Random random(6);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p(random.Uniform(-5e-3, 5e-3), random.Uniform(-5e-3, 5e-3), random.Uniform(0, 8e-3));
    const double limit = random.Uniform(-0.2e-3, 0.2e-3);
    const double all = CalcHelixDistance(found[0], p).distance;
    const double limited = CalcHelixDistance(found[0], Locate(found[0], p), limit).distance;
    EXPECT_TRUE(limited == all || (all >= limit && limited >= limit));
  }
}

/** A nut of six turns on a longer bolt; the two profiles are apart by the clearance across. */
class NutOnBolt : public ::testing::Test {
 protected:
  static constexpr double kClearance = 80e-6;
  static constexpr int kFine = 96;

  NutOnBolt() : bolt_(Bolt()), nut_(Nut()) { scene_.Add(bolt_, {}); }

  // Made once, as it takes seconds.
  static const std::shared_ptr<const Shape>& Bolt() {
    static const auto shape = testing::Build(ThreadMesh({}, 20e-3, 0, 0, kFine));
    return shape;
  }

  static const std::shared_ptr<const Shape>& Nut() {
    static const auto shape =
        testing::Build(ThreadMesh({}, 7.5e-3, kClearance, kNutOutside, kFine));
    return shape;
  }

  /** Deepest contact of the nut, some pitches up the bolt and turned on by so many turns. */
  double QueryAt(const Vec3& off, double turn) {
    const spatial::Pose X_WN(Quat(Eigen::AngleAxisd(2 * std::numbers::pi * turn, Vec3::UnitZ())),
                             Vec3(0, 0, 4 * size_.pitch + turn * size_.pitch) + off);
    QueryOptions options;
    options.margin = 100e-6;
    scene_.Query(*nut_, X_WN, options, &workspace_);
    return workspace_.deepest();
  }

  const ThreadSize size_;
  std::shared_ptr<const Shape> bolt_;
  std::shared_ptr<const Shape> nut_;
  Scene scene_;
  QueryWorkspace workspace_;
};

TEST_F(NutOnBolt, GapsOfFlanksAreThoseOfTheClosedForm) {
  ASSERT_EQ(bolt_->data().helices.size(), 1u);
  ASSERT_EQ(nut_->data().helices.size(), 1u);
  // Across the axis a clearance c leaves c cos 60 beside a flank of 60 degrees to the axis, less by
  // the rise; along the axis a shift s takes s sin 60 of one of the flanks.
  const double r = size_.crest - 0.5 * size_.depth;
  const double rise = std::numbers::sqrt3 / 2 * size_.pitch / (2 * std::numbers::pi * r);
  const double stretch = 1 / std::sqrt(1 + rise * rise);
  for (const double s : {-40e-6, -20e-6, 0.0, 20e-6, 40e-6}) {
    const double expected = stretch * (0.5 * kClearance - std::numbers::sqrt3 / 2 * std::abs(s));
    EXPECT_NEAR(QueryAt(Vec3(0, 0, s), 0), expected, 2.5e-6) << "shifted by " << 1e6 * s << " um";
  }
  // Across, all of one side comes nearer by s cos 60 at most.
  for (const double s : {10e-6, 30e-6, 60e-6}) {
    EXPECT_NEAR(QueryAt(Vec3(s, 0, 0), 0), stretch * 0.5 * (kClearance - s), 3e-6);
  }
}

TEST_F(NutOnBolt, ScrewMotionChangesNothing) {
  const Vec3 off(15e-6, -10e-6, 25e-6);
  const double before = QueryAt(off, 0);
  double least = before;
  double most = before;
  for (int i = 1; i <= 200; ++i) {
    const double now = QueryAt(off, 0.0137 * i);
    least = std::min(least, now);
    most = std::max(most, now);
  }
  EXPECT_LT(most - least, 1.5e-6);
}

TEST_F(NutOnBolt, TurningWithoutTheAdvanceMeetsTheFlank) {
  // A twentieth of a turn without its advance is a shift by a twentieth of the pitch.
  QueryOptions options;
  const spatial::Pose X_WN(Quat(Eigen::AngleAxisd(0.1 * std::numbers::pi, Vec3::UnitZ())),
                           Vec3(0, 0, 4 * size_.pitch));
  EXPECT_FALSE(scene_.IsFree(*nut_, X_WN, 2e-6, options, &workspace_));
  const spatial::Pose X_WN_advanced(X_WN.q(), X_WN.p() + 0.05 * size_.pitch * Vec3::UnitZ());
  EXPECT_TRUE(scene_.IsFree(*nut_, X_WN_advanced, 2e-6, options, &workspace_));
}

TEST_F(NutOnBolt, NormalsSeparate) {
  QueryAt(Vec3(20e-6, 0, 60e-6), 0.3);
  ASSERT_GT(workspace_.contacts().size(), 8u);
  for (const Contact& c : workspace_.contacts()) {
    EXPECT_NEAR(c.nhat_W.norm(), 1, 1e-9);
    if (c.distance < 0) {
      // The nut is pushed down, on the flanks that it was shifted into.
      EXPECT_LT(c.nhat_W.z(), 0);
    }
  }
}

TEST_F(NutOnBolt, MatesThatAnswerTakeTheThreadsOutOfContact) {
  std::vector<std::uint32_t> thread{0};
  const IgnoredPair ignored{BodyId{0}, thread, thread};
  QueryOptions options;
  options.ignored = {&ignored, 1};
  // Off to the side, as threads within a mate are: the ends of the nut are met by no thread.
  for (int i = 0; i < 40; ++i) {
    const double turn = 0.157 * i;
    const spatial::Pose X_WN(Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ())),
                             Vec3(85e-6 * std::cos(3 * turn), 85e-6 * std::sin(3 * turn),
                                  (4 + turn / (2 * std::numbers::pi)) * size_.pitch));
    EXPECT_FALSE(scene_.IsFree(*nut_, X_WN, 1e-6, {}, &workspace_)) << turn;
    EXPECT_TRUE(scene_.IsFree(*nut_, X_WN, 1e-6, options, &workspace_)) << turn;
  }
}

TEST_F(NutOnBolt, ThreadsAreKeptWithTheShape) {
  const auto kept = DeserialiseShape(SerialiseShape(*nut_));
  ASSERT_NE(kept, nullptr);
  ASSERT_EQ(kept->data().helices.size(), 1u);
  const double before = QueryAt(Vec3(30e-6, 0, 0), 0.2);
  nut_ = kept;
  EXPECT_EQ(QueryAt(Vec3(30e-6, 0, 0), 0.2), before) << "to the bit";
}

}  // namespace
}  // namespace hvas::contact
