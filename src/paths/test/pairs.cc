#include "paths/test/pairs.h"

#include <algorithm>

namespace hvas::paths::testing {
namespace {

constexpr double kMm = 1e-3;

// A grid with planes at all coordinates of boxes in millimetres.
struct BoxMm {
  std::array<double, 6> at;  // x, y, z from and to.
  bool is_full{true};
};

std::shared_ptr<const contact::Shape> MakeBoxes(const std::vector<BoxMm>& boxes) {
  std::array<std::vector<double>, 3> steps;
  for (const BoxMm& box : boxes) {
    for (std::size_t i = 0; i < 6; ++i) {
      steps[i / 2].push_back(kMm * box.at[i]);
    }
  }
  for (auto& s : steps) {
    std::sort(s.begin(), s.end());
    s.erase(std::unique(s.begin(), s.end(), [](double a, double b) { return b - a < 1e-9; }),
            s.end());
  }
  CellSolid solid(std::move(steps));
  for (const BoxMm& box : boxes) {
    solid.Set(kMm * Vec3(box.at[0], box.at[2], box.at[4]),
              kMm * Vec3(box.at[1], box.at[3], box.at[5]), box.is_full);
  }
  return MakeShape(solid.Make());
}

constexpr int kSectors = 96;        // Sectors of a turn.
constexpr int kThreadSectors = 48;  // Of a thread: fewer, as it has many triangles.

// A closed body between an inner and an outer radius on a grid of sectors and heights; steps
// between layers and between sectors are flat. Radius 0 inside: solid.
class PolarMesh {
 public:
  explicit PolarMesh(int sectors = kSectors) : sectors_(sectors) {}

  std::uint32_t Vertex(double radius, int sector, double z) {
    const double angle = 2 * std::numbers::pi * (sector % sectors_) / sectors_;
    source_.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    return static_cast<std::uint32_t>(source_.vertices.size() - 1);
  }

  /** The face of the triangles that follow. */
  void Face(const spatial::Surface& surface) {
    for (face_ = 0; face_ < source_.faces.size(); ++face_) {
      const spatial::Surface& f = source_.faces[face_];
      if (f.kind == surface.kind && (f.origin - surface.origin).norm() < 1e-9 &&
          (f.axis - surface.axis).norm() < 1e-9 && f.radius == surface.radius &&
          f.outward == surface.outward) {
        return;
      }
    }
    source_.faces.push_back(surface);
  }

  void Triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const auto& v = source_.vertices;
    if ((v[a] - v[b]).norm() < 1e-9 || (v[b] - v[c]).norm() < 1e-9 || (v[c] - v[a]).norm() < 1e-9) {
      return;
    }
    source_.triangles.push_back({a, b, c});
    source_.triangle_face.push_back(static_cast<std::uint32_t>(face_));
  }

  void Quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    Triangle(a, b, c);
    Triangle(a, c, d);
  }

  contact::ShapeSource Take() {
    if (source_.faces.empty()) {
      source_.faces.emplace_back();  // Freeform.
    }
    return std::move(source_);
  }

 private:
  int sectors_;
  std::size_t face_{0};
  contact::ShapeSource source_;
};

// A shaft, or a hole in a body with an outside, whose radius is given by sector and layer.
class PolarBody {
 public:
  PolarBody(const std::vector<PolarLayer>& layers, double outside)
      : layers_(layers), outside_(outside), is_hole_(outside > 0) {}

  contact::ShapeSource Make() {
    for (std::size_t n = 0; n < layers_.size(); ++n) {
      for (int s = 0; s < kSectors; ++s) {
        AddWalls(layers_[n], s);
        AddSide(layers_[n], s);
        AddSteps(n, s);
      }
    }
    return mesh_.Take();
  }

 private:
  static double RadiusOf(const PolarLayer& layer, int s) {
    return layer.radius[static_cast<std::size_t>(s % kSectors)];
  }

