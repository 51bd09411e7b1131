#include "gear_pump_parts.h"

#include <cmath>
#include <numbers>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <gp_Pnt.hxx>

#include "gear.h"

namespace hvas::products::pump {
namespace {

using std::numbers::pi;

constexpr double kChamber = 48;  // Diameter: 0.2 mm round the gears' tips.
constexpr double kJournal = 20;
constexpr double kBushingOuter = 26;
constexpr double kBushingLength = 18;
constexpr double kKeyWidth = 5;
constexpr double kKeyLength = 20;
constexpr double kKeyBottom = 4;  // Above the shaft's axis.
constexpr double kHubBore = 14;
constexpr double kLeadIn = 0.5;  // Chamfer at the mouth of holes.

const gp_Dir kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

/** Area of two discs of radius `r` about the gears' axes, together. */
double EightArea(double r) {
  const double lens =
      2 * r * r * std::acos(kAxis / r) - 2 * kAxis * std::sqrt(r * r - kAxis * kAxis);
  return 2 * pi * r * r - lens;
}

/** Hole on z from `depth` below `mouth` up to it, with a lead-in. */
Solid Hole(double diameter, double mouth, double depth) {
  return Cylinder(diameter, mouth - depth, mouth, 0, -kLeadIn);
}

/** Side view of the housing along the shafts: rounded above, on a foot. */
Solid HousingBlock() {
  constexpr double kRound = 12, kFootX = 60, kFootY = -77;
  const double d = kRound * (1 - std::sqrt(0.5));
  BRepBuilderAPI_MakeWire wire;
  const auto line = [&wire](double x0, double y0, double x1, double y1) {
    wire.Add(BRepBuilderAPI_MakeEdge(gp_Pnt(x0, y0, 0), gp_Pnt(x1, y1, 0)).Edge());
  };
  const auto arc = [&wire](const gp_Pnt& from, const gp_Pnt& via, const gp_Pnt& to) {
    wire.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(from, via, to).Value()).Edge());
  };
  line(-kFootX, kFootY, kFootX, kFootY);
  line(kFootX, kFootY, kFootX, -kTop);
  line(kFootX, -kTop, kSide, -kTop);
  line(kSide, -kTop, kSide, kTop - kRound);
  arc({kSide, kTop - kRound, 0}, {kSide - d, kTop - d, 0}, {kSide - kRound, kTop, 0});
  line(kSide - kRound, kTop, -kSide + kRound, kTop);
  arc({-kSide + kRound, kTop, 0}, {-kSide + d, kTop - d, 0}, {-kSide, kTop - kRound, 0});
  line(-kSide, kTop - kRound, -kSide, -kTop);
  line(-kSide, -kTop, -kFootX, -kTop);
  line(-kFootX, -kTop, -kFootX, kFootY);
  const double area =
      2 * kFootX * (-kTop - kFootY) + 4 * kSide * kTop - (2 - pi / 2) * kRound * kRound;
  const BRepBuilderAPI_MakeFace face(wire.Wire());
  return {BRepPrimAPI_MakePrism(face.Face(), gp_Vec(0, 0, kFront)).Shape(), area * kFront};
}

/** The gear chamber: two bores that run into one another. */
Solid CutChamber(const Solid& block) {
  const Solid bore = Hole(kChamber, kFront, kFront - kFloor);
  const double r = kChamber / 2;
  const double eight_mm3 =
      EightArea(r) * (kFront - kFloor - kLeadIn) + Integrate(EightArea, r, r + kLeadIn, 8);
  const Solid one = Cut(block, Move(bore, Translation(0, kAxis, 0)));
  return Cut(one, Move(bore, Translation(0, -kAxis, 0)), eight_mm3 - bore.volume_mm3);
}

/** Ports left and right, and the bleed hole on top, each tapped and led into the chamber. */
Solid CutPorts(Solid housing) {
  constexpr double kTapped = 14, kDuct = 5;  // Depth of the thread; radius of the duct.
  const double r = kChamber / 2;
  const double duct_mm3 =
      Integrate(
          [&](double y) {
            const double wall = std::sqrt(r * r - (kAxis - std::abs(y)) * (kAxis - std::abs(y)));
            return 2 * std::sqrt(kDuct * kDuct - y * y) * (kSide - kTapped - wall);
          },
          0, kDuct, 4000) *
      2;
  for (const double side : {1.0, -1.0}) {
    const gp_Trsf X = Frame(side * kSide, 0, kPortHeight, side > 0 ? kX : kX.Reversed(), kY);
    housing = Cut(housing, Move(Hole(16, 0, kTapped), X));
    housing = Cut(housing, Move(Cylinder(2 * kDuct, -kSide, -kTapped), X), duct_mm3);
  }
  constexpr double kBleedTapped = 12, kBleedDuct = 2;
  const gp_Trsf X = Frame(0, kTop, kPortHeight, kY, kX);
  const double bleed_mm3 = Integrate(
      [&](double x) {
        const double wall = kAxis + std::sqrt(r * r - x * x);
        return 2 * std::sqrt(kBleedDuct * kBleedDuct - x * x) * (kTop - kBleedTapped - wall);
      },
      -kBleedDuct, kBleedDuct, 4000);
  housing = Cut(housing, Move(Hole(10, 0, kBleedTapped), X));
  return Cut(housing, Move(Cylinder(2 * kBleedDuct, -25, -kBleedTapped), X), bleed_mm3);
}

