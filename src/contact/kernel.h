#pragma once

#include <cstdint>

/** The inner loop of a query on plain arrays, so that one source compiles for several instruction
 sets. Coordinates are single precision, in the shapes' centred frames, in metres. */
namespace hvas::contact {

inline constexpr int kBlockCells = 8;
inline constexpr int kBlockNodes = 729;  ///< 9^3.
inline constexpr std::int32_t kTopOutside = -1;
inline constexpr std::int32_t kTopInside = -2;

/** A block distance field. Node (i, j, k) of the grid lies at origin + voxel (i, j, k). */
struct FieldView {
  const std::int32_t* top{nullptr};    ///< Block number, or kTopOutside, or kTopInside.
  const std::int16_t* nodes{nullptr};  ///< 9^3 a block, in units of quantum.
  const float* slack{nullptr};         ///< Of each block: bound of the interpolation's error.
  int blocks[3]{0, 0, 0};
  float origin[3]{0, 0, 0};
  float voxel{0};
  float quantum{0};
  float band{0};    ///< Distances are clamped to this.
  float beyond{0};  ///< Least distance from the surface of what lies in no block.
  const float* coarse{nullptr};  ///< Signed distance on a coarse grid around the part.
  int coarse_count[3]{0, 0, 0};
  float coarse_origin[3]{0, 0, 0};
  float coarse_cell{0};
  float low[3]{0, 0, 0};  ///< The part's box.
  float high[3]{0, 0, 0};
};

/** Node of the sphere tree: eight children. child >= 0: a node; -1: none; less: leaf number -2 -
 * child. */
struct SphereNode {
  alignas(32) float x[8];
  float y[8];
  float z[8];
  float radius[8];
  std::int32_t child[8];
};

/** Points in leaves of eight; unused lanes repeat the leaf's last point, count tells how many
 * count. */
struct ShellView {
  const SphereNode* nodes{nullptr};
  const float* x{nullptr};
  const float* y{nullptr};
  const float* z{nullptr};
  const std::uint8_t* leaf_count{nullptr};
  std::uint32_t node_count{0};
};

/** Takes the shell's coordinates to the field's. */
struct FloatPose {
  float R[9];
  float p[3];
};

/** A point that may be nearer than the margin. */
struct Hit {
  std::uint32_t point;
  float distance;
  float gradient[3];  ///< Not unit.
};

struct HitBuffer {
  Hit* hits{nullptr};
  std::uint32_t capacity{0};
  std::uint32_t count{0};
  std::uint32_t points_tested{0};
  bool is_truncated{false};
};

using TraverseFunction = void (*)(const ShellView&, const FieldView&, const FloatPose&,
                                  float margin, HitBuffer*);

/** Appends all points of the shell whose field distance is below margin + slack. RT-safe. Both
 give the same bits. */
void TraverseScalar(const ShellView& shell, const FieldView& field, const FloatPose& X_FS,
                    float margin, HitBuffer* out) noexcept;
void TraverseAvx2(const ShellView& shell, const FieldView& field, const FloatPose& X_FS,
                  float margin, HitBuffer* out) noexcept;
/** The fastest that this machine runs. */
[[nodiscard]] TraverseFunction ChooseTraverse() noexcept;

/** Coarse distance and gradient, outside the coarse grid continued by the way to it. RT-safe. */
float CalcCoarse(const FieldView& field, const float p[3], float gradient[3]) noexcept;

}  // namespace hvas::contact