  void AddQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, bool is_turned) {
    if (is_turned) {
      mesh_.Quad(a, d, c, b);
    } else {
      mesh_.Quad(a, b, c, d);
    }
  }

  void AddWall(const PolarLayer& layer, int s, double radius, double outward) {
    mesh_.Face({spatial::SurfaceKind::kCylinder, Vec3::Zero(), Vec3::UnitZ(), radius, 0, outward});
    const std::uint32_t a = mesh_.Vertex(radius, s, layer.low),
                        b = mesh_.Vertex(radius, s + 1, layer.low),
                        c = mesh_.Vertex(radius, s + 1, layer.high),
                        d = mesh_.Vertex(radius, s, layer.high);
    AddQuad(a, b, c, d, outward < 0);
  }

  void AddWalls(const PolarLayer& layer, int s) {
    AddWall(layer, s, RadiusOf(layer, s), is_hole_ ? -1 : 1);
    if (is_hole_) {
      AddWall(layer, s, outside_, 1);
    }
  }

  // A wall along the axis to the next sector; material on the side of the larger radius of a shaft.
  void AddSide(const PolarLayer& layer, int s) {
    const double r = RadiusOf(layer, s);
    const double next = RadiusOf(layer, s + 1);
    if (r == next) {
      return;
    }
    const double angle = 2 * std::numbers::pi * (s + 1) / kSectors;
    const double towards = ((r > next) == !is_hole_ ? 1 : -1);
    mesh_.Face({spatial::SurfaceKind::kPlane, Vec3::Zero(),
                towards * Vec3(-std::sin(angle), std::cos(angle), 0), 0, 0, 1});
    const double inner = std::min(r, next), outer = std::max(r, next);
    const std::uint32_t a = mesh_.Vertex(inner, s + 1, layer.low),
                        b = mesh_.Vertex(outer, s + 1, layer.low),
                        c = mesh_.Vertex(outer, s + 1, layer.high),
                        d = mesh_.Vertex(inner, s + 1, layer.high);
    AddQuad(a, b, c, d, towards > 0);
  }

  // Flat sectors to the layer below, and above the last one. Material is below r of a shaft, and
  // between r and outside of a hole.
  void AddSteps(std::size_t n, int s) {
    const double r = RadiusOf(layers_[n], s);
    const double below = n > 0 ? RadiusOf(layers_[n - 1], s) : outside_;
    if (below != r) {
      AddStep(s, layers_[n].low, below, r, ((r > below) == !is_hole_) ? -1 : 1);
    }
    if (n + 1 == layers_.size()) {
      AddStep(s, layers_[n].high, r, outside_, 1);
    }
  }

  // A flat sector at z between two radii, facing up or down.
  void AddStep(int s, double z, double from, double to, double up) {
    mesh_.Face({spatial::SurfaceKind::kPlane, Vec3(0, 0, z), Vec3(0, 0, up), 0, 0, 1});
    const double low = std::min(from, to), high = std::max(from, to);
    const std::uint32_t a = mesh_.Vertex(low, s, z), b = mesh_.Vertex(high, s, z),
                        c = mesh_.Vertex(high, s + 1, z), d = mesh_.Vertex(low, s + 1, z);
    AddQuad(a, b, c, d, up < 0);
  }

  const std::vector<PolarLayer>& layers_;
  double outside_;
  bool is_hole_;
  PolarMesh mesh_;
};

}  // namespace

std::shared_ptr<const contact::Shape> MakeShape(const contact::ShapeSource& source, double voxel) {
  contact::ShapeOptions options;
  options.voxel = voxel;
  return contact::Shape::Build(source, options).value();
}

contact::ShapeSource MakeThread(double minor, double major, double pitch, double low, double high,
                                double outside) {
  // Rows of points along z; a triangular thread, its crest where sector and height agree.
  PolarMesh mesh(kThreadSectors);
  const int rows = static_cast<int>(std::lround((high - low) / pitch * 12));
  const auto radius = [&](int sector, double z) {
    double phase = z / pitch - static_cast<double>(sector) / kThreadSectors;
    phase -= std::floor(phase);
    return minor + (major - minor) * (1 - std::abs(2 * phase - 1));
  };
  const auto height = [&](int row) { return low + (high - low) * row / rows; };
  const bool is_hole = outside > 0;
  std::vector<std::vector<std::uint32_t>> grid(static_cast<std::size_t>(rows) + 1);
  for (int row = 0; row <= rows; ++row) {
    for (int s = 0; s < kThreadSectors; ++s) {
      grid[static_cast<std::size_t>(row)].push_back(
          mesh.Vertex(radius(s, height(row)), s, height(row)));
    }
  }
  const auto at = [&](int row, int s) {
    return grid[static_cast<std::size_t>(row)][static_cast<std::size_t>(s % kThreadSectors)];
  };
  for (int row = 0; row < rows; ++row) {
    for (int s = 0; s < kThreadSectors; ++s) {
      if (is_hole) {
        mesh.Quad(at(row, s), at(row + 1, s), at(row + 1, s + 1), at(row, s + 1));
      } else {
        mesh.Quad(at(row, s), at(row, s + 1), at(row + 1, s + 1), at(row + 1, s));
      }
    }
  }
  std::array<std::vector<std::uint32_t>, 2> rim;
  for (std::size_t end = 0; end < 2; ++end) {
    for (int s = 0; s < kThreadSectors; ++s) {
      rim[end].push_back(is_hole ? mesh.Vertex(outside, s, end == 0 ? low : high) : 0);
    }
  }
  const std::uint32_t bottom = mesh.Vertex(0, 0, low), top = mesh.Vertex(0, 0, high);
  for (int s = 0; s < kThreadSectors; ++s) {
    const auto i = static_cast<std::size_t>(s),
               k = static_cast<std::size_t>((s + 1) % kThreadSectors);
    if (is_hole) {
      mesh.Quad(at(0, s), at(0, s + 1), rim[0][k], rim[0][i]);
      mesh.Quad(at(rows, s), rim[1][i], rim[1][k], at(rows, s + 1));
      mesh.Quad(rim[0][i], rim[0][k], rim[1][k], rim[1][i]);
    } else {
      mesh.Triangle(bottom, at(0, s + 1), at(0, s));
      mesh.Triangle(top, at(rows, s), at(rows, s + 1));
    }
  }
  return mesh.Take();
}

