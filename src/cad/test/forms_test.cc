// Features and forms of solids that OpenCASCADE models, whose dimensions are known (X2, layer T).

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepFilletAPI_MakeChamfer.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Tool.hxx>
#include <ShapeUpgrade_ShapeDivideAngle.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <gp_Ax2.hxx>
#include <gtest/gtest.h>

#include "base/units.h"
#include "cad/brep/part_shape.h"
#include "product/features.h"

namespace hvas::cad {
namespace {

using product::Feature;
using product::FeatureKind;
using product::Form;
using product::FormKind;
using product::Part;
using product::ThreadKind;
using units::FromDeg;
using units::FromMm;

constexpr double kTolerance = 2e-6;  // [m]

// Shapes in millimetres.

TopoDS_Shape Box(double x, double y, double z, double dx, double dy, double dz) {
  return BRepPrimAPI_MakeBox(gp_Pnt(x, y, z), dx, dy, dz).Shape();
}

TopoDS_Shape Rod(double x, double y, double z, double radius, double height) {
  return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(x, y, z), gp::DZ()), radius, height).Shape();
}

TopoDS_Shape Cone(double x, double y, double z, double below, double above, double height) {
  return BRepPrimAPI_MakeCone(gp_Ax2(gp_Pnt(x, y, z), gp::DZ()), below, above, height).Shape();
}

TopoDS_Shape Ball(double x, double y, double z, double radius) {
  return BRepPrimAPI_MakeSphere(gp_Pnt(x, y, z), radius).Shape();
}

TopoDS_Shape Hexagon(double z, double across_flats, double height) {
  BRepBuilderAPI_MakePolygon polygon;
  const double corner = across_flats / std::sqrt(3.0);
  for (int i = 0; i < 6; ++i) {
    const double angle = i * std::numbers::pi / 3;
    polygon.Add(gp_Pnt(corner * std::cos(angle), corner * std::sin(angle), z));
  }
  polygon.Close();
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(polygon.Wire()).Face(), gp_Vec(0, 0, height))
      .Shape();
}

TopoDS_Shape operator-(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  return BRepAlgoAPI_Cut(a, b).Shape();
}

TopoDS_Shape operator+(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  return BRepAlgoAPI_Fuse(a, b).Shape();
}

/** The edges along z whose ends are at (x, y). */
TopoDS_Edge EdgeAlongZ(const TopoDS_Shape& shape, double x, double y) {
  for (TopExp_Explorer it(shape, TopAbs_EDGE); it.More(); it.Next()) {
    TopoDS_Edge edge = TopoDS::Edge(it.Current());
    double first = 0;
    double last = 0;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, first, last);
    const gp_Pnt a = curve->Value(first);
    const gp_Pnt b = curve->Value(last);
    if (std::hypot(a.X() - x, a.Y() - y) + std::hypot(b.X() - x, b.Y() - y) < 1e-6) {
      return edge;
    }
  }
  ADD_FAILURE() << "no such edge";
  return {};
}

Part Build(const TopoDS_Shape& shape, const std::string& name = "part") {
  Part part;
  part.name = name;
  ImportOptions options;
  options.relative_deflection = 5e-4;
  Diagnostics diagnostics;
  const bool is_built = static_cast<bool>(BuildPartShape(
      shape, options, [](const TopoDS_Face&) { return std::nullopt; }, &part, &diagnostics));
  EXPECT_TRUE(is_built);
  product::BuildFeatures(&part);
  return part;
}

std::vector<Form> Select(const Part& part, FormKind kind) {
  std::vector<Form> forms;
  for (const Form& form : part.forms) {
    if (form.kind == kind) {
      forms.push_back(form);
    }
  }
  return forms;
}

int Count(const Part& part, FormKind kind) {
  return static_cast<int>(Select(part, kind).size());
}

int CountThreads(const Part& part) {
  return static_cast<int>(
      std::count_if(part.features.begin(), part.features.end(),
                    [](const Feature& f) { return f.thread != ThreadKind::kNone; }));
}

