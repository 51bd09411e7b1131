#include "cad/brep/face_integrals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <BRepAdaptor_Curve2d.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRep_Tool.hxx>
#include <GeomAbs_Shape.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>
#include <math.hxx>
#include <math_Vector.hxx>

namespace hvas::cad {
namespace {

constexpr double kSpanTolerance =
    1e-9;                          // Of a span of an edge, relative to the whole face: a choice.
constexpr int kMostHalvings = 16;  // Of a span; a kink in it then errs by 2e-10 of the span.
constexpr int kEdgeNodes = 4;      // Of 4, 6 and 8 the quickest on parts with many spline faces.

/** Area, volume, first (3) and second moments (xx, yy, zz, xy, yz, zx). */
using Integrals = Eigen::Array<double, 11, 1>;

/** Nodes and weights of Gauss and Legendre on [-1, 1]. */
struct GaussRule {
  explicit GaussRule(int count) : nodes(1, count), weights(1, count) {
    math::OrderedGaussPointsAndWeights(count, nodes, weights);
  }

  /** Integral of f over [from, to], which may be turned round. */
  template <typename Function>
  [[nodiscard]] Integrals Integrate(double from, double to, const Function& f) const {
    Integrals sum = Integrals::Zero();
    const double half = (to - from) / 2;
    for (int i = 1; i <= nodes.Length(); ++i) {
      sum += half * weights(i) * f((from + to) / 2 + half * nodes(i));
    }
    return sum;
  }

  math_Vector nodes, weights;
};

const GaussRule& RuleOf(int count) {
  constexpr int kMost = 16;  // A choice: splines of degree 6, others err a little.
  static const std::vector<GaussRule> rules = [] {
    std::vector<GaussRule> made;
    made.reserve(kMost);
    for (int n = 1; n <= kMost; ++n) {
      made.emplace_back(n);
    }
    return made;
  }();
  return rules[static_cast<std::size_t>(std::clamp(count, 1, kMost) - 1)];
}

/** What is integrated over the parameters of a surface. One of these runs along the edges, the
 other one across the face. */
class Integrand {
 public:
  Integrand(const TopoDS_Face& face, const gp_Pnt& about)
      : surface_(face, /*R=*/false), about_(about) {
    switch (surface_.GetType()) {
      case GeomAbs_Plane:
      case GeomAbs_Cylinder:
      case GeomAbs_Cone:
        ChooseV(3);  // Polynomials of degree 4 along the straight lines.
        break;
      case GeomAbs_SurfaceOfExtrusion:
        ChooseV(3);
        knots_along_ = ListKnots(/*of_v=*/false);
        break;
      case GeomAbs_Sphere:
      case GeomAbs_Torus:
        ChooseTurn();
        break;
      case GeomAbs_SurfaceOfRevolution:
        ChooseTurn();
        knots_along_ = ListKnots(/*of_v=*/true);
        break;
      default:
        ChooseOfSpline();
    }
  }

  /** Whether the second parameter runs across the face. */
  [[nodiscard]] bool is_across_v() const { return is_across_v_; }

  /** Where the surface is not smooth along an edge, in rising order. */
  [[nodiscard]] const std::vector<double>& knots_along() const { return knots_along_; }

  /** Integral across the face from one parameter to another, at one along it. */
  [[nodiscard]] Integrals Across(double from, double to, double along) const {
    if (to < from) {
      return -Across(to, from, along);
    }
    Integrals sum = Integrals::Zero();
    double start = from;
    for (auto knot = std::upper_bound(knots_.begin(), knots_.end(), from);
         knot != knots_.end() && *knot < to; ++knot) {
      sum += AcrossPiece(start, *knot, along);
      start = *knot;
    }
    const int pieces = CountPieces(to - start);
    const double length = (to - start) / pieces;
    for (int i = 0; i < pieces; ++i) {
      sum += AcrossPiece(start + i * length, start + (i + 1) * length, along);
    }
    return sum;
  }

  /** Distance of a place on the surface from the point. */
  [[nodiscard]] double CalcReach(double across, double along) const {
    const gp_Pnt point =
        is_across_v_ ? surface_.Value(along, across) : surface_.Value(across, along);
    return point.Distance(about_);
  }

 private:
  void ChooseV(int nodes) {
    is_across_v_ = true;
    rule_ = &RuleOf(nodes);
  }

  void ChooseTurn() {
    longest_ = std::numbers::pi / 2;  // Trigonometric polynomials of degree 3: to 1e-10.
    rule_ = &RuleOf(8);
  }