contact::ShapeSource MakePolar(const std::vector<PolarLayer>& layers, double outside) {
  return PolarBody(layers, outside).Make();
}

Pair MakeHook(double gap) {
  // The short leg of an L points down into a pocket under an overhang: out, up and away.
  const double g = gap / kMm;
  Pair pair;
  pair.name = "hook around a corner";
  pair.part = MakeBoxes({{{-5, 5, 0, 30, 0, 6}}, {{-5, 5, 0, 6, -12, 0}}});
  pair.around = MakeBoxes({{{-12, 12, -14, 44, -20, 12}},
                           {{-5 - g, 5 + g, -g, 44, -g, 6 + g}, false},  // Long leg, open at +y.
                           {{-5 - g, 5 + g, -g, 10, -12 - g, 6 + g}, false},  // Short leg's pocket.
                           {{-5 - g, 5 + g, 8, 44, -12 - g, 6 + g}, false},
                           {{-12, 12, 36, 44, -20, -2}, true},  // A sill at the end.
                           {{-5 - g, 5 + g, 20, 44, -g, 12}, false}});
  return pair;
}

Pair MakeZigZag(double gap) {
  // A bar in a channel that goes along x, then y, then x.
  const double g = gap / kMm;
  Pair pair;
  pair.name = "block in a stepped channel";
  pair.part = MakeBoxes({{{-5, 5, -5, 5, -4, 4}}, {{-9, 9, -2, 2, -4, 4}}});
  pair.around = MakeBoxes({{{-16, 60, -16, 46, -10, 10}},
                           {{-9 - g, 24 + g, -5 - g, 5 + g, -4 - g, 4 + g}, false},
                           {{6 - g, 24 + g, -5 - g, 35 + g, -4 - g, 4 + g}, false},
                           {{6 - g, 60, 25 - g, 35 + g, -4 - g, 4 + g}, false}});
  return pair;
}

Pair MakeBayonet(double gap) {
  // Two lugs of 30 degrees under a flange with two slots a quarter turn away.
  const double g = gap;
  const int lug = kSectors / 12;
  const auto sector = [&](double base, double large, int from, int width) {
    std::vector<double> r(kSectors, base);
    for (int turn = 0; turn < 2; ++turn) {
      for (int k = 0; k < width; ++k) {
        r[static_cast<std::size_t>((from + turn * kSectors / 2 + k) % kSectors)] = large;
      }
    }
    return r;
  };
  Pair pair;
  pair.name = "bayonet";
  pair.part = MakeShape(MakePolar({{0, 4 * kMm, sector(8 * kMm, 11 * kMm, 0, lug)},
                                   {4 * kMm, 30 * kMm, std::vector<double>(kSectors, 8 * kMm)}},
                                  0));
  const int wider = 1;  // Sectors: the slot is wider than the lug by two of 3.75 degrees.
  pair.around = MakeShape(
      MakePolar({{-4 * kMm, -g, std::vector<double>(kSectors, 3 * kMm)},  // Floor, with a hole.
                 {-g, 4 * kMm + g, std::vector<double>(kSectors, 11 * kMm + g)},
                 {4 * kMm + g, 12 * kMm,
                  sector(8 * kMm + g, 11 * kMm + g, kSectors / 4 - wider, lug + 2 * wider)}},
                18 * kMm));
  return pair;
}