/** Gear with its journal behind, up to the gear's front face; the shaft's front comes on top. */
Solid GearShaft(double tooth_angle, const Solid& front) {
  const Solid gear = MakeGear(GearShape{}, kFloor, kFront + 0.8, tooth_angle);
  const Solid rear = Cylinder(kJournal, 13, kFloor, 1, 0);
  return Join(Join(gear, rear), front);
}

/** What the keyway takes from the drive shaft: its footprint times the height up to the surface. */
double KeywayVolume(double length, double width, double bottom, double shaft_radius) {
  const double r = width / 2;
  return Integrate(
      [&](double x) {
        const double along = length - width + 2 * std::sqrt(r * r - x * x);
        return along * (std::sqrt(shaft_radius * shaft_radius - x * x) - bottom);
      },
      -r, r, 4000);
}

}  // namespace

Solid MakeHousing() {
  Solid housing = CutChamber(HousingBlock());
  std::vector<Solid> holes;
  for (const double y : {kAxis, -kAxis}) {
    holes.push_back(Move(Hole(kBushingOuter, kFloor, kBushingLength), Translation(0, y, 0)));
  }
  for (const Place& p : kScrews)
    holes.push_back(Move(Hole(6, kFront, 16), Translation(p.x, p.y, 0)));
  for (const Place& p : kDowels)
    holes.push_back(Move(Hole(6, kFront, 14), Translation(p.x, p.y, 0)));
  for (const double x : {-52.0, 52.0}) {
    for (const double z : {12.0, 48.0}) {
      holes.push_back(Move(Cylinder(9, 0, 12), Frame(x, -77, z, kY, kX)));
    }
  }
  return CutPorts(CutAll(housing, holes));
}

Solid MakeCover() {
  const double top = kCoverThickness + kBoss;
  const Solid boss = Move(Cylinder(50, kCoverThickness, top, 0, 1), Translation(0, kAxis, 0));
  const Solid blank = Join(RoundedPlate(2 * kSide, 2 * kTop, 12, 0, kCoverThickness), boss);
  std::vector<Solid> holes;
  for (const double y : {kAxis, -kAxis}) {
    holes.push_back(
        Move(Cylinder(kBushingOuter, 0, kBushingLength, -kLeadIn, 0), Translation(0, y, 0)));
  }
  holes.push_back(Move(Cylinder(22, kBushingLength, top - 8), Translation(0, kAxis, 0)));
  holes.push_back(Move(Hole(35, top, 8), Translation(0, kAxis, 0)));
  for (const Place& p : kScrews) {
    holes.push_back(Move(Cylinder(6.6, 0, kCoverThickness), Translation(p.x, p.y, 0)));
  }
  for (const Place& p : kDowels) {
    holes.push_back(Move(Cylinder(6, 0, 11, -kLeadIn, 0), Translation(p.x, p.y, 0)));
  }
  // One after the other: these holes share faces.
  Solid cover = blank;
  for (const Solid& hole : holes)
    cover = Cut(cover, hole);
  return cover;
}

Solid MakeGasket() {
  constexpr double kOpening = 25;  // Radius: clear of the chamber's lead-in.
  Solid gasket = RoundedPlate(2 * kSide, 2 * kTop, 12, 0, kGasket);
  const Solid bore = Cylinder(2 * kOpening, 0, kGasket);
  gasket = Cut(gasket, Move(bore, Translation(0, kAxis, 0)));
  gasket = Cut(gasket, Move(bore, Translation(0, -kAxis, 0)),
               EightArea(kOpening) * kGasket - bore.volume_mm3);
  std::vector<Solid> holes;
  for (const Place& p : kScrews)
    holes.push_back(Move(Cylinder(7, 0, kGasket), Translation(p.x, p.y, 0)));
  for (const Place& p : kDowels)
    holes.push_back(Move(Cylinder(7, 0, kGasket), Translation(p.x, p.y, 0)));
  return CutAll(gasket, holes);
}

