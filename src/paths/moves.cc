#include "paths/moves.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "contact/shape_data.h"
#include "spatial/surface.h"

namespace hvas::paths {
namespace {

using spatial::Pose;
using spatial::SurfaceKind;

constexpr double kSameDirection = 1 - 1e-5;  // Cosine; 0.26 degrees.
constexpr std::size_t kMostDirections = 24;  // A choice; each costs a push from each pose.
constexpr std::size_t kMostAxes = 14;        // A choice, likewise.
constexpr double kSameLine = 0.01;           // Of the part's size: lines nearer than this are one.

void AddDirection(const Vec3& direction, std::vector<Vec3>* directions) {
  const double length = direction.norm();
  if (length < 1e-6 || directions->size() >= kMostDirections) {
    return;
  }
  const Vec3 unit = direction / length;
  const bool is_known = std::any_of(directions->begin(), directions->end(),
                                    [&](const Vec3& d) { return d.dot(unit) > kSameDirection; });
  if (!is_known) {
    directions->push_back(unit);
  }
}

void AddAxis(const ScrewAxis& axis, double near, std::vector<ScrewAxis>* axes) {
  if (axes->size() >= kMostAxes) {
    return;
  }
  const bool is_known = std::any_of(axes->begin(), axes->end(), [&](const ScrewAxis& a) {
    const bool is_parallel = std::abs(a.axis_W.dot(axis.axis_W)) > kSameDirection;
    return is_parallel && (a.p_WQ - axis.p_WQ).cross(a.axis_W).norm() < near;
  });
  if (!is_known) {
    axes->push_back(axis);
  }
}

std::vector<double> ListFaceAreas(const contact::Shape& shape) {
  const contact::Shape::Data& data = shape.data();
  std::vector<double> area(data.exact.faces.size(), 0.0);
  for (std::size_t t = 0; t < data.mesh.triangles.size(); ++t) {
    const auto& k = data.mesh.triangles[t];
    const Vec3 a = data.mesh.vertices[k[1]] - data.mesh.vertices[k[0]];
    const Vec3 b = data.mesh.vertices[k[2]] - data.mesh.vertices[k[0]];
    area[data.mesh.face[t]] += 0.5 * a.cross(b).norm();
  }
  return area;
}

bool IsRound(SurfaceKind kind) {
  return kind == SurfaceKind::kCylinder || kind == SurfaceKind::kCone ||
         kind == SurfaceKind::kTorus;
}

// Axes of a shape's round faces in W, with the largest area of a face first.
std::vector<ScrewAxis> ListRoundAxes(const contact::Shape& shape, const Pose& X_WB) {
  const contact::Shape::Data& data = shape.data();
  const std::vector<double> area = ListFaceAreas(shape);
  std::vector<std::size_t> round;
  for (std::size_t f = 0; f < data.exact.faces.size(); ++f) {
    if (IsRound(data.exact.faces[f].kind)) {
      round.push_back(f);
    }
  }
  std::stable_sort(round.begin(), round.end(),
                   [&](std::size_t f, std::size_t g) { return area[f] > area[g]; });
  const Pose X_WC = X_WB * Pose(data.p_BC);
  std::vector<ScrewAxis> axes;
  for (const std::size_t f : round) {
    const spatial::Surface& surface = data.exact.faces[f];
    axes.push_back({X_WC * surface.origin, (X_WC.q() * surface.axis).normalized(), 0});
  }
  return axes;
}

// A direction of planes and axes, either way, and the area of their faces.
struct FaceDirection {
  Vec3 unit_W;
  double area{0};
};

void AddFaceDirections(const contact::Shape& shape, const Pose& X_WB,
                       std::vector<FaceDirection>* directions) {
  const contact::Shape::Data& data = shape.data();
  const std::vector<double> area = ListFaceAreas(shape);
  for (std::size_t f = 0; f < data.exact.faces.size(); ++f) {
    const spatial::Surface& surface = data.exact.faces[f];
    if (surface.kind != SurfaceKind::kPlane && !IsRound(surface.kind)) {
      continue;
    }
    const Vec3 unit_W = (X_WB.q() * surface.axis).normalized();
    const auto known =
        std::find_if(directions->begin(), directions->end(), [&](const FaceDirection& one) {
          return std::abs(one.unit_W.dot(unit_W)) > kSameDirection;
        });
    if (known != directions->end()) {
      known->area += area[f];
    } else {
      directions->push_back({unit_W, area[f]});
    }
  }
}

// Directions at right angles, three at most.
class Frame {
 public:
  void Add(const Vec3& unit_W) {
    constexpr double kApart = 0.5;  // Sine: 30 degrees from what is there. A choice.
    Vec3 rest_W = unit_W;
    for (int i = 0; i < count_; ++i) {
      rest_W -= rest_W.dot(columns_.col(i)) * columns_.col(i);
    }
    if (!is_full() && rest_W.norm() > kApart) {
      columns_.col(count_++) = rest_W.normalized();
    }
  }

