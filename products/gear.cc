#include "gear.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <Geom_BSplineCurve.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <gp_Pnt.hxx>

namespace hvas::products {
namespace {

using std::numbers::pi;

constexpr int kFlankPoints = 13;

gp_Pnt Polar(double r, double angle, double z) {
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/** The flank at `side` (-1 or +1) of the tooth at `angle`, from the base circle to the tip. */
Handle(Geom_BSplineCurve) Flank(const GearShape& gear, double angle, int side, double z) {
  const double base = gear.teeth * gear.module / 2 * std::cos(gear.pressure_angle);
  const double tip = gear.tip_diameter / 2;
  const double roll_end = std::sqrt(tip * tip / (base * base) - 1);
  const Handle(TColgp_HArray1OfPnt) points = new TColgp_HArray1OfPnt(1, kFlankPoints);
  const Handle(TColStd_HArray1OfReal) parameters = new TColStd_HArray1OfReal(1, kFlankPoints);
  for (int i = 0; i < kFlankPoints; ++i) {
    const double roll = roll_end * i / (kFlankPoints - 1);
    const double r = base * std::sqrt(1 + roll * roll);
    points->SetValue(i + 1, Polar(r, angle + side * gear.CalcHalfToothAngle(r), z));
    parameters->SetValue(i + 1, roll * roll);  // In proportion to the involute's length.
  }
  // The tangent turns with the roll; an involute leaves its base circle at a right angle.
  const double start = angle + side * gear.CalcHalfToothAngle(base);
  const double end = start - side * roll_end;
  const double speed = base / 2;
  GeomAPI_Interpolate interpolate(points, parameters, /*PeriodicFlag=*/Standard_False, 1e-7);
  interpolate.Load(gp_Vec(speed * std::cos(start), speed * std::sin(start), 0),
                   gp_Vec(speed * std::cos(end), speed * std::sin(end), 0),
                   /*Scale=*/Standard_False);
  interpolate.Perform();
  return interpolate.Curve();
}

TopoDS_Face Profile(const GearShape& gear, double z, double angle) {
  const double base = gear.teeth * gear.module / 2 * std::cos(gear.pressure_angle);
  const double tip = gear.tip_diameter / 2, root = gear.root_diameter / 2;
  const double base_half = gear.CalcHalfToothAngle(base), tip_half = gear.CalcHalfToothAngle(tip);
  const double pitch = 2 * pi / gear.teeth;
  BRepBuilderAPI_MakeWire wire;
  for (int i = 0; i < gear.teeth; ++i) {
    const double a = angle + i * pitch;
    const auto add_arc = [&](double r, double from, double to) {
      wire.Add(
          BRepBuilderAPI_MakeEdge(
              GC_MakeArcOfCircle(Polar(r, from, z), Polar(r, (from + to) / 2, z), Polar(r, to, z))
                  .Value())
              .Edge());
    };
    const auto add_line = [&](double r0, double r1, double at) {
      wire.Add(BRepBuilderAPI_MakeEdge(Polar(r0, at, z), Polar(r1, at, z)).Edge());
    };
    add_line(root, base, a - base_half);
    wire.Add(BRepBuilderAPI_MakeEdge(Flank(gear, a, -1, z)).Edge());
    add_arc(tip, a - tip_half, a + tip_half);
    wire.Add(BRepBuilderAPI_MakeEdge(Flank(gear, a, +1, z)).Edge());
    add_line(base, root, a + base_half);
    add_arc(root, a + base_half, a + pitch - base_half);
  }
  return BRepBuilderAPI_MakeFace(wire.Wire(), /*OnlyPlane=*/true).Face();
}

}  // namespace

double GearShape::CalcHalfToothAngle(double r) const {
  const auto involute = [](double alpha) { return std::tan(alpha) - alpha; };
  const double pitch_radius = teeth * module / 2;
  const double base = pitch_radius * std::cos(pressure_angle);
  const double half_at_pitch = (pi * module / 2 - backlash) / 2 / pitch_radius;
  const double alpha = std::acos(std::min(1.0, base / r));
  return half_at_pitch + involute(pressure_angle) - involute(alpha);
}

Solid MakeGear(const GearShape& gear, double z0, double z1, double angle) {
  const double tip = gear.tip_diameter / 2, root = gear.root_diameter / 2, c = gear.tip_chamfer;
  const double base = gear.teeth * gear.module / 2 * std::cos(gear.pressure_angle);
  const auto ring = [&gear](double r) { return 2 * gear.teeth * gear.CalcHalfToothAngle(r) * r; };
  const double area = pi * root * root + Integrate(ring, root, base) + Integrate(ring, base, tip);
  const Solid blank{BRepPrimAPI_MakePrism(Profile(gear, z0, angle), gp_Vec(0, 0, z1 - z0)).Shape(),
                    area * (z1 - z0)};
  const double chamfer_mm3 =
      Integrate([&](double r) { return ring(r) * (r - (tip - c)); }, tip - c, tip);
  const double out = c + 1;  // The cutters reach past the tips.
  const Solid low = Turn({{tip - c, z0}, {tip - c + out, z0}, {tip - c + out, z0 + out}});
  const Solid high = Turn({{tip - c, z1}, {tip - c + out, z1 - out}, {tip - c + out, z1}});
  return Cut(Cut(blank, low, chamfer_mm3), high, chamfer_mm3);
}

}  // namespace hvas::products
