#include "evidence/gap_picture.h"

#include <memory>

#include <gtest/gtest.h>

#include "evidence/picture.h"
#include "simulation/test/small_models.h"

namespace hvas::evidence {
namespace {

using orders::GapReason;
using simulation::Model;

/** The share of the pixels of a picture of two boxes, one in front of the other, that marks fill.
 @param is_hidden  The marked face is the one that the box in front hides. */
double RateBoxes(const product::Part& part, bool is_hidden) {
  const spatial::Pose X_front(Quat::Identity(), Vec3(0, -0.1, 0));
  std::vector<PictureBody> bodies{{&part, {}, std::nullopt, {}},
                                  {&part, X_front, std::nullopt, {}}};
  std::vector<std::uint32_t> all;
  for (std::uint32_t f = 0; f < part.faces.size(); ++f) {
    all.push_back(f);
  }
  bodies[is_hidden ? 0 : 1].marked_faces = all;
  spatial::Box box_W = part.box_B;
  box_W.Add(spatial::Transform(X_front, part.box_B));
  return RateMarks(bodies, Projection(box_W, 120, 90, Vec3(0, -1, 0))).front();
}

TEST(PictureTest, MarksThatAreHiddenCountForNothing) {
  const product::Product rig = simulation::testing::PegInBlock();
  const product::Part& block = rig.parts[rig.occurrences[0].part.index()];
  EXPECT_GT(RateBoxes(block, false), 0.1);
  EXPECT_EQ(RateBoxes(block, true), 0);
}

TEST(GapPictureTest, ShowsThePartAndWhatStopsIt) {
  const Model& model = *simulation::testing::PegInCarrierInCupModel();
  GapReason reason;
  reason.occurrence = product::OccurrenceId(1);
  EXPECT_TRUE(MakeGapPicture(model, reason).empty());  // No way was looked at.
  reason.direction_W = Vec3::UnitX();
  reason.travelled = 1e-3;
  EXPECT_TRUE(MakeGapPicture(model, reason).empty());  // Nothing stops it.
  sequence::MetFaces met;
  met.own_face = 0;
  met.other = product::OccurrenceId(0);
  met.other_face = 1;
  reason.stops = {met};
  const std::string png = MakeGapPicture(model, reason);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(png, MakeGapPicture(model, reason));
  reason.stops.front().other_face = contact::kNoFace;
  EXPECT_NE(png, MakeGapPicture(model, reason));  // The mark is gone.
  EXPECT_NE(DescribeGapPicture(model, reason).find("1.00 mm"), std::string::npos);
}

}  // namespace
}  // namespace hvas::evidence
