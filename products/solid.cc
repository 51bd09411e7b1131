#include "solid.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepFilletAPI_MakeChamfer.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <gp_Ax1.hxx>
#include <gp_Ax3.hxx>
#include <gp_Pnt.hxx>

namespace hvas::products {
namespace {

using std::numbers::pi;

TopoDS_Shape Prism(const TopoDS_Wire& wire, double z0, double z1) {
  const BRepBuilderAPI_MakeFace face(wire);
  gp_Trsf lift;
  lift.SetTranslation(gp_Vec(0, 0, z0));
  const TopoDS_Shape bottom = face.Face().Moved(TopLoc_Location(lift));
  return BRepPrimAPI_MakePrism(bottom, gp_Vec(0, 0, z1 - z0)).Shape();
}

/** The only solid of a boolean's result. */
TopoDS_Shape OnlySolid(const TopoDS_Shape& result) {
  TopExp_Explorer it(result, TopAbs_SOLID);
  if (!it.More()) throw std::runtime_error("boolean operation left no solid");
  const TopoDS_Shape solid = it.Current();
  it.Next();
  if (it.More()) throw std::runtime_error("boolean operation left more than one solid");
  return solid;
}

TopoDS_Edge Arc(const gp_Pnt& from, const gp_Pnt& via, const gp_Pnt& to) {
  return BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(from, via, to).Value()).Edge();
}

TopoDS_Edge Line(const gp_Pnt& from, const gp_Pnt& to) {
  return BRepBuilderAPI_MakeEdge(from, to).Edge();
}

}  // namespace

Solid Turn(const std::vector<RadiusHeight>& section, double angle) {
  BRepBuilderAPI_MakePolygon polygon;
  double volume = 0;
  for (std::size_t i = 0; i < section.size(); ++i) {
    const auto [r0, z0] = section[i];
    const auto [r1, z1] = section[(i + 1) % section.size()];
    polygon.Add(gp_Pnt(r0, 0, z0));
    volume += angle / 6 * (z1 - z0) * (r0 * r0 + r0 * r1 + r1 * r1);
  }
  polygon.Close();
  const BRepBuilderAPI_MakeFace face(polygon.Wire(), /*OnlyPlane=*/true);
  const gp_Ax1 axis(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1));
  const bool full = angle > 2 * pi - 1e-9;
  const TopoDS_Shape shape = full ? BRepPrimAPI_MakeRevol(face.Face(), axis).Shape()
                                  : BRepPrimAPI_MakeRevol(face.Face(), axis, angle).Shape();
  // The sweep of a face may come out inside out, by the turn of the polygon.
  return {CalcVolume(shape) < 0 ? shape.Reversed() : shape, volume};
}

Solid Cylinder(double diameter, double z0, double z1, double c0, double c1) {
  const double r = diameter / 2;
  std::vector<RadiusHeight> section{{0, z0}, {r - c0, z0}};
  if (c0 != 0) section.push_back({r, z0 + std::abs(c0)});
  if (c1 != 0) section.push_back({r, z1 - std::abs(c1)});
  section.push_back({r - c1, z1});
  section.push_back({0, z1});
  return Turn(section);
}

Solid Tube(double outer_diameter, double inner_diameter, double z0, double z1, double outer_chamfer,
           double inner_chamfer) {
  const double ri = inner_diameter / 2, ro = outer_diameter / 2;
  std::vector<RadiusHeight> section{{ri + inner_chamfer, z0}, {ro - outer_chamfer, z0}};
  if (outer_chamfer > 0) {
    section.push_back({ro, z0 + outer_chamfer});
    section.push_back({ro, z1 - outer_chamfer});
  }
  section.push_back({ro - outer_chamfer, z1});
  section.push_back({ri + inner_chamfer, z1});
  if (inner_chamfer > 0) {
    section.push_back({ri, z1 - inner_chamfer});
    section.push_back({ri, z0 + inner_chamfer});
  }
  return Turn(section);
}

Solid Torus(double radius, double section_radius) {
  return {BRepPrimAPI_MakeTorus(radius, section_radius).Shape(),
          2 * pi * pi * radius * section_radius * section_radius};
}

Solid ExtrudeAlongY(const std::vector<XZ>& section, double y0, double y1) {
  BRepBuilderAPI_MakePolygon polygon;
  double twice_area = 0;
  for (std::size_t i = 0; i < section.size(); ++i) {
    const auto [x_0, z_0] = section[i];
    const auto [x_1, z_1] = section[(i + 1) % section.size()];
    polygon.Add(gp_Pnt(x_0, y0, z_0));
    twice_area += x_0 * z_1 - x_1 * z_0;
  }
  polygon.Close();
  const BRepBuilderAPI_MakeFace face(polygon.Wire(), /*OnlyPlane=*/true);
  const TopoDS_Shape shape = BRepPrimAPI_MakePrism(face.Face(), gp_Vec(0, y1 - y0, 0)).Shape();
  return {CalcVolume(shape) < 0 ? shape.Reversed() : shape, 0.5 * std::abs(twice_area) * (y1 - y0)};
}

Solid Box(double x0, double y0, double z0, double x1, double y1, double z1) {
  return {BRepPrimAPI_MakeBox(gp_Pnt(x0, y0, z0), gp_Pnt(x1, y1, z1)).Shape(),
          (x1 - x0) * (y1 - y0) * (z1 - z0)};
}

