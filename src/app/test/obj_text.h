#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/ranges.h>

namespace hvas::app::testing {

/** Text of an OBJ file of turned bodies about z [mm]. */
class ObjText {
 public:
  ObjText(int segments, int decimals) : segments_(segments), decimals_(decimals) {}

  void AddObject(const std::string& name) { text_ += "o " + name + "\n"; }

  /** @param turn  In segments. */
  std::vector<int> AddCircle(double radius_mm, double z_mm, double turn) {
    std::vector<int> ring;
    for (int i = 0; i < segments_; ++i) {
      const double angle = 2 * std::numbers::pi * (i + turn) / segments_;
      ring.push_back(AddVertex(radius_mm * std::cos(angle), radius_mm * std::sin(angle), z_mm));
    }
    return ring;
  }

  /** A body between these circles, from the one below to the one above, each with a radius and a
   height [mm]; closed by the first and the last of them. @param turn  In segments. */
  void AddTurned(const std::vector<std::array<double, 2>>& circles_mm, double turn) {
    std::vector<std::vector<int>> rings;
    rings.reserve(circles_mm.size());
    for (const auto& [radius_mm, z_mm] : circles_mm) {
      rings.push_back(AddCircle(radius_mm, z_mm, turn));
    }
    AddCap(rings.front(), false);
    for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
      AddBand(rings[i], rings[i + 1]);
    }
    AddCap(rings.back(), true);
  }

  /** The outline of a square, with a point for each one of a circle in it. */
  std::vector<int> AddSquare(double half_mm, double z_mm) {
    std::vector<int> ring;
    for (int i = 0; i < segments_; ++i) {
      const double angle = 2 * std::numbers::pi * i / segments_;
      const double scale = half_mm / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
      ring.push_back(AddVertex(scale * std::cos(angle), scale * std::sin(angle), z_mm));
    }
    return ring;
  }

  void AddBand(const std::vector<int>& a, const std::vector<int>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      const std::size_t next = (i + 1) % a.size();
      text_ += fmt::format("f {} {} {} {}\n", a[i], a[next], b[next], b[i]);
    }
  }

  void AddCap(std::vector<int> ring, bool is_up) {
    if (!is_up) {
      std::reverse(ring.begin(), ring.end());
    }
    text_ += fmt::format("f {}\n", fmt::join(ring, " "));
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  int AddVertex(double x_mm, double y_mm, double z_mm) {
    text_ += fmt::format("v {1:.{0}f} {2:.{0}f} {3:.{0}f}\n", decimals_, x_mm, y_mm, z_mm);
    return ++vertices_;
  }

  int segments_;
  int decimals_;
  int vertices_{0};
  std::string text_;
};

}  // namespace hvas::app::testing
