#include <numbers>

#include "drawing.h"

namespace hvas::products {
namespace {

using std::numbers::pi;

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

}  // namespace

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
