#pragma once

#include <vector>

#include <TopoDS_Shape.hxx>
#include <gp_Ax2.hxx>
#include <gp_Trsf.hxx>

/** Solids of the example products. This folder draws, so all its lengths are millimetres, as in the
 STEP files it writes; angles are radians. */
namespace hvas::products {

/** A shape with its volume worked out by hand beside it: from the formulas of the bodies it is made
 of, never from the shape, so that the one checks the other. */
struct Solid {
  TopoDS_Shape shape;
  double volume_mm3{0};
};

/** A corner of the half section of a turned body. */
struct RadiusHeight {
  double r{0};
  double z{0};
};

/** The body that the closed polygon `section` (counter-clockwise in r to the right, z up) sweeps in
 a turn by `angle` about z, starting at the x axis. Volume: sum of frustums (Pappus). */
[[nodiscard]] Solid Turn(const std::vector<RadiusHeight>& section,
                         double angle = 6.283185307179586);

/** A cylinder on z from `z0` to `z1`, its ends chamfered by 45 degrees over `c0` and `c1`. A
 negative chamfer widens the end: the tool for a hole with a lead-in. */
[[nodiscard]] Solid Cylinder(double diameter, double z0, double z1, double c0 = 0, double c1 = 0);

/** A tube on z; `outer_chamfer` and `inner_chamfer` at both ends. */
[[nodiscard]] Solid Tube(double outer_diameter, double inner_diameter, double z0, double z1,
                         double outer_chamfer = 0, double inner_chamfer = 0);

/** A ring about z whose section is a circle; `radius` is that of the middle of its section. */
[[nodiscard]] Solid Torus(double radius, double section_radius);

/** A point of a section in the plane of x and z. */
struct XZ {
  double x{0};
  double z{0};
};

/** The prism of a closed polygon between two planes across y. */
[[nodiscard]] Solid ExtrudeAlongY(const std::vector<XZ>& section, double y0, double y1);

[[nodiscard]] Solid Box(double x0, double y0, double z0, double x1, double y1, double z1);

/** Rounded rectangle of the given sizes about z, from `z0` to `z1`. */
[[nodiscard]] Solid RoundedPlate(double x_size, double y_size, double corner_radius, double z0,
                                 double z1);

/** Bar of the given length along x and width along y, with half-round ends. Its rims at `z0` and
 `z1` are chamfered by 45 degrees over `chamfer`. */
[[nodiscard]] Solid RoundEndedBar(double length, double width, double z0, double z1,
                                  double chamfer = 0);

/** Regular hexagon about z, measured across flats (flats look to +-x). */
[[nodiscard]] Solid Hexagon(double across_flats, double z0, double z1);

/** `body` without `tool`. `removed_mm3` is the volume they share; by default the whole tool. */
[[nodiscard]] Solid Cut(const Solid& body, const Solid& tool);
[[nodiscard]] Solid Cut(const Solid& body, const Solid& tool, double removed_mm3);

/** Cuts bodies that do not touch one another, all wholly inside `body`. */
[[nodiscard]] Solid CutAll(const Solid& body, const std::vector<Solid>& tools);

/** Joins bodies that share at most faces. */
[[nodiscard]] Solid Join(const Solid& a, const Solid& b);

[[nodiscard]] Solid Move(const Solid& body, const gp_Trsf& motion);
[[nodiscard]] gp_Trsf Translation(double x, double y, double z);

/** The motion that takes the origin to (x, y, z), and the z and x axes to the given ones. */
[[nodiscard]] gp_Trsf Frame(double x, double y, double z, const gp_Dir& z_axis,
                            const gp_Dir& x_axis);
[[nodiscard]] gp_Trsf RotationAboutZ(double angle);

/** Volume of the shape itself, by the kernel's fast rule: faces bounded by splines come out to
 * about 1e-4.
 */
[[nodiscard]] double CalcVolume(const TopoDS_Shape& shape);

/** Volume of the shape itself, by the kernel's adaptive rule, to 1e-6 or better. */
[[nodiscard]] double CalcVolumeFinely(const TopoDS_Shape& shape);

/** Integral of `f` over [a, b] by Gauss-Legendre on `panels` panels of five points. */
template <typename F>
[[nodiscard]] double Integrate(F f, double a, double b, int panels = 400) {
  constexpr double kX[3] = {0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr double kW[3] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  const double h = (b - a) / (2 * panels);
  double sum = 0;
  for (int i = 0; i < panels; ++i) {
    const double mid = a + (2 * i + 1) * h;
    sum += kW[0] * f(mid);
    for (int k = 1; k < 3; ++k)
      sum += kW[k] * (f(mid - kX[k] * h) + f(mid + kX[k] * h));
  }
  return sum * h;
}

}  // namespace hvas::products