bool IsHole(FormKind kind) {
  return kind == FormKind::kThroughHole || kind == FormKind::kBlindHole ||
         kind == FormKind::kSteppedHole || kind == FormKind::kCounterboredHole ||
         kind == FormKind::kCountersunkHole;
}

int CountHoles(const Part& part) {
  return static_cast<int>(std::count_if(part.forms.begin(), part.forms.end(),
                                        [](const Form& f) { return IsHole(f.kind); }));
}

/** The only form of its kind, with its dimensions [mm]. */
void ExpectOne(const Part& part, FormKind kind, double diameter_mm, double depth_mm,
               int count = 1) {
  const std::vector<Form> forms = Select(part, kind);
  ASSERT_EQ(forms.size(), 1u);
  EXPECT_NEAR(forms[0].diameter, FromMm(diameter_mm), kTolerance);
  EXPECT_NEAR(forms[0].depth, FromMm(depth_mm), kTolerance);
  EXPECT_EQ(forms[0].count, count);
}

const TopoDS_Shape& Block() {
  static const TopoDS_Shape block = Box(0, 0, 0, 40, 30, 20);
  return block;
}

TEST(Forms, AHoleThroughABlockIsThrough) {
  const Part part = Build(Block() - Rod(20, 15, 0, 4, 20));
  ExpectOne(part, FormKind::kThroughHole, 8, 20);
  EXPECT_EQ(CountHoles(part), 1);
}

TEST(Forms, ADrilledHoleIsBlindAndItsTipIsNotInTheDepth) {
  const double tip = 3 / std::tan(FromDeg(59));
  const TopoDS_Shape drill = Rod(20, 15, 8, 3, 12) + Cone(20, 15, 8 - tip, 0, 3, tip);
  const Part part = Build(Block() - drill);
  ExpectOne(part, FormKind::kBlindHole, 6, 12);
  EXPECT_EQ(CountHoles(part), 1);
  const Form hole = Select(part, FormKind::kBlindHole)[0];
  EXPECT_LT((hole.origin_B - FromMm(1) * Vec3(20, 15, 20)).norm(), kTolerance);
  EXPECT_LT((hole.axis_B - Vec3(0, 0, -1)).norm(), 1e-9);
  EXPECT_EQ(hole.lead_in, 0);
  EXPECT_EQ(Count(part, FormKind::kChamfer), 0);
}

TEST(Forms, AFlatBottomedHoleIsBlind) {
  ExpectOne(Build(Block() - Rod(20, 15, 12, 5, 8)), FormKind::kBlindHole, 10, 8);
}

TEST(Forms, TellsCounterboredFromSteppedAndPlainHoles) {
  // DIN 974-1 for M6: 6.6 through, 11 for the head.
  const Part bore = Build(Block() - Rod(20, 15, 0, 3.3, 20) - Rod(20, 15, 13, 5.5, 7));
  ExpectOne(bore, FormKind::kCounterboredHole, 6.6, 20, 2);
  const Form hole = Select(bore, FormKind::kCounterboredHole)[0];
  EXPECT_NEAR(hole.origin_B.z(), FromMm(20), kTolerance);  // The entry is the wide end.
  EXPECT_EQ(CountHoles(bore), 1);
  const Part steps =
      Build(Block() - Rod(20, 15, 0, 2, 20) - Rod(20, 15, 6, 3, 14) - Rod(20, 15, 12, 5, 8));
  ExpectOne(steps, FormKind::kSteppedHole, 4, 20, 3);
  EXPECT_EQ(CountHoles(steps), 1);
}

TEST(Forms, ACounterboreWithOtherHolesInItsFloorIsARecess) {
  const Part part =
      Build(Block() - Rod(20, 15, 0, 3, 20) - Rod(20, 15, 15, 12, 5) - Rod(28, 15, 0, 1.5, 20));
  EXPECT_EQ(Count(part, FormKind::kCounterboredHole), 0);
  EXPECT_EQ(Count(part, FormKind::kThroughHole), 2);
  EXPECT_EQ(Count(part, FormKind::kBlindHole), 1);
}

