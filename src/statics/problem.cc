#include "statics/problem.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <string>
#include <tuple>

namespace hvas::statics {
namespace {

// How far a length of a unit vector may be from 1: rounding of what callers make. A choice.
constexpr double kUnitError = 1e-6;
// Sine of the angle between gravity and a normal from which on gravity has a direction across it.
constexpr double kLeastSlope = 1e-9;
// Contacts with normals this close, and this share of their extent off one plane, are in one plane:
// what they are off is less than what the programme tolerates. A choice.
constexpr double kOnePlane = 1e-7;

/** Two unit vectors that complete a normal to a right-handed frame. */
std::pair<Vec3, Vec3> MakeTangents(const Vec3& nhat_W, const Vec3& along_W) {
  Vec3 first = along_W - along_W.dot(nhat_W) * nhat_W;
  if (first.norm() <= kLeastSlope * along_W.norm()) {
    Eigen::Index axis = 0;
    nhat_W.cwiseAbs().minCoeff(&axis);
    const Vec3 unit = Vec3::Unit(axis);
    first = unit - unit.dot(nhat_W) * nhat_W;
  }
  first.normalize();
  return {first, nhat_W.cross(first)};
}

bool IsUnit(const Vec3& v) {
  return v.allFinite() && std::abs(v.norm() - 1) < kUnitError;
}

/** Contacts of one pair in one plane. */
struct Plane {
  Vec3 nhat_W;
  double offset;  // Along the normal [m].
  std::vector<int> contacts;
};

/** Appends the corners of the convex hull of contacts in one plane (Andrew's monotone chain,
 Information Processing Letters 9(5), 1979). */
void AppendCorners(const std::vector<StaticContact>& contacts, const Plane& plane,
                   std::vector<int>* corners) {
  if (plane.contacts.size() < 3) {
    corners->insert(corners->end(), plane.contacts.begin(), plane.contacts.end());
    return;
  }
  const auto [u, v] = MakeTangents(plane.nhat_W, Vec3::UnitX());

  struct Point {
    double x, y;
    int contact;
  };

  std::vector<Point> points;
  const Vec3& origin = contacts[static_cast<std::size_t>(plane.contacts.front())].p_W;
  for (const int i : plane.contacts) {
    const Vec3 p = contacts[static_cast<std::size_t>(i)].p_W - origin;
    points.push_back({p.dot(u), p.dot(v), i});
  }
  std::sort(points.begin(), points.end(), [](const Point& p, const Point& q) {
    return std::tie(p.x, p.y, p.contact) < std::tie(q.x, q.y, q.contact);
  });
  std::vector<Point> hull;
  const auto chain = [&hull](auto first, auto last) {
    const std::size_t begin = hull.size();
    for (auto point = first; point != last; ++point) {
      while (hull.size() >= begin + 2) {
        const Point& p = hull[hull.size() - 2];
        const Point& q = hull.back();
        if ((q.x - p.x) * (point->y - p.y) - (q.y - p.y) * (point->x - p.x) > 0) {
          break;
        }
        hull.pop_back();
      }
      hull.push_back(*point);
    }
    hull.pop_back();  // The other chain begins with it.
  };
  chain(points.begin(), points.end());
  chain(points.rbegin(), points.rend());
  for (const Point& point : hull) {
    corners->push_back(point.contact);
  }
}

Result<void> CheckPair(const StaticProblem& problem, int a, int b, const std::string& where) {
  const int count = static_cast<int>(problem.bodies.size());
  if (a < 0 || a >= count || b < kGround || b >= count || a == b) {
    return Fail(ErrorCode::kInvalid, "the two bodies are not two of those there are", where);
  }
  return {};
}

}  // namespace

std::vector<Vec3> ListPyramidEdges(const StaticContact& contact, const Vec3& g_W) {
  if (contact.friction == 0) {
    return {contact.nhat_W};
  }
  const auto [first, second] = MakeTangents(contact.nhat_W, g_W);
  std::vector<Vec3> edges;
  for (int side = 0; side < kPyramidSides; ++side) {
    const double angle = 2 * std::numbers::pi * side / kPyramidSides;
    edges.push_back(contact.nhat_W +
                    contact.friction * (std::cos(angle) * first + std::sin(angle) * second));
  }
  return edges;
}

Result<void> CheckProblem(const StaticProblem& problem) {
  if (!problem.g_W.allFinite() || problem.g_W.norm() == 0) {
    return Fail(ErrorCode::kInvalid, "gravity has no direction");
  }
  for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
    const StaticBody& body = problem.bodies[i];
    if (!std::isfinite(body.mass) || body.mass <= 0 || !body.p_WC.allFinite()) {
      return Fail(ErrorCode::kInvalid, "mass or centre of mass is not a number above zero",
                  "body " + std::to_string(i));
    }
  }
  for (std::size_t i = 0; i < problem.contacts.size(); ++i) {
    const StaticContact& contact = problem.contacts[i];
    const std::string where = "contact " + std::to_string(i);
    if (auto pair = CheckPair(problem, contact.a, contact.b, where); !pair) {
      return pair;
    }
    if (!contact.p_W.allFinite() || !IsUnit(contact.nhat_W) || !std::isfinite(contact.friction) ||
        contact.friction < 0) {
      return Fail(ErrorCode::kInvalid, "point, normal or friction is out of its range", where);
    }
  }
  for (std::size_t i = 0; i < problem.joints.size(); ++i) {
    const StaticJoint& joint = problem.joints[i];
    const std::string where = "joint " + std::to_string(i);
    if (auto pair = CheckPair(problem, joint.a, joint.b, where); !pair) {
      return pair;
    }
    if (!joint.p_W.allFinite() || !IsUnit(joint.axis_W) || !(joint.pull_out >= 0) ||
        !(joint.torque >= 0)) {
      return Fail(ErrorCode::kInvalid, "point, axis or limit is out of its range", where);
    }
  }
  return {};
}

std::vector<int> ListSpanningContacts(const std::vector<StaticContact>& contacts) {
  std::map<std::tuple<int, int, double>, std::vector<int>> pairs;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const StaticContact& contact = contacts[i];
    pairs[{contact.a, contact.b, contact.friction}].push_back(static_cast<int>(i));
  }
  std::vector<int> spanning;
  for (const auto& [pair, members] : pairs) {
    const Vec3& origin = contacts[static_cast<std::size_t>(members.front())].p_W;
    double extent = 0;
    for (const int i : members) {
      extent = std::max(extent, (contacts[static_cast<std::size_t>(i)].p_W - origin).norm());
    }
    std::vector<Plane> planes;
    for (const int i : members) {
      const StaticContact& contact = contacts[static_cast<std::size_t>(i)];
      const auto plane = std::find_if(planes.begin(), planes.end(), [&](const Plane& known) {
        return (known.nhat_W - contact.nhat_W).norm() < kOnePlane &&
               std::abs(known.nhat_W.dot(contact.p_W - origin) - known.offset) <=
                   kOnePlane * extent;
      });
      if (plane != planes.end()) {
        plane->contacts.push_back(i);
      } else {
        planes.push_back({contact.nhat_W, contact.nhat_W.dot(contact.p_W - origin), {i}});
      }
    }
    for (const Plane& plane : planes) {
      AppendCorners(contacts, plane, &spanning);
    }
  }
  std::sort(spanning.begin(), spanning.end());
  return spanning;
}

}  // namespace hvas::statics