Solid RoundedPlate(double x_size, double y_size, double corner_radius, double z0, double z1) {
  const double x = x_size / 2, y = y_size / 2, r = corner_radius, d = r * (1 - std::sqrt(0.5));
  BRepBuilderAPI_MakeWire wire;
  const auto p = [](double px, double py) { return gp_Pnt(px, py, 0); };
  wire.Add(Line(p(-x + r, -y), p(x - r, -y)));
  wire.Add(Arc(p(x - r, -y), p(x - d, -y + d), p(x, -y + r)));
  wire.Add(Line(p(x, -y + r), p(x, y - r)));
  wire.Add(Arc(p(x, y - r), p(x - d, y - d), p(x - r, y)));
  wire.Add(Line(p(x - r, y), p(-x + r, y)));
  wire.Add(Arc(p(-x + r, y), p(-x + d, y - d), p(-x, y - r)));
  wire.Add(Line(p(-x, y - r), p(-x, -y + r)));
  wire.Add(Arc(p(-x, -y + r), p(-x + d, -y + d), p(-x + r, -y)));
  return {Prism(wire.Wire(), z0, z1), (x_size * y_size - (4 - pi) * r * r) * (z1 - z0)};
}

Solid RoundEndedBar(double length, double width, double z0, double z1, double chamfer) {
  const double r = width / 2, x = length / 2 - r;
  BRepBuilderAPI_MakeWire wire;
  const auto p = [](double px, double py) { return gp_Pnt(px, py, 0); };
  wire.Add(Line(p(-x, -r), p(x, -r)));
  wire.Add(Arc(p(x, -r), p(x + r, 0), p(x, r)));
  wire.Add(Line(p(x, r), p(-x, r)));
  wire.Add(Arc(p(-x, r), p(-x - r, 0), p(-x, -r)));
  const TopoDS_Shape bar = Prism(wire.Wire(), z0, z1);
  const auto area = [x](double radius) { return 4 * x * radius + pi * radius * radius; };
  if (chamfer == 0) return {bar, area(r) * (z1 - z0)};
  BRepFilletAPI_MakeChamfer chamfers(bar);
  for (TopExp_Explorer it(bar, TopAbs_EDGE); it.More(); it.Next()) {
    // Each rim is one smooth contour: an edge that it has already is refused without harm.
    const TopoDS_Edge edge = TopoDS::Edge(it.Current());
    const BRepAdaptor_Curve curve(edge);
    const double za = curve.Value(curve.FirstParameter()).Z();
    if (std::abs(za - curve.Value(curve.LastParameter()).Z()) < 1e-9) chamfers.Add(chamfer, edge);
  }
  return {OnlySolid(chamfers.Shape()),
          area(r) * (z1 - z0 - 2 * chamfer) + 2 * Integrate(area, r - chamfer, r, 1)};
}

Solid Hexagon(double across_flats, double z0, double z1) {
  const double corner = across_flats / std::sqrt(3.0);
  BRepBuilderAPI_MakePolygon polygon;
  for (int i = 0; i < 6; ++i) {
    const double a = pi / 6 + i * pi / 3;
    polygon.Add(gp_Pnt(corner * std::cos(a), corner * std::sin(a), 0));
  }
  polygon.Close();
  return {Prism(polygon.Wire(), z0, z1),
          std::sqrt(3.0) / 2 * across_flats * across_flats * (z1 - z0)};
}

Solid Cut(const Solid& body, const Solid& tool) {
  return Cut(body, tool, tool.volume_mm3);
}

Solid Cut(const Solid& body, const Solid& tool, double removed_mm3) {
  return {OnlySolid(BRepAlgoAPI_Cut(body.shape, tool.shape).Shape()),
          body.volume_mm3 - removed_mm3};
}

Solid CutAll(const Solid& body, const std::vector<Solid>& tools) {
  TopTools_ListOfShape arguments, tool_shapes;
  arguments.Append(body.shape);
  double volume = body.volume_mm3;
  for (const Solid& tool : tools) {
    tool_shapes.Append(tool.shape);
    volume -= tool.volume_mm3;
  }
  BRepAlgoAPI_Cut cut;
  cut.SetArguments(arguments);
  cut.SetTools(tool_shapes);
  cut.Build();
  return {OnlySolid(cut.Shape()), volume};
}

Solid Join(const Solid& a, const Solid& b) {
  return {OnlySolid(BRepAlgoAPI_Fuse(a.shape, b.shape).Shape()), a.volume_mm3 + b.volume_mm3};
}

Solid Move(const Solid& body, const gp_Trsf& motion) {
  return {BRepBuilderAPI_Transform(body.shape, motion, /*Copy=*/true).Shape(), body.volume_mm3};
}

gp_Trsf Translation(double x, double y, double z) {
  gp_Trsf motion;
  motion.SetTranslation(gp_Vec(x, y, z));
  return motion;
}

gp_Trsf Frame(double x, double y, double z, const gp_Dir& z_axis, const gp_Dir& x_axis) {
  gp_Trsf motion;
  motion.SetTransformation(gp_Ax3(gp_Pnt(x, y, z), z_axis, x_axis), gp_Ax3());
  return motion;
}

gp_Trsf RotationAboutZ(double angle) {
  gp_Trsf motion;
  motion.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), angle);
  return motion;
}

double CalcVolume(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass();
}

double CalcVolumeFinely(const TopoDS_Shape& shape) {
  // Not VolumeProperties with a tolerance, which misses by 1e-4 on a gear's end faces, whatever
  // the tolerance.
  GProp_GProps properties;
  BRepGProp::VolumePropertiesGK(shape, properties, 1e-6, /*OnlyClosed=*/Standard_False,
                                /*IsUseSpan=*/Standard_True);
  return properties.Mass();
}

}  // namespace hvas::products