  void ChooseOfSpline() {
    is_across_v_ = surface_.NbVIntervals(GeomAbs_CN) <= surface_.NbUIntervals(GeomAbs_CN);
    knots_ = ListKnots(is_across_v_);
    knots_along_ = ListKnots(!is_across_v_);
    const bool has_degree =
        surface_.GetType() == GeomAbs_BSplineSurface || surface_.GetType() == GeomAbs_BezierSurface;
    const int degree = !has_degree ? 3 : is_across_v_ ? surface_.VDegree() : surface_.UDegree();
    rule_ = &RuleOf((5 * degree + 1) / 2);  // Polynomials of degree 5 p - 1.
  }

  [[nodiscard]] std::vector<double> ListKnots(bool of_v) const {
    const int count = of_v ? surface_.NbVIntervals(GeomAbs_CN) : surface_.NbUIntervals(GeomAbs_CN);
    TColStd_Array1OfReal knots(1, count + 1);
    of_v ? surface_.VIntervals(knots, GeomAbs_CN) : surface_.UIntervals(knots, GeomAbs_CN);
    return {knots.begin(), knots.end()};
  }

  /** How many pieces a way across takes; boundaries more than 16 turns away are damaged. */
  [[nodiscard]] int CountPieces(double length) const {
    return length > longest_ ? static_cast<int>(std::ceil(std::min(length / longest_, 64.0))) : 1;
  }

  [[nodiscard]] Integrals AcrossPiece(double from, double to, double along) const {
    return rule_->Integrate(from, to, [&](double across) {
      return is_across_v_ ? Evaluate(along, across) : Evaluate(across, along);
    });
  }

  [[nodiscard]] Integrals Evaluate(double u, double v) const {
    gp_Pnt point;
    gp_Vec by_u;
    gp_Vec by_v;
    surface_.D1(u, v, point, by_u, by_v);
    const gp_Vec normal = by_u.Crossed(by_v);
    const gp_Vec r(about_, point);
    const double height = normal.Dot(r);
    const gp_Vec by4 = r * (height / 4);
    const gp_Vec by5 = r * (height / 5);
    Integrals values;
    values << normal.Magnitude(), height / 3, by4.X(), by4.Y(), by4.Z(), by5.X() * r.X(),
        by5.Y() * r.Y(), by5.Z() * r.Z(), by5.X() * r.Y(), by5.Y() * r.Z(), by5.Z() * r.X();
    return values;
  }

  BRepAdaptor_Surface surface_;
  gp_Pnt about_;
  bool is_across_v_{false};
  double longest_{std::numeric_limits<double>::infinity()};  // Of a piece across.
  const GaussRule* rule_{nullptr};
  std::vector<double> knots_;  // Across, in rising order.
  std::vector<double> knots_along_;
};

/** An edge in the parameters of the surface, in the direction of its use. */
struct Boundary {
  BRepAdaptor_Curve2d curve;
  bool is_reversed{false};
};

/** A part of an edge, and its integral by a single use of the rule. */
struct Span {
  const Boundary* boundary;
  double from, to;
  Integrals whole;
};

class FaceIntegration {
 public:
  FaceIntegration(const TopoDS_Face& face, const gp_Pnt& about) : integrand_(face, about) {
    for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
      const TopoDS_Edge& edge = TopoDS::Edge(it.Current());
      if (edge.Orientation() == TopAbs_FORWARD || edge.Orientation() == TopAbs_REVERSED) {
        boundaries_.push_back(
            {BRepAdaptor_Curve2d(edge, face), edge.Orientation() == TopAbs_REVERSED});
      }
    }
  }

  [[nodiscard]] bool is_bounded() const { return !boundaries_.empty(); }

  [[nodiscard]] Integrals Run() {
    origin_ = std::numeric_limits<double>::infinity();
    for (const Boundary& boundary : boundaries_) {
      origin_ = std::min({origin_, PlaceAt(boundary, boundary.curve.FirstParameter()).across,
                          PlaceAt(boundary, boundary.curve.LastParameter()).across});
    }
    std::vector<Span> spans;
    double reach = 0;
    double area = 0;
    for (const Boundary& boundary : boundaries_) {
      const std::vector<double> cuts = ListCuts(boundary);
      for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        spans.push_back(
            {&boundary, cuts[i], cuts[i + 1], Integrate(boundary, cuts[i], cuts[i + 1])});
        area += std::abs(spans.back().whole[0]);
        const Place place = PlaceAt(boundary, cuts[i]);
        reach = std::max(reach, integrand_.CalcReach(place.across, place.along));
      }
    }
    const double second = reach * reach * reach / 5;
    tolerances_ << 1, reach / 3, Eigen::Array3d::Constant(reach * reach / 4),
        Eigen::Array<double, 6, 1>::Constant(second);
    tolerances_ *= kSpanTolerance * area;
    Integrals sum = Integrals::Zero();
    for (const Span& span : spans) {
      sum += Refine(span, kMostHalvings);
    }
    return sum;
  }