Solid MakeDriveShaft() {
  constexpr double kJournalRadius = kJournal / 2, kEndRadius = kHubBore / 2;
  const Solid front = Turn({{0, kFront + 0.8},
                            {kJournalRadius, kFront + 0.8},
                            {kJournalRadius, kShoulder - 1},
                            {kJournalRadius - 1, kShoulder},
                            {kEndRadius, kShoulder},
                            {kEndRadius, kShaftEnd - 1},
                            {kEndRadius - 1, kShaftEnd},
                            {0, kShaftEnd}});
  // A tooth of the drive gear points at the other gear.
  Solid shaft = GearShaft(-pi / 2, front);
  shaft = Cut(shaft, Hole(5, kShaftEnd, 15));
  constexpr double kLength = kKeyLength + 0.4, kWidth = kKeyWidth;
  const Solid slot = Move(RoundEndedBar(kLength, kWidth, kKeyBottom, kEndRadius + 1),
                          Frame(0, 0, kKeyMiddle, kY, kZ));
  return Cut(shaft, slot, KeywayVolume(kLength, kWidth, kKeyBottom, kEndRadius));
}

Solid MakeDrivenShaft() {
  return GearShaft(0, Cylinder(kJournal, kFront + 0.8, 78, 0, 1));
}

Solid MakeBushing() {
  return Tube(kBushingOuter, kJournal, 0, kBushingLength, 0.5, 0.5);
}

Solid MakeOilSeal() {
  return Turn({{12, 0},
               {17, 0},
               {17.5, 0.5},
               {17.5, 6.5},
               {17, 7},
               {12, 7},
               {12, 6.5},
               {10, 4.5},
               {10, 2.5},
               {12, 0.5}});
}

Solid MakeDowel() {
  return Cylinder(6, 0, 24, 0.8, 0.8);
}

Solid MakeKey() {
  return Move(RoundEndedBar(kKeyLength, kKeyWidth, kKeyBottom, kKeyBottom + 5, 0.25),
              Frame(0, 0, 0, kY, kZ));
}

Solid MakeCouplingHub() {
  constexpr double kBore = kHubBore / 2, kSlot = kKeyWidth + 0.06, kSlotTop = 9.3;
  Solid hub = Turn({{kBore + kLeadIn, 0},
                    {14, 0},
                    {15, 1},
                    {15, 18},
                    {27, 18},
                    {28, 19},
                    {28, kHubLength - 1},
                    {27, kHubLength},
                    {kBore + kLeadIn, kHubLength},
                    {kBore, kHubLength - kLeadIn},
                    {kBore, kLeadIn}});
  const double slot_mm3 = Integrate(
      [&](double x) {
        const auto bore_at = [x](double r) { return std::sqrt(r * r - x * x); };
        return kHubLength * kSlotTop - (kHubLength - 2 * kLeadIn) * bore_at(kBore) -
               2 * Integrate(bore_at, kBore, kBore + kLeadIn, 4);
      },
      -kSlot / 2, kSlot / 2);
  hub = Cut(hub, Box(-kSlot / 2, 0, 0, kSlot / 2, kSlotTop, kHubLength), slot_mm3);
  std::vector<Solid> holes;  // For the coupling's bolts.
  for (int i = 0; i < 3; ++i) {
    const double a = pi / 2 + i * 2 * pi / 3;
    holes.push_back(
        Move(Cylinder(8, 18, kHubLength), Translation(21 * std::cos(a), 21 * std::sin(a), 0)));
  }
  return CutAll(hub, holes);
}

Solid MakeEndDisc() {
  return Tube(22, 5.5, 0, 4, 0.5, 0);
}

Solid MakeLockWasher() {
  constexpr double kInner = 3.2, kOuter = 5.9, kGap = 0.5;  // Radii, and half the gap.
  const double gap_mm3 = kLockWasher * Integrate(
                                           [](double y) {
                                             return std::sqrt(kOuter * kOuter - y * y) -
                                                    std::sqrt(kInner * kInner - y * y);
                                           },
                                           -kGap, kGap, 8);
  return Cut(Tube(2 * kOuter, 2 * kInner, 0, kLockWasher), Box(0, -kGap, 0, 7, kGap, kLockWasher),
             gap_mm3);
}

Solid MakeSocketScrew(double diameter, double length, double head_diameter, double across_flats,
                      double socket_depth) {
  const double r = diameter / 2, head = head_diameter / 2;
  const Solid body = Turn({{0, -length},
                           {r - 1, -length},
                           {r, -length + 1},
                           {r, 0},
                           {head, 0},
                           {head, diameter - 0.5},
                           {head - 0.5, diameter},
                           {0, diameter}});
  return Cut(body, Hexagon(across_flats, diameter - socket_depth, diameter));
}

Solid MakeHoseNipple() {
  const Solid thread = Cylinder(16, -12, 0, 1, 0);
  const Solid hose = Cylinder(12, 8, 26, 0, 1);
  return Cut(Join(Join(thread, Hexagon(24, 0, 8)), hose), Cylinder(9, -12, 26));
}

Solid MakeBleedPlug() {
  return Join(Cylinder(10, -10, 0, 1, 0), Hexagon(14, 0, 6));
}

}  // namespace hvas::products::pump
