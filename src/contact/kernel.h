#pragma once

#include <cstdint>

/** The inner loop of a query on plain arrays, so that one source compiles for several instruction
 sets. Coordinates are single precision, in the shapes' centred frames, in metres. */
namespace hvas::contact {

inline constexpr int kBlockCells = 8;    ///< A side of a block: its nodes are 1.5 kB.
inline constexpr int kBlockNodes = 729;  ///< 9^3.
/** Cells whose middle is no further than this from the surface, in voxels, have a measured slack.
 */
inline constexpr float kSlackVoxels = 1.2F;
// The directory has these where there is no block.
inline constexpr std::int32_t kTopOutside = -1;
inline constexpr std::int32_t kTopInside = -2;
inline constexpr std::int32_t kTopFace = -3;  ///< Less the number of the face that has the block.

/** A block distance field. Node (i, j, k) of the grid lies at origin + voxel (i, j, k). */
struct FieldView {
  /** Block number; kTopOutside or kTopInside; or where one analytic face has all distances of a
   block, kTopFace less its number. */
  const std::int32_t* top{nullptr};
  const std::int16_t* nodes{nullptr};  ///< 9^3 a block, in units of quantum.
  const float* slack{nullptr};         ///< Each block's bound of the interpolation's error.
  int blocks[3]{0, 0, 0};
  float origin[3]{0, 0, 0};
  float voxel{0};
  float quantum{0};
  float band{0};                 ///< Distances are clamped to this.
  float beyond{0};               ///< Least distance from the surface of what lies in no block.
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
  const std::uint8_t* order{nullptr};  ///< Each leaf's eight lanes, most telling ones first.
  std::uint32_t node_count{0};
};

/** An analytic surface in single precision: with height h along the axis, distance r from it and
 u = r - radius, the distance is outward (across u + along h), or, of round ones,
 outward (sqrt(u^2 + h^2) - minor). */
struct FaceForm {
  enum class Kind : std::uint32_t { kNone, kStraight, kRound };

  float origin[3]{0, 0, 0};
  float axis[3]{0, 0, 1};
  float radius{0};
  float across{0};
  float along{0};
  float minor{0};
  float outward{1};
  double cosine{1};  ///< Cosine of a cone's half angle; the next is its sine.
  double sine{0};
  Kind kind{Kind::kNone};  ///< None: single precision is not good enough, or no such surface.
};

/** What decides the distance in a cube of 2^3 cells. The upper two bits say how, the rest is a
 face, a triangle or a list. */
namespace zone {
inline constexpr std::uint32_t kPayload = 0x3fffffffU;  // The two highest bits are the kind.
inline constexpr std::uint32_t kExact = 0x00000000U;    ///< One analytic face.
inline constexpr std::uint32_t kSmooth =
    0x40000000U;                                     ///< Freeform faces; the payload is a triangle.
inline constexpr std::uint32_t kList = 0x80000000U;  ///< Several: the triangles decide.
inline constexpr std::uint32_t kFar =
    0xc0000000U;  ///< Far from the surface; payload: nearest face.
}  // namespace zone

/** The faces of a zone's list, and how the solid comes of them there. */
struct ListFaces {
  static constexpr unsigned kMost = 5;  ///< More faces in a zone go through its triangles.

  enum class Kind : std::uint8_t {
    kMixed,         ///< The triangles decide.
    kIntersection,  ///< Inside all faces: each two meet in a convex edge, or are sides of a wall.
    kUnion          ///< Inside any: each two meet in a concave edge, or are sides of a gap.
  };

