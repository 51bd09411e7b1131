#include <numbers>

#include "drawing.h"

namespace hvas::products {
namespace {

/** A plate with a notch for each hook, and a spigot: a groove of 1.6 mm for the O-ring, one of 0.5
 mm for the retaining ring (DIN 471, 20 mm), and a cone of 34 degrees that both are put over. */
Solid MakeSocket() {
  Solid plate = Box(-30, -20, 0, 30, 20, 8);
  for (const double y : {-20.0, 6.4}) {
    plate = Join(Join(plate, Box(-36, y, 0, -30, y + 13.6, 8)), Box(30, y, 0, 36, y + 13.6, 8));
  }
  const Solid spigot = Turn({{0, 8},
                             {10, 8},
                             {10, 12},
                             {8.4, 12},
                             {8.4, 14.2},
                             {10, 14.2},
                             {10, 26},
                             {9.5, 26},
                             {9.5, 27.3},
                             {10, 27.3},
                             {10, 31},
                             {8, 34},
                             {0, 34}});
  return Join(plate, spigot);
}

/** It squeezes the O-ring by a tenth of its section. */
Solid MakeSleeve() {
  return Turn({{11.2, 0}, {14, 0}, {14, 18}, {10.2, 18}, {10.2, 1}});
}

/** A lid on two arms, whose hooks grip a millimetre under the plate. */
Solid MakeCover() {
  Solid cover = Box(-33.4, -12, 37, 33.4, 12, 40);
  for (const double side : {-1.0, 1.0}) {
    const Solid arm = side > 0 ? Box(30.4, -6, -3, 33.4, 6, 37) : Box(-33.4, -6, -3, -30.4, 6, 37);
    const Solid hook = ExtrudeAlongY(
        {{side * 30.4, -3}, {side * 30.4, -0.2}, {side * 29, -0.2}, {side * 29, -0.8}}, -6, 6);
    cover = Join(cover, Join(arm, hook));
  }
  return cover;
}

}  // namespace

Drawing DrawSnapJoint() {
  constexpr double kOpen = 330 * std::numbers::pi / 180;  // Its gap is 30 degrees.
  Drawing drawing;
  drawing.name = "snap_joint";
  AssemblyDefinition& root = drawing.AddAssembly("snap joint");
  const PartDefinition& socket =
      drawing.AddPart("socket", MakeSocket(), materials::kSteel, colors::kSteel);
  const PartDefinition& seal =
      drawing.AddPart("O-ring 16.8x2", Torus(9.4, 1), materials::kRubber, colors::kRubber);
  const PartDefinition& sleeve =
      drawing.AddPart("sleeve", MakeSleeve(), materials::kBronze, colors::kBronze);
  const PartDefinition& ring = drawing.AddPart(
      "retaining ring 20", Turn({{9.5, 0}, {12.1, 0}, {12.1, 1.2}, {9.5, 1.2}}, kOpen),
      materials::kSpringSteel, colors::kDarkSteel);
  const PartDefinition& cover =
      drawing.AddPart("snap cover", MakeCover(), materials::kAbs, colors::kCover);
  root.Add("socket", socket);
  root.Add("O-ring", seal, Translation(0, 0, 13.1));
  root.Add("sleeve", sleeve, Translation(0, 0, 8));
  root.Add("retaining ring", ring, Translation(0, 0, 26.05));
  root.Add("snap cover", cover);
  for (const char* part : {"socket", "O-ring", "sleeve", "retaining ring", "snap cover"}) {
    drawing.order.push_back({part, {0, 0, -1}});
  }
  return drawing;
}

}  // namespace hvas::products