  // The largest faces first.
  void Add(std::vector<FaceDirection> directions) {
    std::stable_sort(directions.begin(), directions.end(),
                     [](const auto& a, const auto& b) { return a.area > b.area; });
    for (const FaceDirection& direction : directions) {
      Add(direction.unit_W);
    }
  }

  [[nodiscard]] bool is_full() const { return count_ == 3; }

  [[nodiscard]] const Mat3& columns() const { return columns_; }

 private:
  Mat3 columns_{Mat3::Identity()};
  int count_{0};
};

// Three directions at right angles: those of the part's largest faces, then of those around it,
// whatever the frame is in which they were drawn. Where that frame has the same, it is taken as it
// is.
Mat3 FindFrame(const Probe& probe) {
  const WayProblem& problem = probe.problem();
  const Mat3 R = problem.X_WB_start.R();
  Frame frame;
  std::vector<FaceDirection> own;
  AddFaceDirections(*problem.part, problem.X_WB_start, &own);
  frame.Add(std::move(own));
  if (!frame.is_full()) {
    std::vector<FaceDirection> around;
    for (const contact::BodyId body : probe.bodies()) {
      AddFaceDirections(problem.scene->shape(body), problem.scene->pose(body), &around);
    }
    frame.Add(std::move(around));
  }
  for (int i = 0; i < 3; ++i) {
    frame.Add(Vec3(R.col(i)));
  }
  const Mat3 cosines = (R.transpose() * frame.columns()).cwiseAbs();
  return cosines.colwise().maxCoeff().minCoeff() > kSameDirection ? R : frame.columns();
}

std::vector<contact::Contact> ListStartContacts(Probe* probe) {
  const double near = std::max(0.3e-3, 2 * std::abs(probe->tolerance()));
  probe->Query(probe->problem().X_WB_start, std::min(near, 0.01 * probe->size()));
  return {probe->contacts().begin(), probe->contacts().end()};
}

}  // namespace

std::vector<Vec3> ListDirections(Probe* probe) {
  std::vector<Vec3> directions;
  const WayProblem& problem = probe->problem();
  for (const Vec3& d : problem.directions_W) {
    AddDirection(d, &directions);
  }
  const std::vector<contact::Contact> contacts = ListStartContacts(probe);
  const Mat3 R = FindFrame(*probe);
  std::vector<Vec3> normals;
  for (const contact::Contact& c : contacts) {
    if (normals.size() < 6) {
      AddDirection(c.nhat_W, &normals);
    }
  }
  for (const ScrewAxis& axis : problem.axes) {
    AddDirection(axis.axis_W, &directions);
    AddDirection(-axis.axis_W, &directions);
  }
  for (const Vec3& n : normals) {
    AddDirection(n, &directions);
  }
  for (int i = 0; i < 3; ++i) {
    AddDirection(R.col(i), &directions);
    AddDirection(-R.col(i), &directions);
  }
  for (std::size_t i = 0; i < normals.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Vec3 across = normals[i].cross(normals[k]);
      if (across.norm() > 0.2) {
        AddDirection(across, &directions);
        AddDirection(-across, &directions);
      }
    }
  }
  std::size_t round = 0;
  for (const ScrewAxis& axis : ListRoundAxes(*problem.part, problem.X_WB_start)) {
    AddDirection(axis.axis_W, &directions);
    AddDirection(-axis.axis_W, &directions);
    if (++round == 3) {
      break;
    }
  }
  return directions;
}

std::vector<ScrewAxis> ListAxes(Probe* probe) {
  const WayProblem& problem = probe->problem();
  const double near = kSameLine * probe->size();
  std::vector<ScrewAxis> axes = problem.axes;
  const std::vector<ScrewAxis> own = ListRoundAxes(*problem.part, problem.X_WB_start);
  for (std::size_t i = 0; i < own.size() && axes.size() < 4 + problem.axes.size(); ++i) {
    AddAxis(own[i], near, &axes);
  }
  const Vec3 centre = problem.X_WB_start * probe->centre_B();
  for (const contact::BodyId body : probe->bodies()) {
    std::size_t found = 0;
    for (const ScrewAxis& axis :
         ListRoundAxes(problem.scene->shape(body), problem.scene->pose(body))) {
      if ((centre - axis.p_WQ).cross(axis.axis_W).norm() < probe->reach() && found++ < 2) {
        AddAxis(axis, near, &axes);
      }
    }
  }
  const Mat3 R = FindFrame(*probe);
  for (int i = 0; i < 3; ++i) {
    AddAxis({centre, R.col(i), 0}, near, &axes);
  }
  // Lines along the part's axes through points of contact: it tilts about them.
  for (const contact::Contact& c : ListStartContacts(probe)) {
    for (int i = 0; i < 3; ++i) {
      if (std::abs(R.col(i).dot(c.nhat_W)) < 0.5) {
        AddAxis({c.p_WC, R.col(i), 0}, 10 * near, &axes);
      }
    }
  }
  return axes;
}

}  // namespace hvas::paths