  std::uint16_t faces[kMost]{};
  std::uint16_t begin[kMost]{};  ///< First of each face's entries in the list.
  std::uint8_t count{0};         ///< 0: too many to name; the list is one.
  Kind kind{Kind::kMixed};
};

/** Which faces decide where. */
struct FaceView {
  const std::uint32_t* zones{nullptr};  ///< Codes as in `zone`, by block.
  const FaceForm* forms{nullptr};       ///< Each face's form.
  const ListFaces* lists{nullptr};      ///< Null: what several faces decide is left unscreened.
};

/** Takes the shell's coordinates to the field's. */
struct FloatPose {
  float R[9];
  float p[3];
};

// 32 ones stand for no face and for no list.
inline constexpr std::uint32_t kUnscreened = 0xffffffffU;
inline constexpr std::uint32_t kNoList = 0xffffffffU;
// The one before stands for a face that is known to be too far away.
inline constexpr std::uint32_t kKnownFar = 0xfffffffeU;

/** A point that may be nearer than the margin. */
struct Hit {
  std::uint32_t point;
  float distance;     ///< The face's distance, else the interpolated one.
  float gradient[3];  ///< The face's gradient, else the interpolated one, which is not unit.
  std::uint32_t face{kUnscreened};  ///< The one analytic face that decides, where there is one.
  std::uint32_t list{kNoList};      ///< It does so among these.
  std::uint32_t zone{zone::kFar};   ///< What decides there, as in `zone`, where that is not known.
};

struct HitBuffer {
  Hit* hits{nullptr};
  std::uint32_t capacity{0};
  std::uint32_t count{0};
  std::uint32_t points_tested{0};
  bool is_truncated{false};
};

/** A leaf of a shell that may be near a field. */
struct NearLeaf {
  std::uint32_t leaf;
  std::uint32_t place;  ///< Place of its bound: eight times its parent's number plus the child's.
};

struct LeafBuffer {
  NearLeaf* leaves{nullptr};
  std::uint32_t capacity{0};
  std::uint32_t count{0};
  bool is_truncated{false};
};

/** Selects of every `stride`-th leaf the `points` first ones in the leaf's order. */
struct LeafChoice {
  const NearLeaf* leaves{nullptr};
  std::uint32_t count{0};
  std::uint32_t points{8};
  std::uint32_t stride{1};
};

inline constexpr float kBoundRounding = 1e-7F;  ///< [m] of a bound in single precision, at most.

/** Lower bounds of the distances of a shell's spheres from a field, eight for each node: what the
 distance was when it was last looked at, and how far the shapes had moved until then. */
struct BoundView {
  float* bounds{nullptr};  ///< [m]; null: nothing is known, and nothing remembered.
  float moved{0};  ///< [m]: how far any sample has moved in the field's frame until now, at most.
  std::uint32_t turn{0};   ///< Counts the queries that had these bounds.
  std::uint32_t since{0};  ///< Number of the moment from which `moved` counts.
};

/** The inner loops for one set of instructions. All give the same bits. RT-safe. */
struct Kernel {
  /** Appends the leaves of the shell that may have points nearer to the field's surface than the
   margin. Leaves out what is further by its bound, and gives bounds to what it finds further. */
  void (*collect)(const ShellView&, const FieldView&, const FloatPose& X_FS, float margin,
                  const BoundView&, LeafBuffer*);
  /** Appends those points of the leaves whose distance may be below the margin: those where
   one analytic face decides by their distance from it, the others by the interpolated one less its
   slack. Gives bounds to leaves of which it tests all points. */
  void (*test)(const ShellView&, const FieldView&, const FaceView&, const FloatPose& X_FS,
               float margin, const BoundView&, const LeafChoice&, HitBuffer*);
};

[[nodiscard]] Kernel ScalarKernel() noexcept;
/** @pre The machine has AVX2. */
[[nodiscard]] Kernel Avx2Kernel() noexcept;
/** The fastest that this machine runs. */
[[nodiscard]] Kernel ChooseKernel() noexcept;

/** Coarse distance and gradient, outside the coarse grid continued by the way to it. RT-safe. */
float CalcCoarse(const FieldView& field, const float p[3], float gradient[3]) noexcept;

}  // namespace hvas::contact
