#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <stop_token>
#include <vector>

#include "base/id.h"
#include "base/result.h"
#include "spatial/box.h"
#include "spatial/surface.h"

namespace hvas::contact {

inline constexpr std::uint32_t kNoFace = std::numeric_limits<std::uint32_t>::max();

/** What a contact shape is made from: a closed triangle mesh, outward, and the surface under each
 face. In the body frame, SI. */
struct ShapeSource {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> triangle_face;  ///< Each triangle's index into faces.
  std::vector<spatial::Surface> faces;
};

struct ShapeOptions {
  double voxel{0};          ///< Edge of a cell of the distance field [m]; 0: chosen from the part.
  double point_spacing{0};  ///< Spacing of samples on freeform faces [m]; 0: chosen.
  unsigned threads{0};      ///< That build one shape; 0: one a core. No matter for the shape.
  std::stop_token stop;     ///< Ends the building when a stop is asked for.
};

// Samples on a part's faces stand a hundredth of its size apart, further where there would be more
// of them than this: it bounds the memory of a shape. Both are choices.
inline constexpr double kSpacingsAcross = 100;
inline constexpr double kMaxFaceSamples = 15000;

/** What a shape takes in memory [bytes]. */
struct ShapeMemory {
  std::size_t field{0};   ///< Blocks of the distance field, their directory, the coarse grid.
  std::size_t tables{0};  ///< Which faces or triangles decide where.
  std::size_t mesh{0};
  std::size_t shell{0};  ///< Points, their faces and the sphere trees.

  [[nodiscard]] std::size_t total() const noexcept { return field + tables + mesh + shell; }

  ShapeMemory& operator+=(const ShapeMemory& other) noexcept {
    field += other.field;
    tables += other.tables;
    mesh += other.mesh;
    shell += other.shell;
    return *this;
  }
};

/** Immutable contact shape: block distance field, point shell in a sphere tree, exact faces. */
class Shape {
 public:
  struct Data;

  /** Builds a shape. Errors: kInvalid for an empty or non-finite mesh; kCancelled. Takes up to
   seconds. */
  static Result<std::shared_ptr<const Shape>> Build(const ShapeSource& source,
                                                    const ShapeOptions& options);

  explicit Shape(std::unique_ptr<const Data> data);
  ~Shape();

  [[nodiscard]] const spatial::Box& box_B() const noexcept;
  [[nodiscard]] double voxel() const noexcept;
  [[nodiscard]] std::size_t point_count() const noexcept;
  [[nodiscard]] ShapeMemory CalcMemory() const noexcept;

  [[nodiscard]] std::size_t memory_bytes() const noexcept { return CalcMemory().total(); }

  [[nodiscard]] const Data& data() const noexcept { return *data_; }

 private:
  std::unique_ptr<const Data> data_;
};

}  // namespace hvas::contact
