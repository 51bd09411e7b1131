#include "tools.h"

#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <gp_Ax1.hxx>

namespace hvas::products {
namespace {

using std::numbers::pi;

const gp_Dir kAlongX(1, 0, 0), kAlongY(0, 1, 0), kAlongZ(0, 0, 1);

/** Lengths of a hexagon key of ISO 2936 [mm]: overall, of the long and of the short arm. */
struct KeyArms {
  double long_arm{0};
  double short_arm{0};
};

// ISO 2936, standard length; figures that FreeCAD's fasteners workbench and the sheet of a maker
// (mikipulley.co.jp, JIS B 4648) agree on.
const std::map<int, KeyArms> kKeys{{3, {66, 23}}, {4, {74, 29}}, {5, {85, 33}}, {6, {96, 38}}};

/** Joins bodies that overlap; its volume is that of the shape, as no formula has what they share.
 */
Solid Merge(const std::string& name, const std::vector<Solid>& bodies) {
  TopoDS_Shape shape = bodies.front().shape;
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    shape = BRepAlgoAPI_Fuse(shape, bodies[i].shape).Shape();
  }
  TopExp_Explorer it(shape, TopAbs_SOLID);
  if (!it.More()) throw std::runtime_error("no solid is left of " + name);
  const TopoDS_Shape solid = it.Current();
  it.Next();
  if (it.More()) throw std::runtime_error(name + " consists of more than one solid");
  return {solid, CalcVolumeFinely(solid)};
}

/** Box of the given sizes about a centre. */
Solid Block(double x, double y, double z, double cx, double cy, double cz, double turn = 0) {
  return Move(Move(Box(-x / 2, -y / 2, -z / 2, x / 2, y / 2, z / 2), RotationAboutZ(turn)),
              Translation(cx, cy, cz));
}

/** Cylinder of the given radius about a centre, along an axis. */
Solid Rod(double radius, double length, double cx, double cy, double cz, const gp_Dir& axis) {
  const gp_Dir side = axis.IsParallel(kAlongX, 1e-6) ? kAlongY : kAlongX;
  return Move(Cylinder(2 * radius, -length / 2, length / 2), Frame(cx, cy, cz, axis, side));
}

Drawing MakeDrawing(const std::string& name, const Solid& solid, const Material& material,
                    const Rgb& color) {
  Drawing drawing;
  drawing.name = name;
  AssemblyDefinition& root = drawing.AddAssembly(name);
  root.Add(name, drawing.AddPart(name, solid, material, color));
  return drawing;
}

Solid MakeHexKey(double width, const KeyArms& arms) {
  const double bend = 1.5 * width;  // Radius of the middle line: a choice.
  const double straight_short = arms.short_arm - width / 2 - bend;
  const double straight_long = arms.long_arm - width / 2 - bend;
  const Solid foot = Hexagon(width, 0, straight_short);
  const double area = foot.volume_mm3 / straight_short;
  const double corner = width / std::sqrt(3.0);
  const auto make_section = [corner](const auto& place) {
    BRepBuilderAPI_MakePolygon polygon;
    for (int i = 0; i < 6; ++i) {
      const double a = pi / 6 + i * pi / 3;
      polygon.Add(place(corner * std::cos(a), corner * std::sin(a)));
    }
    polygon.Close();
    return BRepBuilderAPI_MakeFace(polygon.Wire()).Face();
  };
  const TopoDS_Face start =
      make_section([straight_short](double x, double y) { return gp_Pnt(x, y, straight_short); });
  const gp_Ax1 pivot(gp_Pnt(bend, 0, straight_short), kAlongY);
  const Solid elbow{BRepPrimAPI_MakeRevol(start, pivot, pi / 2).Shape(), area * bend * pi / 2};
  const double height = straight_short + bend;
  const TopoDS_Face end =
      make_section([bend, height](double x, double y) { return gp_Pnt(bend, y, height - x); });
  const Solid lever{BRepPrimAPI_MakePrism(end, gp_Vec(straight_long, 0, 0)).Shape(),
                    area * straight_long};
  return Join(Join(foot, elbow), lever);
}

Solid MakeVise() {
  return Merge("vise", {Block(100, 120, 30, 0, 0, 15), Block(90, 45, 70, 0, 35, 65),
                        Block(90, 35, 70, 0, -55, 65), Block(100, 8, 30, 0, 10, 85),
                        Block(100, 8, 30, 0, -34, 85), Rod(11, 110, 0, -60, 50, kAlongY),
                        Rod(5, 110, 0, -115, 50, kAlongX)});
}

Solid MakeBenchChuck() {
  std::vector<Solid> bodies{Rod(75, 20, 0, 0, 10, kAlongZ), Rod(65, 45, 0, 0, 42.5, kAlongZ)};
  for (int k = 0; k < 3; ++k) {
    const double angle = 2 * pi * k / 3;
    bodies.push_back(Block(38, 18, 30, 37 * std::cos(angle), 37 * std::sin(angle), 79, angle));
  }
  return Merge("chuck", bodies);
}

Solid MakeHammer() {
  return Merge("hammer", {Rod(12, 260, 20, 0, 16, kAlongX), Rod(16, 50, -115, 28, 16, kAlongY),
                          Block(30, 45, 30, -115, -18, 16)});
}

/** The blade is 7 mm wide and 1.5 mm thick. */
Solid MakeScrewdriver() {
  const Solid handle = Turn({{0, 0}, {13, 4}, {16, 30}, {11, 85}, {14, 100}, {0, 100}});
  return Merge("screwdriver", {Move(handle, Frame(20, 0, 16, kAlongX, kAlongY)),
                               Rod(3, 140, -40, 0, 16, kAlongX), Block(12, 7, 1.5, -113, 0, 16)});
}

/** A combination spanner for hexagons of 14 mm: its ring has a hexagon 0.2 mm wider. */
Solid MakeSpanner() {
  constexpr double kHexagonWidth = 14.2;
  const Solid ring = Cut(Cylinder(22, 0, 8), Hexagon(kHexagonWidth, -1, 9),
                         Hexagon(kHexagonWidth, 0, 8).volume_mm3);
  return Merge("spanner", {Block(140, 14, 6, -2, 0, 4), Block(14, 28, 6, -70, 0, 4),
                           Block(22, 9, 6, -86, 12, 4, 0.25), Block(22, 9, 6, -86, -12, 4, -0.25),
                           Move(ring, Translation(78, 0, 0))});
}

Solid MakeCaliper() {
  return Merge("caliper", {Block(220, 16, 4, 0, 0, 6), Block(12, 45, 4, -100, -25, 6),
                           Block(60, 30, 8, -45, 2, 7), Block(12, 45, 4, -70, -28, 6),
                           Block(30, 14, 2, -40, 2, 12)});
}

Solid MakeTray() {
  return Merge("tray", {Block(200, 130, 4, 0, 0, 2), Block(200, 4, 45, 0, 63, 22.5),
                        Block(200, 4, 30, 0, -63, 15), Block(4, 130, 40, 98, 0, 20),
                        Block(4, 130, 40, -98, 0, 20), Block(4, 120, 28, 10, 0, 14)});
}

/** Its groove of 90 degrees is 30 mm wide at the top. */
Solid MakeVBlock() {
  const Solid block = Box(-45, -30, 0, 45, 30, 42);
  const Solid groove =
      Move(Box(-45, -15, -15, 45, 15, 15), Frame(0, 0, 42, gp_Dir(0, 1, 1), kAlongX));
  const double half = 15 * std::sqrt(2.0);
  return Cut(block, groove, half * half * 90);
}

}  // namespace

