#include "drawing.h"

namespace hvas::products {

// A screw stands head down in a plate, and its nut clamps the plate from above. The thread of the
// nut is drawn at its core diameter, D1 = 6.647 mm, that of the screw at its outer one.
Drawing DrawNutBolt() {
  Drawing drawing;
  drawing.name = "nut_bolt";
  AssemblyDefinition& root = drawing.AddAssembly("nut on bolt");
  const Solid hole = Cylinder(9, 0, 12);
  const Solid plate = Cut(Box(-30, -30, 0, 30, 30, 12), hole);
  const Solid shank = Turn({{0, 0}, {4, 0}, {4, 24}, {3, 25}, {0, 25}});
  const Solid bolt = Join(Hexagon(13, -5.3, 0), shank);
  const Solid nut = Cut(Hexagon(13, 0, 6.8), Cylinder(6.647, 0, 6.8));
  const PartDefinition& plate_part =
      drawing.AddPart("plate", plate, materials::kSteel, colors::kCastIron);
  const PartDefinition& bolt_part =
      drawing.AddPart("hexagon bolt M8x25", bolt, materials::kBoltSteel, colors::kDarkSteel);
  const PartDefinition& nut_part =
      drawing.AddPart("hexagon nut M8", nut, materials::kBoltSteel, colors::kSteel);
  root.Add("plate", plate_part);
  root.Add("bolt", bolt_part);
  root.Add("nut", nut_part, Translation(0, 0, 12));
  drawing.fits = {{"nut", "bolt", 8, "thread"}};
  drawing.order = {{"plate", {0, 0, -1}}, {"bolt", {0, 0, 1}}, {"nut", {0, 0, -1}}};
  return drawing;
}

}  // namespace hvas::products
