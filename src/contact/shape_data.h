#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "contact/helix.h"
#include "contact/kernel.h"
#include "contact/list_faces.h"
#include "contact/mesh.h"
#include "contact/shape.h"

namespace hvas::contact {

/** Equal blocks, as along a straight edge or a shaft, are one block. */
struct Field {
  FieldView view;  ///< Points into the vectors below.
  std::vector<std::int32_t> top;
  std::vector<std::int16_t> nodes;
  std::vector<float> slack;
  std::vector<float> coarse;

  void Bind() {
    view.top = top.data();
    view.nodes = nodes.data();
    view.slack = slack.data();
    view.coarse = coarse.data();
  }
};

inline constexpr int kZonesPerBlock = 64;  // Zones of 2 x 2 x 2 cells.

/** A triangle that may be the closest one in a zone, with a lower bound of its distance from the
 zone's centre. */
struct ListedTriangle {
  std::uint32_t triangle;
  double distance;
};

struct ExactTable {
  std::vector<spatial::Surface> faces;    ///< Centred frame.
  std::vector<double> deviation;          ///< Largest distance of a face's mesh from its surface.
  std::vector<std::uint32_t> zones;       ///< kZonesPerBlock a block; equal lists are one list.
  std::vector<std::uint32_t> list_begin;  ///< Into listed; one more than there are lists.
  /** Each list by faces, those of a face by increasing distance: the triangle above `distance_bits`
   bits that count `distance_unit` [m]. */
  std::vector<std::uint32_t> listed;
  std::uint32_t distance_bits{0};
  double distance_unit{0};
  std::vector<ListFaces> list_faces;  ///< Each list's faces; Complete fills them and the next.
  std::vector<FaceForm> forms;        ///< Each face's form.
  double most_deviation{0};           ///< The largest of analytic faces [m]; Complete finds it.

  [[nodiscard]] bool IsFreeform(std::uint32_t face) const noexcept {
    return faces[face].kind == spatial::SurfaceKind::kFreeform;
  }

  [[nodiscard]] ListedTriangle Listed(std::size_t i) const noexcept {
    const std::uint32_t entry = listed[i];
    return {entry >> distance_bits, (entry & ((1U << distance_bits) - 1U)) * distance_unit};
  }
};

/** Distance from a face's unbounded surface, as drawn. RT-safe. */
[[nodiscard]] inline spatial::SurfaceDistance CalcFaceDistance(const ExactTable& exact,
                                                               std::uint32_t face,
                                                               const Vec3& p) noexcept {
  const spatial::Surface& surface = exact.faces[face];
  const bool is_prepared = face < exact.forms.size();
  return surface.kind == spatial::SurfaceKind::kCone && is_prepared
             ? spatial::CalcConeDistance(surface, exact.forms[face].cosine, exact.forms[face].sine,
                                         p)
             : spatial::CalcDistance(surface, p);
}

/** kNone where single precision would not be good enough. */
[[nodiscard]] FaceForm MakeFaceForm(const spatial::Surface& surface);

inline constexpr std::size_t kMaxPointFaces = 4;  // A corner has three; one more is kept.

/** The faces that meet at a sample and their normals (unit to 1e-4). Unused: kNoFace and zero. */
struct SampleFaces {
  std::array<std::uint32_t, kMaxPointFaces> faces;
  /** Out of the material, in units of kNormalUnit. */
  std::array<std::array<std::int16_t, 3>, kMaxPointFaces> normals;

  static constexpr double kNormalUnit = 1.0 / 32767;  ///< 16 bits with a sign.

  [[nodiscard]] Vec3 normal(std::size_t i) const noexcept {
    return kNormalUnit * Vec3(normals[i][0], normals[i][1], normals[i][2]);
  }
};

/** Points on the surface in a sphere tree. */
struct Shell {
  ShellView view;  ///< Points into the vectors below.
  std::vector<SphereNode> nodes;
  std::vector<float> x, y, z;
  std::vector<std::uint8_t> leaf_count;
  std::vector<SampleFaces> faces;
  std::vector<float> facing;  ///< Each point's least cosine of its normal against a contact's.
  /** Each point's triangle of its first face, or kNoFace; empty where no face is freeform. */
  std::vector<std::uint32_t> triangle;
  std::vector<std::uint8_t> order;  ///< Each leaf's lanes, most telling first; Complete fills them.
  std::vector<std::uint8_t> rank;   ///< Each point's place in the order of its leaf; likewise.
  std::size_t point_count{0};
  // Of a shape with threads, Complete fills them: one more than the number of the thread on which a
  // point lies, or all points of a leaf, and kMaxHelices more beyond its span; 0: on none.
  std::vector<std::uint8_t> thread;
  std::vector<std::uint8_t> leaf_thread;

  /** The triangle of its first face that a point was drawn on, where that is known. */
  [[nodiscard]] std::uint32_t TriangleOf(std::size_t i) const noexcept {
    return triangle.empty() ? kNoFace : triangle[i];
  }

  [[nodiscard]] Vec3 point(std::size_t i) const noexcept {
    return {static_cast<double>(x[i]), static_cast<double>(y[i]), static_cast<double>(z[i])};
  }

  void Bind() {
    view = {nodes.data(),
            x.data(),
            y.data(),
            z.data(),
            leaf_count.data(),
            order.data(),
            static_cast<std::uint32_t>(nodes.size())};
  }
};

/** The centred frame C has its origin at the centre of the part's box and the axes of B. */
struct Shape::Data {
  std::uint64_t serial{0};  ///< No other shape of the process has it; Complete gives it.
  spatial::Box box_B;
  Vec3 p_BC{Vec3::Zero()};
  double voxel{0};
  Mesh mesh;
  CalcFourClosest closest{&CalcFourClosestScalar};  ///< Complete chooses it.
  Field field;
  ExactTable exact;
  std::vector<Helix> helices;  ///< Threads that are modelled; mostly none.
  /** Threads of the zones' lists: one more than the number of the thread on which all triangles of
   a list lie, or 0. Empty without threads; Complete fills it. */
  std::vector<std::uint8_t> list_thread;
  double spacing{0};
  Shell shell;  ///< All samples.
  Shell
      features;  ///< Those that can touch a flat face first: on convex edges, corners, round faces.

  /** Makes what follows from the rest and is not kept on disk. */
  void Complete();
};

}  // namespace hvas::contact
