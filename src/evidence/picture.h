#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "product/product.h"

namespace hvas::evidence {

/** The direction to the eye from the front right above. */
[[nodiscard]] Vec3 UsualView();

/** Where the world is in a picture: parallel. */
class Projection {
 public:
  /** Fits a box into so many pixels. @param to_eye_W  Direction to the eye, not vertical. */
  Projection(const spatial::Box& box_W, int width, int height, const Vec3& to_eye_W = UsualView());

  /** Pixels from the upper left, and depth away from the eye [m]. */
  [[nodiscard]] Vec3 Project(const Vec3& p_WQ) const {
    const Vec3 p = R_VW_ * (p_WQ - centre_W_);
    return {0.5 * width_ + scale_ * p.x(), 0.5 * height_ - scale_ * p.y(), -p.z()};
  }

  [[nodiscard]] Vec3 Turn(const Vec3& v_W) const { return R_VW_ * v_W; }

  [[nodiscard]] int width() const { return width_; }

  [[nodiscard]] int height() const { return height_; }

 private:
  Mat3 R_VW_;
  Vec3 centre_W_;
  double scale_{1};
  int width_;
  int height_;
};

/** Marks of several groups are rated apart. */
inline constexpr std::size_t kMarkGroups = 2;

/** A part somewhere in a picture. */
struct PictureBody {
  const product::Part* part{nullptr};
  spatial::Pose X_WB;
  std::optional<product::Color> color;      ///< None: those of the part and its faces.
  std::vector<std::uint32_t> marked_faces;  ///< Sorted. Red, also through what hides them.
  std::size_t mark_group{0};                ///< Its marks count in this group; below kMarkGroups.
  /** Where a point of the part goes, in B; null: it is as drawn. */
  std::function<Vec3(const Vec3& p_B)> deform{};
};

/** The box in W around the boxes of bodies. */
[[nodiscard]] spatial::Box BoxAround(const std::vector<PictureBody>& bodies);

/** Parts, shaded, with edges, before nothing, as a PNG file: smooth at the edges, the same bytes
 every time. */
[[nodiscard]] std::string MakePicture(const std::vector<PictureBody>& bodies,
                                      const Projection& projection);

/** Draws the same picture as numbers: red, green, blue and opacity of each pixel, row by row from
 above. */
[[nodiscard]] std::vector<std::uint8_t> DrawPixels(const std::vector<PictureBody>& bodies,
                                                   const Projection& projection);

/** Rates each group of marks: the share of the marked faces in the projection that nothing hides,
 times the share of the picture that they fill. */
[[nodiscard]] std::array<double, kMarkGroups> RateMarks(const std::vector<PictureBody>& bodies,
                                                        const Projection& projection);

/** A product as drawn, as MakePicture() of its parts. */
[[nodiscard]] std::string MakePicture(const product::Product& product,
                                      const Projection& projection);

}  // namespace hvas::evidence