Pair MakeKeyhole(double gap) {
  // A flat key behind a plate whose slot lies across it: it turns a quarter, then goes out.
  const double g = gap / kMm;
  Pair pair;
  pair.name = "key in a keyhole";
  pair.part = MakeBoxes({{{-10, 10, -2, 2, 0, 4}}, {{-2, 2, -2, 2, 0, 30}}});
  pair.around =
      MakeBoxes({{{-18, 18, -18, 18, -6, 12}},
                 {{-12, 12, -12, 12, -2, 6}, false},                      // Chamber.
                 {{-2.9 - g, 2.9 + g, -2.9 - g, 2.9 + g, 5, 12}, false},  // Round for the shank.
                 {{-2 - g, 2 + g, -10 - g, 10 + g, 5, 12}, false}});      // Slot.
  return pair;
}

Pair MakeLippedWindow(double gap) {
  // A plate longer than the opening that it lies behind: it tilts out end first.
  const double g = gap / kMm;
  Pair pair;
  pair.name = "plate behind a lip";
  pair.part = MakeBoxes({{{-20, 20, -8, 8, 0, 3}}});
  pair.around = MakeBoxes({{{-36, 30, -14, 14, -14, 10}},
                           {{-20 - g, 20 + g, -8 - g, 8 + g, -g, 10}, false},
                           {{-32, 20 + g, -8 - g, 8 + g, -10, 3 + g}, false},
                           {{-32, -13, -8 - g, 8 + g, 3 + 2 * g, 10}, true}});
  return pair;
}

Pair MakeRailHook(double gap) {
  // A hook round three sides and a half of a square rail: it slides along it past an end stop only
  // by going the other way.
  const double g = gap / kMm;
  Pair pair;
  pair.name = "hook on a rail";
  pair.part = MakeBoxes({{{-6, 6, -8, 8, -8, 8}},
                         {{-6, 6, -4 - g, 4 + g, -4 - g, 4 + g}, false},
                         {{-6, 6, 0, 8, -2, 2}, false}});
  pair.around = MakeBoxes({{{-50, 20, -4, 4, -4, 4}},
                           {{-50, -40, -20, 20, -20, 20}},
                           {{-50, 30, -20, 20, -20, -12}},
                           {{20, 30, -20, 20, -20, 20}},
                           {{10, 20, -1.5, 20, -1.5, 1.5}},
                           {{-40, 20, 4, 20, -1.5, 1.5}, false},
                           {{20, 30, -9, 9, -9, 9}, false},
                           {{10, 20, -4, 4, -4, 4}, true},
                           {{20, 30, -4, 4, -4, 4}, false}});
  return pair;
}

Pair MakeCornerRod(double gap) {
  // A bent rod whose ends are in the holes of two walls at right angles: it turns out of the one
  // while it leaves the other.
  const double g = gap / kMm;
  Pair pair;
  pair.name = "bent rod in two walls";
  pair.part = MakeBoxes({{{0, 26, 0, 5, 0, 5}}, {{0, 5, 0, 26, 0, 5}}});
  pair.around = MakeBoxes({{{20, 24, -12, 34, -8, 13}},
                           {{-12, 24, 20, 24, -8, 13}},
                           {{20, 24, -g, 5 + 6 + g, -g, 5 + g}, false},
                           {{-6 - g, 5 + g, 20, 24, -g, 5 + g}, false}});
  return pair;
}

Pair MakeNut(double gap) {
  constexpr double kMinor = 6.2e-3, kMajor = 8e-3, kPitch = 2e-3;
  Pair pair;
  pair.name = "nut on a thread";
  pair.tolerance = 50e-6;
  pair.part = MakeShape(MakeThread(kMinor + gap, kMajor + gap, kPitch, 2e-3, 5e-3, 12e-3), 0.15e-3);
  pair.around = MakeShape(MakeThread(kMinor, kMajor, kPitch, 0, 7e-3, 0), 0.15e-3);
  return pair;
}

Pair MakeCaptive(double gap) {
  const double g = gap / kMm;
  Pair pair;
  pair.name = "captive block";
  pair.part = MakeBoxes({{{-5, 5, -5, 5, -5, 5}}});
  pair.around = MakeBoxes({{{-16, 16, -16, 16, -16, 16}},
                           {{-5 - g, 9, -5 - g, 5 + g, -5 - g, 5 + g}, false},
                           {{-3, 3, -3, 3, 0, 16}, false}});
  return pair;
}

}  // namespace hvas::paths::testing
