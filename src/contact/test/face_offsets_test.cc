// Faces as made: W1, W2, N2. Truth: the surfaces moved, parts rebuilt at the other size, and the
// closed forms of a tilted peg in a hole.

#include "contact/face_offsets.h"

#include <algorithm>
#include <optional>

#include <gtest/gtest.h>

#include "base/random.h"
#include "contact/refine.h"
#include "contact/scene.h"
#include "contact/test/parts.h"

namespace hvas::contact {
namespace {

using spatial::Pose;
using testing::Build;

constexpr double kHalfMicrometre = 0.5e-6;

// Faces of testing::Shaft, testing::Bushing and testing::Cup.
constexpr std::size_t kSide = 1;
constexpr std::size_t kBore = 3;

std::shared_ptr<const FaceOffsets> Make(const std::shared_ptr<const Shape>& shape,
                                        const std::vector<FaceOffset>& offsets) {
  return FaceOffsets::Make(shape, offsets).value();
}

std::shared_ptr<const FaceOffsets> Uniform(const std::shared_ptr<const Shape>& shape,
                                           const std::vector<double>& by_face) {
  std::vector<FaceOffset> offsets(by_face.size());
  for (std::size_t f = 0; f < by_face.size(); ++f) {
    offsets[f].uniform = by_face[f];
  }
  return Make(shape, offsets);
}

// A pair drawn at the same size: clearance comes from the offsets alone.
struct Pair {
  std::shared_ptr<const Shape> bushing, shaft;
};

const Pair& Pair40() {
  static const Pair pair{Build(testing::Bushing(20e-3, 30e-3, 60e-3)),
                         Build(testing::Shaft(20e-3, 80e-3))};
  return pair;
}

const Pair& Pair20() {
  static const Pair pair{Build(testing::Bushing(10e-3, 16e-3, 60e-3)),
                         Build(testing::Shaft(10e-3, 80e-3))};
  return pair;
}

const Pair& Pair6() {
  static const Pair pair{Build(testing::Bushing(3e-3, 20e-3, 15e-3)),
                         Build(testing::Shaft(3e-3, 20e-3))};
  return pair;
}

/** A shaft in a bushing, both with faces as made. */
class Fitted {
 public:
  Fitted(const Pair& pair, const FaceOffset& bore, const FaceOffset& side) : shaft_(pair.shaft) {
    std::vector<FaceOffset> offsets(kBore + 1);
    offsets[kBore] = bore;
    body_ = scene_.Add(pair.bushing, {});
    scene_.SetOffsets(body_, Make(pair.bushing, offsets));
    offsets.assign(kSide + 1, {});
    offsets[kSide] = side;
    held_ = Make(shaft_, offsets);
    options_.held_offsets = held_.get();
  }

  /** Of given diameters as made. */
  Fitted(const Pair& pair, double nominal, double hole, double shaft)
      : Fitted(pair, FaceOffset{0.5 * (nominal - hole), {}, 0, 0},
               FaceOffset{0.5 * (shaft - nominal), {}, 0, 0}) {}

  double Deepest(const Pose& X_WH) {
    scene_.Query(*shaft_, X_WH, options_, &work_);
    return work_.deepest();
  }

  [[nodiscard]] std::span<const Contact> contacts() const { return work_.contacts(); }

  /** Eccentricity at which the shaft begins to touch. */
  double Onset(double z, double angle) {
    double free = 0;
    double touching = 100e-6;
    while (touching - free > 1e-9) {
      const double e = 0.5 * (free + touching);
      const bool is_free = Deepest(Pose(Vec3(e * std::cos(angle), e * std::sin(angle), z))) > 0;
      (is_free ? free : touching) = e;
    }
    return 0.5 * (free + touching);
  }

