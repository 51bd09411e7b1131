#include <numbers>
#include <string>

#include "drawing.h"

namespace hvas::products {
namespace {

using std::numbers::pi;

constexpr double kSetDistance = 160;  // between the axes of two sets of the fit rig [mm]

/** Three fixed jaws on a disc with a turned seat of 80 mm, open behind for the shaft's end. */
Solid MakeChuck() {
  Solid chuck = Turn({{22, 0}, {80, 0}, {80, 28}, {78, 30}, {40, 30}, {40, 20}, {22, 20}});
  constexpr double kJawAngle = pi / 4.5;
  // The lead-in at the top of the jaws is where a bushing meets them.
  const Solid jaw = Turn({{40, 30}, {74, 30}, {74, 42}, {66, 50}, {42, 50}, {40, 48}}, kJawAngle);
  for (int i = 0; i < 3; ++i) {
    const gp_Trsf turn = RotationAboutZ(i * 2 * pi / 3 - kJawAngle / 2);
    chuck = Join(chuck, Move(jaw, turn));
  }
  return chuck;
}

/** Nose of 40 mm that ends 1 mm short of the seat, shoulder that meets the bushing, handle. */
Solid MakeShaft() {
  return Turn({{0, -49},
               {19, -49},
               {20, -48},
               {20, 0},
               {30, 0},
               {30, 14},
               {29, 15},
               {15, 15},
               {15, 68},
               {13, 70},
               {0, 70}});
}

/** A block with a seat of 80 mm for each bushing, open behind for the ends of the shafts. */
Solid MakeSeats() {
  Solid block = Box(-kSetDistance - 70, -70, 0, kSetDistance + 70, 70, 30);
  for (int i = -1; i <= 1; ++i) {
    const Solid seat = Turn({{0, -1}, {22, -1}, {22, 20}, {40, 20}, {40, 29}, {42, 31}, {0, 31}});
    block = Cut(block, Move(seat, Translation(i * kSetDistance, 0, 0)));
  }
  return block;
}

}  // namespace

Drawing DrawFitRig() {
  Drawing drawing;
  drawing.name = "fit_rig";
  AssemblyDefinition& root = drawing.AddAssembly("fit rig");
  const PartDefinition& seats =
      drawing.AddPart("block", MakeSeats(), materials::kCastIron, colors::kCastIron);
  const PartDefinition& bushing = drawing.AddPart("bushing 40x80x50", Tube(80, 40, 0, 50, 1, 1),
                                                  materials::kSteel, colors::kSteel);
  const PartDefinition& shaft =
      drawing.AddPart("shaft 40", MakeShaft(), materials::kSteel, colors::kSteel);
  root.Add("block", seats);
  drawing.order = {{"block", {0, 0, -1}}};
  for (int i = 1; i <= 3; ++i) {
    const double x = (i - 2) * kSetDistance;
    const std::string bushing_name = "bushing " + std::to_string(i);
    const std::string shaft_name = "shaft " + std::to_string(i);
    root.Add(bushing_name, bushing, Translation(x, 0, 20));
    root.Add(shaft_name, shaft, Translation(x, 0, 70));
    drawing.fits.push_back({"block", bushing_name, 80, "H7/h6"});
    drawing.fits.push_back({bushing_name, shaft_name, 40, "H7/g6"});
    drawing.order.push_back({bushing_name, {0, 0, -1}});
    drawing.order.push_back({shaft_name, {0, 0, -1}});
  }
  return drawing;
}

Drawing DrawBushing() {
  Drawing drawing;
  drawing.name = "bushing";
  AssemblyDefinition& root = drawing.AddAssembly("bushing rig");
  const PartDefinition& chuck =
      drawing.AddPart("chuck", MakeChuck(), materials::kCastIron, colors::kCastIron);
  const PartDefinition& bushing = drawing.AddPart("bushing 40x80x50", Tube(80, 40, 0, 50, 1, 1),
                                                  materials::kBronze, colors::kBronze);
  const PartDefinition& shaft =
      drawing.AddPart("shaft 40", MakeShaft(), materials::kSteel, colors::kSteel);
  root.Add("chuck", chuck);
  root.Add("bushing", bushing, Translation(0, 0, 20));
  root.Add("shaft", shaft, Translation(0, 0, 70));
  drawing.fits = {{"chuck", "bushing", 80, "H7/h6"}, {"bushing", "shaft", 40, "H7/g6"}};
  drawing.order = {{"chuck", {0, 0, -1}}, {"bushing", {0, 0, -1}}, {"shaft", {0, 0, -1}}};
  return drawing;
}

}  // namespace hvas::products