TEST(Forms, ACountersinkSeatsAHeadAndAChamferDoesNot) {
  // ISO 15065 for M5: 5.5 through, 10.4 across the cone of 90 deg.
  const Part sunk =
      Build(Block() - Rod(20, 15, 0, 2.75, 20) - Cone(20, 15, 17.55, 2.75, 5.2, 2.45));
  ExpectOne(sunk, FormKind::kCountersunkHole, 5.5, 20);
  const Form hole = Select(sunk, FormKind::kCountersunkHole)[0];
  EXPECT_NEAR(hole.angle, FromDeg(90), 1e-6);
  EXPECT_NEAR(hole.lead_in, FromMm(2.45), kTolerance);
  EXPECT_EQ(Count(sunk, FormKind::kChamfer), 0);
  const auto seat = std::find_if(sunk.features.begin(), sunk.features.end(),
                                 [](const Feature& f) { return f.kind == FeatureKind::kConeSeat; });
  ASSERT_NE(seat, sunk.features.end());
  EXPECT_NEAR(seat->half_angle, FromDeg(45), 1e-6);
  EXPECT_NEAR(seat->radius, FromMm(5.2), kTolerance);
  EXPECT_LT((seat->origin_B - FromMm(1) * Vec3(20, 15, 14.8)).norm(), kTolerance);  // Apex.

  const Part edge = Build(Block() - Rod(20, 15, 0, 5, 20) - Cone(20, 15, 19.5, 5, 5.5, 0.5));
  ExpectOne(edge, FormKind::kThroughHole, 10, 20);
  EXPECT_NEAR(Select(edge, FormKind::kThroughHole)[0].lead_in, FromMm(0.5), kTolerance);
  ASSERT_EQ(Count(edge, FormKind::kChamfer), 1);
  EXPECT_NEAR(Select(edge, FormKind::kChamfer)[0].angle, FromDeg(90), 1e-6);
}

TEST(Forms, AShaftHasSteps_AGroove_AndALeadIn) {
  const TopoDS_Shape pin = Rod(0, 0, 0, 10, 30) + Rod(0, 0, 30, 6, 19) + Cone(0, 0, 49, 6, 5, 1);
  const TopoDS_Shape ring = Rod(0, 0, 15, 11, 1.3) - Rod(0, 0, 15, 9.3, 1.3);  // DIN 471 for 20 mm.
  const Part part = Build(pin - ring);
  ExpectOne(part, FormKind::kShaft, 20, 50, 2);
  const Form shaft = Select(part, FormKind::kShaft)[0];
  EXPECT_NEAR(shaft.lead_in, FromMm(1), kTolerance);
  EXPECT_LT((shaft.origin_B - FromMm(1) * Vec3(0, 0, 50)).norm(), kTolerance);
  EXPECT_LT((shaft.axis_B - Vec3(0, 0, 1)).norm(), 1e-9);
  ExpectOne(part, FormKind::kGroove, 18.6, 0.7);
  EXPECT_EQ(Count(part, FormKind::kChamfer), 1);
  EXPECT_EQ(Count(part, FormKind::kBoss), 0);
}

TEST(Forms, AGrooveInABoreAndARoundOneOnAShaft) {
  const TopoDS_Shape groove = Rod(20, 15, 9, 9.5, 1.5);
  const Part bore = Build(Block() - Rod(20, 15, 0, 8, 20) - groove);
  ExpectOne(bore, FormKind::kGroove, 19, 1.5);
  ExpectOne(bore, FormKind::kThroughHole, 16, 20);
  const TopoDS_Shape torus =
      BRepPrimAPI_MakeTorus(gp_Ax2(gp_Pnt(0, 0, 15), gp::DZ()), 10, 1).Shape();
  const Part shaft = Build(Rod(0, 0, 0, 10, 30) - torus);
  ExpectOne(shaft, FormKind::kGroove, 18, 1);
  ExpectOne(shaft, FormKind::kShaft, 20, 30);
}

TEST(Forms, ABossStandsOnItsPart) {
  const Part part = Build(Block() + Rod(20, 15, 20, 4, 6));
  ExpectOne(part, FormKind::kBoss, 8, 6);
  EXPECT_LT((Select(part, FormKind::kBoss)[0].axis_B - Vec3(0, 0, 1)).norm(), 1e-9);
  EXPECT_EQ(Count(part, FormKind::kShaft), 0);
}