 private:
  std::shared_ptr<const Shape> shaft_;
  std::shared_ptr<const FaceOffsets> held_;
  Scene scene_;
  BodyId body_;
  QueryOptions options_;
  QueryWorkspace work_;
};

// H7/g6 at its tightest: hole 40.000, shaft 39.991.
TEST(FaceOffsets, AClearanceOfNineMicrometresIsMetWhereItEnds) {
  Fitted fitted(Pair40(), 40e-3, 40e-3, 39.991e-3);
  for (int i = 0; i < 8; ++i) {
    EXPECT_NEAR(fitted.Onset(-10e-3, 0.77 * i), 4.5e-6, kHalfMicrometre) << i;
  }
}

// A dowel of 6 mm in H7/g6: hole 6.000..6.012, shaft 5.988..5.996.
TEST(FaceOffsets, ASmallDowelIsMetWhereItsClearanceEnds) {
  for (const double hole : {6.000e-3, 6.012e-3}) {
    for (const double shaft : {5.988e-3, 5.996e-3}) {
      Fitted fitted(Pair6(), 6e-3, hole, shaft);
      for (int i = 0; i < 5; ++i) {
        EXPECT_NEAR(fitted.Onset(-3e-3, 1.3 * i), 0.5 * (hole - shaft), kHalfMicrometre);
      }
    }
  }
}

// B(l) of W(1): a hole that narrows from its mouth, and a shaft whose rim finds it there.
TEST(FaceOffsets, AConicalHoleHoldsTheShaftAsItsProfileSays) {
  // From 20 um wider at the mouth (z = 60 mm) to 0 at the bottom, on the radius.
  const FaceOffset bore{0, {0, -20e-6}, 0, 60e-3};
  Fitted fitted(Pair40(), bore, FaceOffset{});
  for (const double z : {50e-3, 30e-3, 10e-3, 2e-3}) {
    EXPECT_NEAR(fitted.Onset(z, 0.3), 20e-6 * z / 60e-3, kHalfMicrometre) << "rim at " << z;
  }
  // The wall's normal leans with the slope.
  fitted.Deepest(Pose(Vec3(10.5e-6, 0, 30e-3)));
  ASSERT_FALSE(fitted.contacts().empty());
  for (const Contact& c : fitted.contacts()) {
    if (c.distance < 0) {
      EXPECT_NEAR(c.nhat_W.z(), 20e-6 / 60e-3, 0.05 * 20e-6 / 60e-3);
    }
  }
}

TEST(FaceOffsets, AProfileIsLinearBetweenItsStations) {
  const auto& shaft = Pair40().shaft;
  const FaceOffset waist{1e-6, {0, -30e-6, 10e-6}, 20e-3, 60e-3};
  std::vector<FaceOffset> by_face(kSide + 1);
  by_face[kSide] = waist;
  const auto offsets = Make(shaft, by_face);
  const auto at = [&](double z) {
    return offsets->At(kSide, Vec3(20e-3, 0, z - 40e-3)).offset;  // The box is centred at 40 mm.
  };
  for (const auto& [z, b] : {std::pair(0.0, 0.0),
                             {20e-3, 0.0},
                             {30e-3, -15e-6},
                             {40e-3, -30e-6},
                             {55e-3, 0.0},
                             {60e-3, 10e-6},
                             {80e-3, 10e-6}}) {
    EXPECT_NEAR(at(z), 1e-6 + b, 1e-12) << z;
  }
}

/** A shaft tilted by t so that the tip's corner on one side and the rim on the other, l along the
 side from the tip, are as far from the wall: at t2 both touch. The bushing's mouth is at z. */
Pose TwoPointPose(double d, double l, double t, double mouth_z) {
  // In the plane: the tip's corner at (-d/2, 0), the rim's partner at (d/2, l), turned by t.
  const double half_width = 0.5 * (d * std::cos(t) + l * std::sin(t));
  const double rim_x = 0.5 * d * std::cos(t) + l * std::sin(t);
  const double rim_z = -0.5 * d * std::sin(t) + l * std::cos(t);
  return {spatial::RotationFromVector({0, t, 0}), Vec3(half_width - rim_x, 0, mouth_z - rim_z)};
}

struct TwoPointCase {
  const char* name;
  const Pair* pair;
  double nominal, mouth_z, hole, shaft, l;
  double published;  // [rad], of the table in the closed forms' source.
};

double CalcTwoPointAngle(double D, double d, double l) {
  return std::atan2(l, d) - std::acos(D / std::hypot(d, l));
}

std::vector<TwoPointCase> TwoPointCases() {
  return {{"40 H7/g6 at 10", &Pair40(), 40e-3, 60e-3, 40.0125e-3, 39.983e-3, 10e-3, 2.967610e-3},
          {"40 H7/g6 at 50", &Pair40(), 40e-3, 60e-3, 40.0125e-3, 39.983e-3, 50e-3, 5.90139e-4},
          {"20 at 10", &Pair20(), 20e-3, 60e-3, 20e-3, 19.9e-3, 10e-3, 1.010171e-2},
          {"20 at 40", &Pair20(), 20e-3, 60e-3, 20e-3, 19.9e-3, 40e-3, 2.501559e-3}};
}

/** The least tilt at which the shaft has no room left. */
double FindTwoPointAngle(Fitted* fitted, const TwoPointCase& c, double l) {
  double free = 0;
  double wedged = 2 * CalcTwoPointAngle(c.hole, c.shaft, l);
  while (wedged - free > 1e-7) {
    const double t = 0.5 * (free + wedged);
    (fitted->Deepest(TwoPointPose(c.shaft, l, t, c.mouth_z)) > 0 ? free : wedged) = t;
  }
  return 0.5 * (free + wedged);
}

TEST(FaceOffsets, ATiltedShaftTouchesInTwoPointsAtTheClosedFormsAngle) {
  for (const TwoPointCase& c : TwoPointCases()) {
    const double truth = CalcTwoPointAngle(c.hole, c.shaft, c.l);
    EXPECT_NEAR(truth, c.published, 1e-5 * c.published) << c.name;
    Fitted fitted(*c.pair, c.nominal, c.hole, c.shaft);
    EXPECT_NEAR(FindTwoPointAngle(&fitted, c, c.l), truth, 0.02 * truth) << c.name;
  }
}

// The deepest contact on each side of the hole.
std::optional<std::pair<Contact, Contact>> FindBothSides(std::span<const Contact> contacts) {
  const Contact* tip = nullptr;
  const Contact* rim = nullptr;
  for (const Contact& c : contacts) {
    const Contact** side = c.p_WC.x() < 0 ? &tip : &rim;
    if (*side == nullptr || c.distance < (*side)->distance) {
      *side = &c;
    }
  }
  return tip != nullptr && rim != nullptr ? std::optional(std::pair(*tip, *rim)) : std::nullopt;
}

/** Two contacts lock without a load when the line through both lies in both friction cones;
 Nguyen, IJRR 7(3), 1988. */
bool CanWedge(const Contact& a, const Contact& b, double mu) {
  const Vec3 line = (b.p_WC - a.p_WC).normalized();
  const double cosine = 1 / std::hypot(1, mu);
  return line.dot(a.nhat_W) >= cosine && -line.dot(b.nhat_W) >= cosine;
}

TEST(FaceOffsets, WedgingEndsWhereTheDepthExceedsFrictionTimesDiameter) {
  for (const auto& [index, mu] : {std::pair<std::size_t, double>(0, 0.15), {2, 0.3}}) {
    const TwoPointCase c = TwoPointCases()[index];
    Fitted fitted(*c.pair, c.nominal, c.hole, c.shaft);
    const double truth = mu * c.shaft;
    double wedges = 0.5 * truth;
    double slides = 2 * truth;
    while (slides - wedges > 1e-6) {
      const double l = 0.5 * (wedges + slides);
      const double t = FindTwoPointAngle(&fitted, c, l);
      fitted.Deepest(TwoPointPose(c.shaft, l, t, c.mouth_z));
      const auto sides = FindBothSides(fitted.contacts());
      ASSERT_TRUE(sides) << "l " << l;
      (CanWedge(sides->first, sides->second, mu) ? wedges : slides) = l;
    }
    EXPECT_NEAR(0.5 * (wedges + slides), truth, 0.02 * truth) << c.name;
  }
}

/** The same solid as drawn at another size, and by offsets. */
struct Rebuilt {
  const char* name;
  std::shared_ptr<const Shape> nominal;
  std::vector<double> offsets;
  std::shared_ptr<const Shape> actual;
};

std::vector<Rebuilt> RebuiltParts() {
  std::vector<Rebuilt> parts;
  const auto add = [&](const char* name, const ShapeSource& nominal, std::vector<double> offsets,
                       const ShapeSource& actual) {
    parts.push_back({name, Build(nominal), std::move(offsets), Build(actual)});
  };
  const auto moved = [](ShapeSource source, double z) {
    for (Vec3& v : source.vertices) {
      v.z() += z;
    }
    for (spatial::Surface& s : source.faces) {
      s.origin.z() += z;
    }
    return source;
  };
  add("shaft", testing::Shaft(10e-3, 20e-3, 3e-6), {10e-6, -20e-6, -15e-6},
      moved(testing::Shaft(9.98e-3, 19.995e-3, 3e-6), -10e-6));
  // Offsets of opposite walls, 0.3 mm apart, that no single shift serves.
  add("thin sleeve", testing::Bushing(5e-3, 5.3e-3, 10e-3, 3e-6), {0, 30e-6, 0, 20e-6},
      testing::Bushing(4.98e-3, 5.33e-3, 10e-3, 3e-6));
  add("cup", testing::Cup(4e-3, 8e-3, 3e-3, 12e-3), {0, 12e-6, -8e-6, -9e-6, 14e-6},
      testing::Cup(4.009e-3, 8.012e-3, 3.014e-3, 11.992e-3));
  add("ball", testing::Ball(6e-3, 3e-6), {-25e-6}, testing::Ball(5.975e-3, 3e-6));
  add("ring", testing::Ring(6e-3, 2e-3, 3e-6), {40e-6}, testing::Ring(6e-3, 2.04e-3, 3e-6));
  // A cone's side moved by o along its normal: the radius grows by o / cos(half angle).
  const double slope = std::atan2(5e-3, 15e-3);
  const double wider = 18e-6 / std::cos(slope);
  add("cone", testing::Cone(10e-3, 5e-3, 15e-3, 3e-6), {0, 18e-6, 0},
      testing::Cone(10e-3 + wider, 5e-3 + wider, 15e-3, 3e-6));
  return parts;
}

// Independent evidence: the field and the trimming of the rebuilt part are its own.
TEST(FaceOffsets, OffsetsGiveThePartThatIsBuiltAtTheOtherSize) {
  constexpr Hit kNowhere{0, 1.0F, {0.0F, 0.0F, 1.0F}};
  for (const Rebuilt& part : RebuiltParts()) {
    const auto offsets = Uniform(part.nominal, part.offsets);
    const Shape::Data& nominal = part.nominal->data();
    const Shape::Data& actual = part.actual->data();
    const Vec3 to_actual = nominal.p_BC - actual.p_BC;
    Random random(17);
    int outside = 0;
    int compared = 0;
    for (std::uint32_t i = 0; i < nominal.shell.faces.size(); ++i) {
      SCOPED_TRACE(::testing::Message() << part.name << " sample " << i);
      const Vec3 drawn(static_cast<double>(nominal.shell.x[i]),
                       static_cast<double>(nominal.shell.y[i]),
                       static_cast<double>(nominal.shell.z[i]));
      const Vec3 p = drawn + offsets->ShiftOf(nominal.shell, i);
      // Not always zero: on a flat face, between a round rim and its chord, the part has ended.
      const double drawn_at = Refine(nominal, drawn, kNowhere, {}).distance;
      ASSERT_NEAR(Refine(actual, p + to_actual, kNowhere, {}).distance, drawn_at, 0.1e-6);
      // And anywhere near.
      const Vec3 q = p + Vec3(random.Uniform(-0.1e-3, 0.1e-3), random.Uniform(-0.1e-3, 0.1e-3),
                              random.Uniform(-0.1e-3, 0.1e-3));
      const Refined truth = Refine(actual, q + to_actual, kNowhere, {});
      const Refined result = RefineActual(nominal, offsets.get(), q, kNowhere, {});
      ASSERT_NEAR(result.distance, truth.distance, kHalfMicrometre);
      ++compared;
      outside += truth.distance > 0 ? 1 : 0;
      if (std::abs(truth.distance) > 20e-6 && truth.face == result.face) {
        EXPECT_GT(result.gradient.dot(truth.gradient), 0.9999);
      }
    }
    EXPECT_GT(outside, compared / 4) << part.name;
    EXPECT_LT(outside, compared - compared / 4) << part.name;
  }
}

TEST(FaceOffsets, RefusesWhatItCannotMean) {
  const auto& shaft = Pair6().shaft;
  const auto fails = [&](std::size_t face, const FaceOffset& offset) {
    std::vector<FaceOffset> offsets(face + 1);
    offsets[face] = offset;
    const auto made = FaceOffsets::Make(shaft, offsets);
    return !made && made.error().code == ErrorCode::kInvalid && !made.error().remedy.empty();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(fails(kSide, {nan, {}, 0, 0}));
  EXPECT_TRUE(fails(kSide, {1e-3, {}, 0, 0}));
  EXPECT_TRUE(fails(kSide, {200e-6, {0, 100e-6}, 0, 1e-2}));
  EXPECT_TRUE(fails(kSide, {0, {1e-6}, 0, 1e-2}));
  EXPECT_TRUE(fails(kSide, {0, {1e-6, nan}, 0, 1e-2}));
  EXPECT_TRUE(fails(kSide, {0, {1e-6, 2e-6}, 1e-2, 1e-2}));
  EXPECT_TRUE(fails(0, {0, {1e-6, 2e-6}, 0, 1e-2}));  // A plane has no axis.
  EXPECT_TRUE(fails(3, {}));
  EXPECT_FALSE(fails(kSide, {-20e-6, {1e-6, 2e-6}, 0, 1e-2}));
}

TEST(FaceOffsets, OffsetsOfAnotherShapeAreNotTaken) {
  Scene scene;
  const BodyId body = scene.Add(Pair40().bushing, {});
  scene.SetOffsets(body, Uniform(Pair6().bushing, {0, 0, 0, -100e-6}));
  QueryWorkspace work;
  scene.Query(*Pair40().shaft, Pose(Vec3(10e-6, 0, -10e-3)), {}, &work);
  EXPECT_NEAR(work.deepest(), -10e-6, kHalfMicrometre);
}

TEST(SolveShift, MovesEveryPlaneAsFarAsItShould) {
  Random random(5);
  int solved = 0;
  for (int i = 0; i < 300; ++i) {
    std::array<Vec3, 3> normals;
    std::array<double, 3> offsets{};
    for (std::size_t k = 0; k < 3; ++k) {
      normals[k] = Vec3(random.Normal(), random.Normal(), random.Normal()).normalized();
      offsets[k] = random.Uniform(-1e-4, 1e-4);
    }
    const Shift shift = SolveShift(normals, offsets);
    EXPECT_TRUE(shift.used & 1U);
    for (std::size_t k = 0; k < 3; ++k) {
      if ((shift.used >> k & 1U) != 0) {
        ++solved;
        EXPECT_NEAR(normals[k].dot(shift.s), offsets[k], 1e-15);
      }
    }
  }
  EXPECT_GT(solved, 700);
  // Two planes that face each other: the first is served.
  const std::array<Vec3, 2> facing{Vec3::UnitX(), -Vec3::UnitX()};
  const std::array<double, 2> apart{1e-5, 2e-5};
  EXPECT_EQ(SolveShift(facing, apart).s, Vec3(1e-5, 0, 0));
  EXPECT_EQ(SolveShift(facing, apart).used, 1U);
}

}  // namespace
}  // namespace hvas::contact