 private:
  /** Parameters of the surface across the face and along its edge, and how the latter changes. */
  struct Place {
    double across, along, along_rate;
  };

  [[nodiscard]] Place PlaceAt(const Boundary& boundary, double t) const {
    gp_Pnt2d place;
    gp_Vec2d rate;
    boundary.curve.D1(t, place, rate);
    return integrand_.is_across_v() ? Place{place.Y(), place.X(), -rate.X()}
                                    : Place{place.X(), place.Y(), rate.Y()};
  }

  /** Where an edge begins, ends, and may have kinks; none where it adds nothing. */
  [[nodiscard]] std::vector<double> ListCuts(const Boundary& boundary) const {
    const BRepAdaptor_Curve2d& curve = boundary.curve;
    const double first = curve.FirstParameter();
    const double last = curve.LastParameter();
    if (curve.GetType() == GeomAbs_Line) {
      const Place place = PlaceAt(boundary, first);
      if (place.along_rate == 0) {
        return {};
      }
      const double rate = integrand_.is_across_v() ? -place.along_rate : place.along_rate;
      std::vector<double> cuts{first};
      for (const double knot : integrand_.knots_along()) {
        const double t = first + (knot - place.along) / rate;
        if (t > first && t < last) {
          cuts.push_back(t);
        }
      }
      cuts.push_back(last);
      std::sort(cuts.begin(), cuts.end());
      return cuts;
    }
    TColStd_Array1OfReal knots(1, curve.NbIntervals(GeomAbs_C2) + 1);
    curve.Intervals(knots, GeomAbs_C2);
    return {knots.begin(), knots.end()};
  }

  [[nodiscard]] Integrals Integrate(const Boundary& boundary, double from, double to) const {
    Integrals sum = RuleOf(kEdgeNodes).Integrate(from, to, [&](double t) -> Integrals {
      const Place place = PlaceAt(boundary, t);
      return place.along_rate * integrand_.Across(origin_, place.across, place.along);
    });
    sum *= boundary.is_reversed ? -1 : 1;
    return sum;
  }

  /** The integral of a span, halved as often as it takes. */
  [[nodiscard]] Integrals Refine(const Span& span, int halvings_left) const {
    const double middle = (span.from + span.to) / 2;
    const Span first{span.boundary, span.from, middle,
                     Integrate(*span.boundary, span.from, middle)};
    const Span second{span.boundary, middle, span.to, Integrate(*span.boundary, middle, span.to)};
    Integrals sum = first.whole + second.whole;
    if (halvings_left == 0 || !((sum - span.whole).abs() > tolerances_).any()) {
      return sum;
    }
    return Refine(first, halvings_left - 1) + Refine(second, halvings_left - 1);
  }

  Integrand integrand_;
  std::vector<Boundary> boundaries_;
  double origin_{0};  // Parameter from which is integrated across the face.
  Integrals tolerances_{Integrals::Zero()};
};

}  // namespace

std::optional<FaceIntegrals> IntegrateFace(const TopoDS_Face& face, const gp_Pnt& about) {
  TopLoc_Location location;
  if (BRep_Tool::Surface(face, location).IsNull()) {
    return std::nullopt;
  }
  FaceIntegration integration(TopoDS::Face(face.Oriented(TopAbs_FORWARD)), about);
  if (!integration.is_bounded()) {
    return std::nullopt;
  }
  Integrals sum = integration.Run();
  // The material is where the boundary says, also where its edges run the wrong way round.
  if ((sum[0] < 0) != (face.Orientation() == TopAbs_REVERSED)) {
    sum = -sum;
  }
  FaceIntegrals integrals;
  integrals.area_mm2 = std::abs(sum[0]);
  integrals.volume_mm3 = sum[1];
  integrals.first_mm4 = sum.segment<3>(2);
  const double xx = sum[5];
  const double yy = sum[6];
  const double zz = sum[7];
  integrals.inertia_mm5 << yy + zz, -sum[8], -sum[10], -sum[8], xx + zz, -sum[9], -sum[10], -sum[9],
      xx + yy;
  return integrals;
}

}  // namespace hvas::cad
