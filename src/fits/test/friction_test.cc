// Friction of pairs of materials: X11, W5.

#include "fits/friction.h"

#include <algorithm>
#include <string_view>

#include <gtest/gtest.h>

#include "fits/materials.h"

namespace hvas::fits {
namespace {

// Canudas de Wit et al. 1995, Table I, for 1 N: F_s 1.5, F_c 1, v_s 1 mm/s, sigma_2 0.4 N s/m.
TEST(FrictionLaw, IsStribecksCurve) {
  const FrictionLaw law{1.5, 1.0, 1e-3, 0.4, 1e5};
  EXPECT_EQ(law.CalcCoefficient(0), 1.5);
  EXPECT_NEAR(law.CalcCoefficient(1e-3), 1.0 + 0.5 * 0.36787944117144233 + 0.4e-3, 1e-15);
  EXPECT_NEAR(law.CalcCoefficient(0.1), 1.04, 1e-15);
}

TEST(FindFriction, KnowsAPairInEitherOrder) {
  const FrictionLaw otherwise{0.3, 0.2};
  for (const FrictionEntry& entry : FrictionTable()) {
    const FrictionLaw one = FindFriction(entry.a, entry.b, otherwise);
    const FrictionLaw other = FindFriction(entry.b, entry.a, otherwise);
    EXPECT_EQ(one.static_coefficient, entry.static_coefficient);
    EXPECT_EQ(one.kinetic_coefficient, entry.kinetic_coefficient);
    EXPECT_EQ(other.static_coefficient, one.static_coefficient);
    EXPECT_EQ(other.kinetic_coefficient, one.kinetic_coefficient);
  }
  const FrictionLaw none =
      FindFriction(FrictionSurface::kUnknown, FrictionSurface::kSteel, otherwise);
  EXPECT_EQ(none.static_coefficient, 0.3);
  EXPECT_EQ(none.kinetic_coefficient, 0.2);
}

// Sticking is never weaker than sliding, and every row says where it is from.
TEST(FrictionTable, IsSoundAndSourced) {
  for (const FrictionEntry& entry : FrictionTable()) {
    EXPECT_GE(entry.static_coefficient, entry.kinetic_coefficient);
    EXPECT_GT(entry.kinetic_coefficient, 0);
    EXPECT_LT(entry.static_coefficient, 1);
    EXPECT_FALSE(entry.source.empty());
    EXPECT_FALSE(entry.status.empty());
  }
}

// N4: every row of the long table has a source and a status; what laws use is in it.
TEST(JointFrictionTable, IsSourcedAndHasWhatTheLawsUse) {
  EXPECT_GE(JointFrictionTable().size(), 40U);
  for (const JointFriction& row : JointFrictionTable()) {
    EXPECT_LE(row.low, row.high) << row.pair;
    EXPECT_GT(row.low, 0);
    EXPECT_FALSE(row.source.empty());
    EXPECT_FALSE(row.status.empty());
  }
  for (const FrictionEntry& entry : FrictionTable()) {
    for (const double value : {entry.static_coefficient, entry.kinetic_coefficient}) {
      EXPECT_TRUE(std::any_of(
          JointFrictionTable().begin(), JointFrictionTable().end(),
          [value](const JointFriction& row) { return row.low == value || row.high == value; }))
          << value;
    }
  }
}

// DIN 7190-1, 5.2 states one number for each pair pressed along the axis. The rows of a pair are in
// the order of release and sliding, dry and oiled: what slides is held by less than what is still
// to be released, and what is oiled by less than what is dry.
TEST(JointFrictionTable, LongitudinalFitsHoldLessWhereTheySlideAndWhereTheyAreOiled) {
  const auto find = [](std::string_view pair, std::string_view state, std::string_view symbol) {
    const auto& table = JointFrictionTable();
    return std::find_if(table.begin(), table.end(), [&](const JointFriction& row) {
      return row.pair == pair && row.condition == state && row.symbol == symbol;
    });
  };
  int compared = 0;
  for (const JointFriction& row : JointFrictionTable()) {
    if (!row.condition.starts_with("longitudinal")) {
      continue;
    }
    SCOPED_TRACE(::testing::Message() << row.pair << ", " << row.condition << ", " << row.symbol);
    EXPECT_EQ(row.low, row.high);
    const auto released = find(row.pair, row.condition, "nu_ll");
    ASSERT_NE(released, JointFrictionTable().end());
    const auto dry = find(row.pair, "longitudinal, dry", row.symbol);
    if (row.symbol == "nu_rl") {
      EXPECT_LT(row.high, released->low);
      ++compared;
    }
    if (row.condition == "longitudinal, oiled" && dry != JointFrictionTable().end()) {
      EXPECT_LT(row.high, dry->low);
      ++compared;
    }
  }
  EXPECT_GT(compared, 20);
}

TEST(SurfaceOf, PutsTheMaterialsWhereTheyBelong) {
  const auto surface = [](const char* name) {
    return SurfaceOf(FindMaterial(name)->material->group);
  };
  EXPECT_EQ(surface("S235JR"), FrictionSurface::kSteel);
  EXPECT_EQ(surface("AISI 304"), FrictionSurface::kSteel);
  EXPECT_EQ(surface("EN-GJL-250"), FrictionSurface::kCastIron);
  EXPECT_EQ(surface("EN AW-6061-T6"), FrictionSurface::kLightMetal);
  EXPECT_EQ(surface("CuSn8"), FrictionSurface::kCopperAlloy);
  EXPECT_EQ(surface("POM-C"), FrictionSurface::kPolymer);
  EXPECT_EQ(SurfaceOf("titanium"), FrictionSurface::kUnknown);
}

}  // namespace
}  // namespace hvas::fits