TEST(Forms, SlotsAreNoHoles) {
  const TopoDS_Shape cutter =
      Rod(14, 15, 14, 4, 6) + Rod(26, 15, 14, 4, 6) + Box(14, 11, 14, 12, 8, 6);
  const Part blind = Build(Block() - cutter);
  ExpectOne(blind, FormKind::kSlot, 8, 6);
  EXPECT_EQ(CountHoles(blind), 0);
  EXPECT_EQ(Count(blind, FormKind::kPocket), 0);
  EXPECT_LT((Select(blind, FormKind::kSlot)[0].origin_B - FromMm(1) * Vec3(20, 15, 20)).norm(),
            kTolerance);
  const Part open = Build(Block() - Rod(30, 15, 0, 4, 20) - Box(30, 11, 0, 10, 8, 20));
  ExpectOne(open, FormKind::kSlot, 8, 20);
  EXPECT_EQ(CountHoles(open), 0);
  // A T-nut's channel across the block.
  const Part channel = Build(Block() - Box(0, 12, 15, 40, 6, 5));
  ExpectOne(channel, FormKind::kSlot, 6, 5);
}

TEST(Forms, APocketHasWallsAllAround) {
  const Part part = Build(Block() - Box(10, 10, 15, 20, 10, 5));
  ExpectOne(part, FormKind::kPocket, 0, 5);
  EXPECT_LT((Select(part, FormKind::kPocket)[0].origin_B - FromMm(1) * Vec3(20, 15, 20)).norm(),
            kTolerance);
  EXPECT_EQ(Count(Build(Block() - Box(10, 10, 15, 30, 10, 5)), FormKind::kPocket), 0);  // Open.
  EXPECT_EQ(Count(Build(Block() - Box(10, 10, 5, 20, 10, 5)), FormKind::kPocket), 0);   // A cavity.
}

TEST(Forms, FilletsAndChamfersOfEdges) {
  BRepFilletAPI_MakeFillet fillet(Block());
  fillet.Add(2, EdgeAlongZ(Block(), 0, 0));
  const Part round = Build(fillet.Shape());
  ExpectOne(round, FormKind::kFillet, 4, 0);
  EXPECT_TRUE(std::all_of(round.features.begin(), round.features.end(),
                          [](const Feature& f) { return f.kind == FeatureKind::kPlane; }));
  BRepFilletAPI_MakeChamfer chamfer(Block());
  chamfer.Add(1, EdgeAlongZ(Block(), 0, 0));
  const Part cut = Build(chamfer.Shape());
  ExpectOne(cut, FormKind::kChamfer, 0, std::sqrt(2.0));
  EXPECT_NEAR(Select(cut, FormKind::kChamfer)[0].angle, FromDeg(90), 1e-6);
}

TEST(Forms, RoundedCornersAreNoBalls) {
  BRepFilletAPI_MakeFillet fillet(Block());
  for (TopExp_Explorer it(Block(), TopAbs_EDGE); it.More(); it.Next()) {
    fillet.Add(2, TopoDS::Edge(it.Current()));
  }
  const Part part = Build(fillet.Shape());
  ExpectOne(part, FormKind::kFillet, 4, 0);                         // All of it is one.
  EXPECT_EQ(Select(part, FormKind::kFillet)[0].faces.size(), 20u);  // 12 edges, 8 corners.
  EXPECT_EQ(part.features.size(), 6u);
}

