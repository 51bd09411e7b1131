#include "contact/face_offsets.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <fmt/format.h>

#include "contact/refine.h"
#include "contact/shape_data.h"

namespace hvas::contact {
namespace {

// Of the squared sine between a plane's normal and the span of those before it: 14 degrees. Below,
// faces are taken to run into each other, and their edge would move out of all proportion.
constexpr double kLeastSine2 = 0.06;

Error Invalid(std::size_t face, std::string what, std::string remedy) {
  return {ErrorCode::kInvalid, std::move(what), fmt::format("offset of face {}", face),
          std::move(remedy)};
}

bool HasAxis(spatial::SurfaceKind kind) {
  return kind == spatial::SurfaceKind::kCylinder || kind == spatial::SurfaceKind::kCone ||
         kind == spatial::SurfaceKind::kSphere || kind == spatial::SurfaceKind::kTorus;
}

Result<void> Check(std::size_t f, const FaceOffset& offset, spatial::SurfaceKind kind) {
  const auto is_good = [](double v) { return std::abs(v) <= FaceOffsets::kLargest; };
  if (!is_good(offset.uniform) ||
      !std::all_of(offset.stations.begin(), offset.stations.end(),
                   [&](double v) { return is_good(offset.uniform + v); })) {
    return Unexpected(Invalid(f, "The offset is not a number or larger than 0.25 mm.",
                              "Change the drawn size towards the actual size."));
  }
  if (offset.stations.empty()) {
    return {};
  }
  if (offset.stations.size() < 2 || !(offset.end > offset.begin) || !std::isfinite(offset.begin) ||
      !std::isfinite(offset.end)) {
    return Unexpected(Invalid(f, "A profile needs at least two stations and a length.",
                              "Give a uniform offset, or stations over a length."));
  }
  if (!HasAxis(kind)) {
    return Unexpected(
        Invalid(f, "A profile needs a face of revolution.", "Give a uniform offset."));
  }
  return {};
}

}  // namespace

Shift SolveShift(std::span<const Vec3> normals, std::span<const double> offsets) noexcept {
  // Gram-Schmidt: each new plane adds what is still missing along its own part of its normal.
  Shift result;
  std::array<Vec3, 3> basis;
  std::size_t count = 0;
  for (std::size_t i = 0; i < normals.size() && count < basis.size(); ++i) {
    Vec3 own = normals[i];
    for (std::size_t k = 0; k < count; ++k) {
      own -= own.dot(basis[k]) * basis[k];
    }
    const double squared = own.squaredNorm();
    if (squared < kLeastSine2) {
      continue;
    }
    result.s += (offsets[i] - normals[i].dot(result.s)) / squared * own;
    result.used |= 1U << i;
    basis[count++] = own / std::sqrt(squared);
  }
  return result;
}

Result<std::shared_ptr<const FaceOffsets>> FaceOffsets::Make(std::shared_ptr<const Shape> shape,
                                                             std::span<const FaceOffset> offsets) {
  const auto& surfaces = shape->data().exact.faces;
  if (offsets.size() > surfaces.size()) {
    return Unexpected(Invalid(surfaces.size(), "The shape has no such face.",
                              "Give at most as many offsets as the part has faces."));
  }
  static std::atomic<std::uint64_t> last_serial{0};
  std::shared_ptr<FaceOffsets> made(new FaceOffsets());
  made->serial_ = ++last_serial;
  made->faces_.resize(surfaces.size());
  double outermost = 0;
  for (std::size_t f = 0; f < offsets.size(); ++f) {
    const FaceOffset& offset = offsets[f];
    if (const auto good = Check(f, offset, surfaces[f].kind); !good) {
      return Unexpected(good.error());
    }
    Face& face = made->faces_[f];
    face.uniform = offset.uniform;
    face.begin = offset.begin;
    face.first = static_cast<std::uint32_t>(made->stations_.size());
    face.count = static_cast<std::uint32_t>(offset.stations.size());
    double low = 0;
    double high = 0;
    if (face.count > 0) {
      face.per_height = (face.count - 1) / (offset.end - offset.begin);
      const auto [least, most] =
          std::minmax_element(offset.stations.begin(), offset.stations.end());
      low = *least;
      high = *most;
    }
    made->stations_.insert(made->stations_.end(), offset.stations.begin(), offset.stations.end());
    made->largest_ =
        std::max({made->largest_, std::abs(offset.uniform + low), std::abs(offset.uniform + high)});
    outermost = std::max(outermost, offset.uniform + high);
  }
  made->shape_ = std::move(shape);
  made->Place(made->shape_->data().shell, &made->shell_);
  made->Place(made->shape_->data().features, &made->features_);
  made->growth_ = outermost > 0 ? made->largest_ : 0;
  return std::shared_ptr<const FaceOffsets>(std::move(made));
}

void FaceOffsets::Place(const Shell& shell, std::vector<std::array<float, 3>>* shifts) {
  const Shape::Data& shape = shape_->data();
  shifts->resize(shell.faces.size());
  for (std::size_t i = 0; i < shell.faces.size(); ++i) {
    const SampleFaces& sample = shell.faces[i];
    const Vec3 p(static_cast<double>(shell.x[i]), static_cast<double>(shell.y[i]),
                 static_cast<double>(shell.z[i]));
    std::array<Vec3, kMaxPointFaces> normals;
    std::array<double, kMaxPointFaces> offsets{};
    std::size_t count = 0;
    for (; count < kMaxPointFaces && sample.faces[count] != kNoFace; ++count) {
      normals[count] = sample.normal(count);
      offsets[count] = At(sample.faces[count], p).offset;
    }
    const bool is_alone =
        count == 1 && shape.exact.faces[sample.faces[0]].kind != spatial::SurfaceKind::kFreeform;
    const Vec3 s = is_alone ? CalcShift(shape, *this, p)
                            : SolveShift({normals.data(), count}, {offsets.data(), count}).s;
    (*shifts)[i] = {static_cast<float>(s.x()), static_cast<float>(s.y()),
                    static_cast<float>(s.z())};
    largest_ = std::max(largest_, s.norm());
  }
}

FaceOffsets::Value FaceOffsets::At(std::uint32_t face, const Vec3& p) const noexcept {
  const Face& f = faces_[face];
  Value value{f.uniform, 0};
  if (f.count == 0) {
    return value;
  }
  const spatial::Surface& surface = shape_->data().exact.faces[face];
  const double u = ((p - surface.origin).dot(surface.axis) - f.begin) * f.per_height;
  const double* station = stations_.data() + f.first;
  if (!(u > 0)) {
    value.offset += station[0];
  } else if (u >= f.count - 1) {
    value.offset += station[f.count - 1];
  } else {
    const auto i = static_cast<std::uint32_t>(u);
    const double rise = station[i + 1] - station[i];
    value.offset += station[i] + (u - i) * rise;
    value.slope = rise * f.per_height;
  }
  return value;
}

spatial::SurfaceDistance FaceOffsets::CalcDistance(std::uint32_t face,
                                                   const Vec3& p) const noexcept {
  const ExactTable& exact = shape_->data().exact;
  auto result = CalcFaceDistance(exact, face, p);
  const Value value = At(face, p);
  result.distance -= value.offset;
  result.gradient -= value.slope * exact.faces[face].axis;
  return result;
}

Vec3 FaceOffsets::ShiftOf(const Shell& shell, std::uint32_t i) const noexcept {
  const auto& s = (&shell == &shape_->data().features ? features_ : shell_)[i];
  return {static_cast<double>(s[0]), static_cast<double>(s[1]), static_cast<double>(s[2])};
}

}  // namespace hvas::contact
