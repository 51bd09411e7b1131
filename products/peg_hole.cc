#include "drawing.h"

namespace hvas::products {

Drawing DrawPegHole() {
  Drawing drawing;
  drawing.name = "peg_hole";
  AssemblyDefinition& root = drawing.AddAssembly("peg in hole");
  const Solid bore = Turn({{0, 5}, {10, 5}, {10, 49}, {11, 50}, {0, 50}});
  const Solid tool = Turn({{0, 5}, {10, 5}, {10, 49}, {11, 50}, {11, 51}, {0, 51}});
  const Solid block = Cut(Box(-30, -30, 0, 30, 30, 50), tool, bore.volume_mm3);
  const Solid peg = Turn({{0, 0}, {9, 0}, {10, 1}, {10, 79}, {9, 80}, {0, 80}});
  const PartDefinition& block_part =
      drawing.AddPart("block", block, materials::kSteel, colors::kCastIron);
  const PartDefinition& peg_part =
      drawing.AddPart("peg 20", peg, materials::kSteel, colors::kSteel);
  root.Add("block", block_part);
  root.Add("peg", peg_part, Translation(0, 0, 5));
  drawing.fits = {{"block", "peg", 20, "H7/g6"}};
  drawing.order = {{"block", {0, 0, -1}}, {"peg", {0, 0, -1}}};
  return drawing;
}

}  // namespace hvas::products