TEST(Forms, PatternsOfHoles) {
  TopoDS_Shape flange = Rod(0, 0, 0, 35, 8) - Rod(0, 0, 0, 15, 8);
  for (int i = 0; i < 6; ++i) {
    const double angle = i * std::numbers::pi / 3 + 0.2;
    flange = flange - Rod(25 * std::cos(angle), 25 * std::sin(angle), 0, 2.5, 8);
  }
  ExpectOne(Build(flange), FormKind::kHolePattern, 50, 0, 6);
  // Two bolt circles of three, as in the plate of AS1, and a quarter of a circle about a bore.
  TopoDS_Shape twin = Box(0, 0, 0, 120, 50, 5);
  for (const double x : {30.0, 90.0}) {
    for (int i = 0; i < 3; ++i) {
      const double angle = i * 2 * std::numbers::pi / 3 + 0.3;
      twin = twin - Rod(x + 15 * std::cos(angle), 25 + 15 * std::sin(angle), 0, 3, 5);
    }
  }
  const std::vector<Form> circles = Select(Build(twin), FormKind::kHolePattern);
  ASSERT_EQ(circles.size(), 2u);
  for (const Form& circle : circles) {
    EXPECT_EQ(circle.count, 3);
    EXPECT_NEAR(circle.diameter, FromMm(30), kTolerance);
  }
  TopoDS_Shape quarter = Box(0, 0, 0, 50, 50, 5) - Rod(10, 10, 0, 5, 5);
  for (int i = 0; i < 3; ++i) {
    const double angle = i * std::numbers::pi / 4;
    quarter = quarter - Rod(10 + 30 * std::cos(angle), 10 + 30 * std::sin(angle), 0, 2, 5);
  }
  ExpectOne(Build(quarter), FormKind::kHolePattern, 60, 0, 3);
  TopoDS_Shape plate = Box(0, 0, 0, 40, 30, 5);
  for (const double x : {8.0, 20.0, 32.0}) {
    for (const double y : {8.0, 22.0}) {
      plate = plate - Rod(x, y, 0, 2, 5);
    }
  }
  ExpectOne(Build(plate), FormKind::kHolePattern, 0, 0, 6);
  TopoDS_Shape sieve = Box(0, 0, 0, 40, 40, 3);  // No circles about its own holes.
  for (const double x : {5.0, 15.0, 25.0, 35.0}) {
    for (const double y : {5.0, 15.0, 25.0, 35.0}) {
      sieve = sieve - Rod(x, y, 0, 2, 3);
    }
  }
  ExpectOne(Build(sieve), FormKind::kHolePattern, 0, 0, 16);
  TopoDS_Shape bar = Box(0, 0, 0, 40, 10, 5);
  for (const double x : {5.0, 12.0, 19.0, 26.0}) {
    bar = bar - Rod(x, 5, 0, 1.5, 5);
  }
  ExpectOne(Build(bar), FormKind::kHolePattern, 0, 0, 4);
  // Holes without a plan, and of several sizes, are none.
  const Part loose = Build(Box(0, 0, 0, 40, 30, 5) - Rod(6, 6, 0, 2, 5) - Rod(17, 9, 0, 2, 5) -
                           Rod(33, 22, 0, 2, 5) - Rod(6, 22, 0, 1, 5));
  EXPECT_EQ(Count(loose, FormKind::kHolePattern), 0);
  EXPECT_EQ(Count(loose, FormKind::kThroughHole), 4);
}

TEST(Forms, BallsAndSocketsFace) {
  const Part ball = Build(Rod(0, 0, 0, 3, 12) + Ball(0, 0, 15, 6));
  const Part socket = Build(Box(-10, -10, 0, 20, 20, 12) - Ball(0, 0, 12, 6));
  const auto find = [](const Part& part, FeatureKind kind) {
    std::vector<Feature> found;
    std::copy_if(part.features.begin(), part.features.end(), std::back_inserter(found),
                 [kind](const Feature& f) { return f.kind == kind; });
    return found;
  };
  ASSERT_EQ(find(ball, FeatureKind::kBall).size(), 1u);
  EXPECT_NEAR(find(ball, FeatureKind::kBall)[0].radius, FromMm(6), kTolerance);
  EXPECT_LT((find(ball, FeatureKind::kBall)[0].origin_B - FromMm(1) * Vec3(0, 0, 15)).norm(),
            kTolerance);
  EXPECT_EQ(find(ball, FeatureKind::kSocket).size(), 0u);
  ASSERT_EQ(find(socket, FeatureKind::kSocket).size(), 1u);
  EXPECT_NEAR(find(socket, FeatureKind::kSocket)[0].coverage, std::numbers::pi, 0.01);  // Half.
  // Its stem is on the ball's centre.
  EXPECT_TRUE(
      std::any_of(ball.inner_constraints.begin(), ball.inner_constraints.end(),
                  [](const auto& c) { return c.kind == product::InnerConstraintKind::kCoaxial; }));
}