Drawing DrawHexKey(int width_mm) {
  constexpr double kUnder = 0.99;  // Of the nominal width: it goes into a socket drawn with that.
  return MakeDrawing("hex_key_" + std::to_string(width_mm),
                     MakeHexKey(kUnder * width_mm, kKeys.at(width_mm)), materials::kBoltSteel,
                     colors::kDarkSteel);
}

std::deque<Drawing> DrawTools() {
  std::deque<Drawing> tools;
  for (const auto& [width_mm, arms] : kKeys) {
    tools.push_back(DrawHexKey(width_mm));
  }
  tools.push_back(MakeDrawing("vise", MakeVise(), materials::kCastIron, colors::kCover));
  tools.push_back(MakeDrawing("chuck", MakeBenchChuck(), materials::kSteel, colors::kSteel));
  tools.push_back(MakeDrawing("hammer", MakeHammer(), materials::kSteel, colors::kBronze));
  tools.push_back(MakeDrawing("screwdriver", MakeScrewdriver(), materials::kSteel, colors::kRed));
  tools.push_back(MakeDrawing("spanner", MakeSpanner(), materials::kBoltSteel, colors::kSteel));
  tools.push_back(MakeDrawing("caliper", MakeCaliper(), materials::kSteel, colors::kSteel));
  tools.push_back(MakeDrawing("tray", MakeTray(), materials::kAluminium, colors::kBrass));
  tools.push_back(MakeDrawing("vblock", MakeVBlock(), materials::kSteel, colors::kDarkSteel));
  return tools;
}

}  // namespace hvas::products
