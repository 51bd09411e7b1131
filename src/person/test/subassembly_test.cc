#include <gtest/gtest.h>

#include "person/test/session.h"
#include "simulation/test/small_models.h"

namespace hvas::person::testing {
namespace {

constexpr double kCupBore = 20e-3;
constexpr double kCupFloor = 5e-3;
constexpr double kCarrierRadius = 8e-3;

enum : std::size_t { kCup, kCarrier, kPin };

/** A pin lies across in its carrier, and both in a cup: the wall keeps the pin in the carrier, and
 the pin keeps the carrier from leaving alone. Only together they come out. */
Product PinInCarrierInCup() {
  Product product;
  product.name = "cup";
  const PartId cup =
      AddPart(&product, "cup", contact::testing::Cup(kCupBore, 26e-3, kCupFloor, 40e-3));
  const PartId carrier =
      AddPart(&product, "carrier", contact::testing::Bushing(5e-3, kCarrierRadius, 24e-3, 10e-6));
  const PartId pin = AddPart(&product, "pin", contact::testing::Shaft(5e-3, 30e-3, 10e-6));
  const Quat across = spatial::RotationTaking(Vec3::UnitZ(), Vec3::UnitX());
  const double height = kCupFloor + kCarrierRadius;
  Place(&product, cup, "cup");
  Place(&product, carrier, "carrier", Pose(across, Vec3(-12e-3, 0, height)));
  Place(&product, pin, "pin", Pose(across, Vec3(-15e-3, 0, height)));
  product::Subassembly inner;
  inner.id = product::SubassemblyId(1);
  inner.parent = product::SubassemblyId(0);
  inner.name = "carrier with pin";
  inner.occurrences = {OccurrenceId(kCarrier), OccurrenceId(kPin)};
  product.subassemblies[0].subassemblies = {inner.id};
  product.subassemblies[0].occurrences = {OccurrenceId(kCup)};
  for (const OccurrenceId id : inner.occurrences) {
    product.occurrences[id.index()].parent = inner.id;
  }
  product.subassemblies.push_back(inner);
  Complete(&product);
  return product;
}

const std::shared_ptr<const simulation::Model>& PinInCarrierInCupModel() {
  static const std::shared_ptr<const simulation::Model> model = [] {
    Diagnostics diagnostics;
    return *simulation::Compile(std::make_shared<Product>(PinInCarrierInCup()), FastOptions(),
                                &diagnostics);
  }();
  return model;
}

// X3, X17: what has no way in alone goes in with its subassembly, which is put together before.
TEST(Subassembly, IsPutTogetherFirstAndGoesInAsOneBody) {
  const sequence::Sequence& sequence = PinInCarrierInCupModel()->sequence;
  EXPECT_TRUE(sequence.gaps.empty());
  ASSERT_EQ(sequence.steps.size(), 5U);
  using Kind = sequence::SequenceStep::Kind;
  const Kind kinds[] = {Kind::kBase, Kind::kInsert, Kind::kPark, Kind::kBase, Kind::kInsert};
  const std::size_t leaders[] = {kCarrier, kPin, kCarrier, kCup, kCarrier};
  for (std::size_t i = 0; i < 5; ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(sequence.steps[i].kind, kinds[i]);
    EXPECT_EQ(sequence.steps[i].occurrence, OccurrenceId(leaders[i]));
  }
  EXPECT_EQ(sequence.steps[4].members, std::vector<OccurrenceId>{OccurrenceId(kPin)});
  EXPECT_GT(sequence.steps[4].extraction_W.z(), 0.999);
}

// X17: the same where the file names no subassembly, as exports from other systems do.
TEST(Subassembly, IsFoundWhereTheFileIsFlat) {
  Product product = PinInCarrierInCup();
  product.subassemblies.resize(1);
  product.subassemblies[0].subassemblies.clear();
  product.subassemblies[0].occurrences.clear();
  for (product::Occurrence& occurrence : product.occurrences) {
    occurrence.parent = product::SubassemblyId(0);
    product.subassemblies[0].occurrences.push_back(occurrence.id);
  }
  Diagnostics diagnostics;
  const auto model =
      *simulation::Compile(std::make_shared<Product>(product), FastOptions(), &diagnostics);
  const sequence::Sequence& named = PinInCarrierInCupModel()->sequence;
  EXPECT_TRUE(model->sequence.gaps.empty());
  ASSERT_EQ(model->sequence.steps.size(), named.steps.size());
  for (std::size_t i = 0; i < named.steps.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(model->sequence.steps[i].kind, named.steps[i].kind);
    EXPECT_EQ(model->sequence.steps[i].occurrence, named.steps[i].occurrence);
    EXPECT_EQ(model->sequence.steps[i].members, named.steps[i].members);
    EXPECT_GT(model->sequence.steps[i].extraction_W.dot(named.steps[i].extraction_W), 0.999);
  }
}

// The mass that the hand carries is that of both parts, about their common centre.
TEST(Subassembly, HasTheMassOfItsMembers) {
  const simulation::Model& model = *PinInCarrierInCupModel();
  const dynamics::MassProperties both = simulation::CombineMass(model, model.sequence.steps[4]);
  const simulation::Body& carrier = model.bodies[kCarrier];
  const simulation::Body& pin = model.bodies[kPin];
  EXPECT_NEAR(both.mass, carrier.mass.mass + pin.mass.mass, 1e-12);
  const Vec3 p_WCm = (carrier.mass.mass * (carrier.X_WB_goal * carrier.mass.p_BoBcm_B) +
                      pin.mass.mass * (pin.X_WB_goal * pin.mass.p_BoBcm_B)) /
                     both.mass;
  EXPECT_LT((carrier.X_WB_goal * both.p_BoBcm_B - p_WCm).norm(), 1e-12);
  // Both are round about the same axis: about it, inertias add; across, Steiner's part comes in.
  const Vec3 axis = Vec3::UnitZ();  // of both parts, in their own frames
  EXPECT_NEAR(axis.dot(both.I_BBcm_B * axis),
              axis.dot(carrier.mass.I_BBcm_B * axis) + axis.dot(pin.mass.I_BBcm_B * axis), 1e-15);
}

TEST(Subassembly, IsSeatedWithAllItsMembers) {
  Session session(PinInCarrierInCupModel());
  const simulation::ExecutionReport report = simulation::RunLockstep(session.MakeExecution(120));
  ASSERT_TRUE(session.run.is_done()) << report.session_ns;
  ASSERT_EQ(session.run.results().size(), 3U);
  for (const simulation::PartResult& result : session.run.results()) {
    SCOPED_TRACE(result.occurrence.value());
    EXPECT_TRUE(result.is_seated) << result.reason;
    EXPECT_LT(result.pose_error, 1e-6);
    EXPECT_LT(result.pose_error_angle, 1e-6);
    EXPECT_LT(result.deepest, 50e-6);
  }
  EXPECT_LE(session.watch.largest_jump, 0.5);
  EXPECT_TRUE(session.watch.is_finite);
}

}  // namespace
}  // namespace hvas::person::testing