TEST(Threads, HexagonalFastenersHaveThemAndDowelsDoNot) {
  const Part bolt = Build(Hexagon(0, 13, 5.3) + Rod(0, 0, 5.3, 4, 30));
  ASSERT_EQ(CountThreads(bolt), 1);
  const Part cap = Build(Rod(0, 0, 0, 6.5, 8) + Rod(0, 0, 8, 4, 25) - Hexagon(0, 6, 4));
  ASSERT_EQ(CountThreads(cap), 1);
  const Part nut = Build(Hexagon(0, 13, 6.8) - Rod(0, 0, 0, 3.4, 6.8));
  ASSERT_EQ(CountThreads(nut), 1);
  for (const Part* part : {&bolt, &cap}) {
    for (const Feature& f : part->features) {
      if (f.thread != ThreadKind::kNone) {
        EXPECT_EQ(f.kind, FeatureKind::kShaft);
        EXPECT_NEAR(f.radius, FromMm(4), kTolerance);
        EXPECT_NEAR(f.thread_pitch, FromMm(1.25), 1e-9);  // ISO 261: M8.
      }
    }
  }
  const Part dowel =
      Build(Rod(0, 0, 1, 4, 28) + Cone(0, 0, 0, 3.5, 4, 1) + Cone(0, 0, 29, 4, 3.5, 1));
  EXPECT_EQ(CountThreads(dowel), 0);
  EXPECT_EQ(Count(dowel, FormKind::kShaft), 1);
  EXPECT_EQ(Count(dowel, FormKind::kChamfer), 2);
  // A knob with a trap for a nut.
  EXPECT_EQ(CountThreads(Build(Rod(0, 0, 0, 15, 10) + Rod(0, 0, 10, 5, 15) - Hexagon(0, 13, 6))),
            0);
  // A shaft on a plate with a hexagonal pocket beside it is no screw.
  EXPECT_EQ(
      CountThreads(Build(Box(-40, -40, -5, 80, 80, 5) + Rod(0, 0, 0, 4, 10) - Hexagon(-5, 5, 3))),
      0);
}

TEST(Threads, NamesSayWhichShaftAndWhatPitch) {
  const TopoDS_Shape screw = Rod(0, 0, 0, 4.25, 3) + Rod(0, 0, 3, 2.5, 20);
  const auto pitch = [&](const std::string& name) {
    const Part part = Build(screw, name);
    for (const Feature& f : part.features) {
      if (f.thread == ThreadKind::kNominal) {
        EXPECT_NEAR(f.radius, FromMm(2.5), kTolerance);
        return f.thread_pitch;
      }
    }
    return -1.0;
  };
  EXPECT_NEAR(pitch("ISO 4762 M5x20"), FromMm(0.8), 1e-9);
  EXPECT_NEAR(pitch("M5x0.5 screw"), FromMm(0.5), 1e-9);
  EXPECT_NEAR(pitch("bolt"), FromMm(0.8), 1e-9);  // By its drawn diameter.
  EXPECT_EQ(pitch("dowel pin 5x20"), -1);
  EXPECT_EQ(pitch("axle"), -1);
}

TEST(Threads, RingsDrawnForAThreadAreOneWithTheirSpacing) {
  TopoDS_Shape rod = Rod(0, 0, 0, 4, 20);
  for (int i = 0; i < 8; ++i) {  // V grooves of 60 deg, 1.25 apart.
    const double z = 4 + 1.25 * i;
    const double flank = 0.6 * std::tan(FromDeg(30));
    const TopoDS_Shape lower = Cone(0, 0, z - flank, 4, 3.4, flank);
    const TopoDS_Shape upper = Cone(0, 0, z, 3.4, 4, flank);
    rod = rod - (Rod(0, 0, z - flank, 5, 2 * flank) - lower - upper);
  }
  const Part part = Build(rod);
  int modelled = 0;
  for (const Feature& f : part.features) {
    if (f.thread == ThreadKind::kModelled) {
      ++modelled;
      EXPECT_NEAR(f.thread_pitch, FromMm(1.25), 1e-6);
    }
  }
  EXPECT_GT(modelled, 0);
}

