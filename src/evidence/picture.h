#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "product/product.h"

namespace hvas::evidence {

/** Where the world is in a picture: parallel, from the front right above. */
class Projection {
 public:
  /** Fits a box into so many pixels. */
  Projection(const spatial::Box& box_W, int width, int height);

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

/** A product as drawn, shaded, with edges, before nothing, as a PNG file: smooth at the edges, the
 same bytes every time. */
[[nodiscard]] std::string MakePicture(const product::Product& product,
                                      const Projection& projection);

}  // namespace hvas::evidence
