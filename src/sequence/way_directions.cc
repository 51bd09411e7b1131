#include "sequence/way_directions.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace hvas::sequence {

void AddDirection(const Vec3& d, std::vector<Vec3>* directions) {
  if (std::none_of(directions->begin(), directions->end(),
                   [&](const Vec3& known) { return known.dot(d) > 1 - kParallel * kParallel; })) {
    directions->push_back(d);
  }
}

void AddEdges(const std::vector<Vec3>& normals, std::vector<Vec3>* directions) {
  constexpr std::size_t kMost = 8;  // Normals: those of a prism and its ends. A choice.
  const std::size_t count = std::min(kMost, normals.size());
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = i + 1; k < count; ++k) {
      const Vec3 edge = normals[i].cross(normals[k]);
      if (edge.norm() > kParallel) {
        AddDirection(edge.normalized(), directions);
        AddDirection(-edge.normalized(), directions);
      }
    }
  }
}

std::vector<Vec3> ListPlaneLines(const product::Part& part) {
  constexpr std::size_t kMost = 3;             // Lines: those of a box. A choice.
  std::vector<std::pair<double, Vec3>> lines;  // Area [m^2] and direction.
  for (const product::Feature& feature : part.features) {
    if (feature.kind != product::FeatureKind::kPlane) {
      continue;
    }
    const auto known = std::find_if(lines.begin(), lines.end(), [&](const auto& line) {
      return std::abs(line.second.dot(feature.axis_B)) > 1 - kParallel * kParallel;
    });
    if (known != lines.end()) {
      known->first += feature.area;
    } else {
      lines.emplace_back(feature.area, feature.axis_B);
    }
  }
  std::stable_sort(lines.begin(), lines.end(),
                   [](const auto& x, const auto& y) { return x.first > y.first; });
  std::vector<Vec3> directions;
  for (std::size_t i = 0; i < std::min(kMost, lines.size()); ++i) {
    directions.push_back(lines[i].second);
  }
  return directions;
}

std::vector<Vec3> ListFreeDirections(const std::vector<Vec3>& normals) {
  constexpr std::size_t kMost = 24;  // Directions: a choice.
  constexpr double kLeast = 0.05;  // Sine of the angle between normals that have an edge: a choice.
  std::vector<Vec3> directions;
  const auto add = [&](const Vec3& d) {
    const double length = d.norm();
    const bool is_free =
        length > kLeast && std::all_of(normals.begin(), normals.end(), [&](const Vec3& n) {
          return n.dot(d) >= -kParallel * length;
        });
    if (is_free && directions.size() < kMost) {
      AddDirection(d / length, &directions);
    }
  };
  Vec3 sum = Vec3::Zero();
  for (const Vec3& n : normals) {
    sum += n;
  }
  add(sum);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    add(normals[i]);
    for (std::size_t k = i + 1; k < normals.size(); ++k) {
      add(normals[i] + normals[k]);
      add(normals[i].cross(normals[k]));
      add(normals[k].cross(normals[i]));
    }
  }
  SortUpwardFirst(&directions);
  return directions;
}

void SortUpwardFirst(std::vector<Vec3>* directions) {
  std::stable_sort(directions->begin(), directions->end(),
                   [](const Vec3& x, const Vec3& y) { return x.z() > y.z() + 1e-9; });
}

}  // namespace hvas::sequence