// The same forms whatever way the part is written.

using Row = std::tuple<int, double, double, double, int, double>;

/** What is said of the forms, lengths rounded to micrometres of the unscaled part. */
std::vector<Row> Describe(const Part& part, double scale) {
  const auto um = [scale](double length) { return std::round(length / scale * 1e6) + 0.0; };
  std::vector<Row> rows;
  for (const Form& form : part.forms) {
    rows.emplace_back(static_cast<int>(form.kind), um(form.diameter), um(form.depth),
                      std::round(1e4 * form.angle), form.count, um(form.lead_in));
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

const TopoDS_Shape& Everything() {
  static const TopoDS_Shape shape = [] {
    TopoDS_Shape s = Box(0, 0, 0, 90, 50, 15) + Rod(75, 25, 15, 6, 9);
    s = s - Rod(10, 10, 0, 3.3, 15) - Rod(10, 10, 9, 5.5, 6);
    s = s - Rod(10, 40, 0, 2.75, 15) - Cone(10, 40, 12.55, 2.75, 5.2, 2.45);
    s = s - Rod(25, 10, 5, 2.5, 10) - Cone(25, 10, 3.5, 0, 2.5, 1.5);
    for (const double x : {28.0, 36.0, 44.0}) {
      s = s - Rod(x, 42, 0, 1.6, 15);
    }
    s = s - (Rod(25, 25, 10, 3, 5) + Rod(33, 25, 10, 3, 5) + Box(25, 22, 10, 8, 6, 5));
    s = s - Box(42, 15, 11, 14, 14, 4);
    s = s - Rod(75, 25, 0, 3, 24);
    return s;
  }();
  return shape;
}

TEST(Forms, AreTheSameInAnyPoseAndSize) {
  const std::vector<Row> expected = Describe(Build(Everything()), 1);
  EXPECT_EQ(CountHoles(Build(Everything())), 7);
  ASSERT_GE(expected.size(), 14u);
  gp_Trsf turn;
  turn.SetRotation(gp_Ax1(gp_Pnt(3, -20, 8), gp_Dir(0.3, -0.5, 0.8)), 1.1);
  gp_Trsf shift;
  shift.SetTranslation(gp_Vec(300, -1200, 55));
  const TopoDS_Shape moved = BRepBuilderAPI_Transform(Everything(), shift * turn, true).Shape();
  EXPECT_EQ(Describe(Build(moved), 1), expected);
  for (const double scale : {0.2, 25.4, 1000.0}) {
    SCOPED_TRACE(scale);
    gp_Trsf grow;
    grow.SetScale(gp_Pnt(0, 0, 0), scale);
    const TopoDS_Shape large = BRepBuilderAPI_Transform(Everything(), grow, true).Shape();
    EXPECT_EQ(Describe(Build(large), scale), expected);
  }
}

TEST(Forms, AreTheSameWithFacesInPiecesAndInAnyOrder) {
  const Part whole = Build(Everything());
  const std::vector<Row> expected = Describe(whole, 1);
  for (const double piece_deg : {180.0, 90.0, 50.0}) {
    SCOPED_TRACE(piece_deg);
    ShapeUpgrade_ShapeDivideAngle divide(FromDeg(piece_deg), Everything());
    ASSERT_TRUE(divide.Perform());
    const Part pieces = Build(divide.Result());
    EXPECT_GT(pieces.faces.size(), whole.faces.size());
    EXPECT_EQ(Describe(pieces, 1), expected);
  }
  Part reversed = whole;
  std::reverse(reversed.faces.begin(), reversed.faces.end());
  product::BuildFeatures(&reversed);
  EXPECT_EQ(Describe(reversed, 1), expected);
}

}  // namespace
}  // namespace hvas::cad
