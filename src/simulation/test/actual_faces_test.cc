// Faces as made have the clearance of their fit, W(4), and are left alone where it has none.

#include "simulation/actual_faces.h"

#include <algorithm>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "simulation/test/small_models.h"

namespace hvas::simulation {
namespace {

constexpr std::uint32_t kSide = 1;  // Faces of the peg and of the block.
constexpr std::uint32_t kBore = 3;

product::Product MakePeg(const std::string& code) {
  product::Product product = testing::PegInBlock();
  for (product::Mate& mate : product.mates) {
    if (mate.kind == product::MateKind::kAxisHole) {
      mate.fit = product::Fit{};
      mate.fit->code = code;
      mate.fit->nominal_diameter = 2 * testing::kBoreRadius;
    }
  }
  return product;
}

std::shared_ptr<const Model> CompilePeg(product::Product product, std::uint64_t seed) {
  CompileOptions options = testing::FastOptions();
  options.seed = seed;
  Diagnostics diagnostics;
  return *Compile(std::make_shared<product::Product>(std::move(product)), options, &diagnostics);
}

std::shared_ptr<const fits::FitForce> FitOf(const Model& model) {
  for (const ModelMate& mate : model.mates) {
    if (mate.fit != nullptr) {
      return mate.fit;
    }
  }
  return nullptr;
}

TEST(ActualFaces, HaveTheClearanceOfTheFitFromTheMouthInwards) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const auto model = CompilePeg(MakePeg("H7/g6"), seed);
    const auto fit = FitOf(*model);
    ASSERT_NE(fit, nullptr);
    const auto& hole = model->bodies[0].faces;
    const auto& shaft = model->bodies[1].faces;
    ASSERT_NE(hole, nullptr);
    ASSERT_NE(shaft, nullptr);
    const double shaft_offset = shaft->At(kSide, Vec3::Zero()).offset;
    EXPECT_NEAR(shaft_offset, 0.5 * fit->shaft_diameter() - testing::kBoreRadius, 1e-12);
    for (int i = 0; i <= 40; ++i) {
      const double depth = fit->length() * i / 40;
      // In the block's centred frame: its box is 25 mm high, the mouth on top.
      const Vec3 p(testing::kBoreRadius, 0, 0.5 * testing::kBlockHeight - depth);
      EXPECT_NEAR(-hole->At(kBore, p).offset - shaft_offset, fit->CalcClearance(depth), 1e-9)
          << "depth " << depth;
    }
  }
}

TEST(ActualFaces, StayAsDrawnWhereTheFitHasInterference) {
  const auto model = CompilePeg(MakePeg("H7/s6"), 1);
  ASSERT_NE(FitOf(*model), nullptr);
  for (const Body& body : model->bodies) {
    EXPECT_EQ(body.faces, nullptr);
  }
}

// A screw through a washer: the loose fit of the washer must not make the thread larger than drawn.
TEST(ActualFaces, StayAsDrawnWhereTheyAreAlsoAThread) {
  product::Product product = MakePeg("H11/c11");
  const auto axis = std::find_if(
      product.mates.begin(), product.mates.end(),
      [](const product::Mate& mate) { return mate.kind == product::MateKind::kAxisHole; });
  ASSERT_NE(axis, product.mates.end());
  product::Mate thread = *axis;
  thread.id = product::MateId{product.mates.size()};
  thread.fit->kind = product::FitKind::kThread;
  thread.fit->code.clear();
  product.mates.push_back(std::move(thread));
  const auto model = CompilePeg(std::move(product), 1);
  for (const Body& body : model->bodies) {
    EXPECT_EQ(body.faces, nullptr);
  }
}

/** A slot of 10 mm, 8 mm deep, and a tongue in it that is drawn as wide, less `clearance`, and
 `shift` beside the middle; the fit of its width. */
std::shared_ptr<const Model> CompileTongue(const std::string& code, double clearance,
                                           double shift) {
  product::Product product;
  product.name = "rig";
  const double y = 5e-3 - 0.5 * clearance;
  const auto slot = testing::AddPart(&product, "slot",
                                     contact::testing::Prism({{-15e-3, -4e-3},
                                                              {15e-3, -4e-3},
                                                              {15e-3, 8e-3},
                                                              {5e-3, 8e-3},
                                                              {5e-3, 0},
                                                              {-5e-3, 0},
                                                              {-5e-3, 8e-3},
                                                              {-15e-3, 8e-3}},
                                                             15e-3));
  const auto tongue =
      testing::AddPart(&product, "tongue",
                       contact::testing::Prism({{-y, 0}, {y, 0}, {y, 16e-3}, {-y, 16e-3}}, 15e-3));
  testing::Place(&product, slot, "slot");
  testing::Place(&product, tongue, "tongue", spatial::Pose(Vec3(0, shift, 0)));
  testing::Complete(&product);
  for (product::Mate& mate : product.mates) {
    if (mate.kind == product::MateKind::kPrismatic) {
      mate.fit->code = code;
    }
  }
  return CompilePeg(std::move(product), 1);
}

TEST(ActualFaces, WallsLeaveATongueThePlayOfItsFitWhereItIsDrawn) {
  constexpr std::uint32_t kSlotHigh = 3;  // Walls of the slot and sides of the tongue.
  constexpr std::uint32_t kSlotLow = 5;
  constexpr std::uint32_t kTongueHigh = 1;
  constexpr std::uint32_t kTongueLow = 3;
  for (const auto& [code, clearance, shift] :
       {std::tuple("H7/g6", 0.0, 0.0), std::tuple("H9/d9", 0.2e-3, 0.0),
        std::tuple("H9/d9", 0.2e-3, 0.1e-3), std::tuple("H7/p6", -20e-6, 0.0)}) {
    const auto model = CompileTongue(code, clearance, shift);
    const auto fit = FitOf(*model);
    ASSERT_NE(fit, nullptr);
    const auto offset = [&](std::size_t body, std::uint32_t face) {
      return model->bodies[body].faces->At(face, Vec3::Zero()).offset;
    };
    const double high = 0.5 * clearance - shift - offset(0, kSlotHigh) - offset(1, kTongueHigh);
    const double low = 0.5 * clearance + shift - offset(0, kSlotLow) - offset(1, kTongueLow);
    const double play = std::max(5e-6, fit->CalcRadialPlay(fit->length()));
    EXPECT_NEAR(high + low, 2 * play, 1e-9) << code;
    EXPECT_NEAR(low - high, 2 * std::min(shift, play), 1e-9) << code;
  }
}

}  // namespace
}  // namespace hvas::simulation
