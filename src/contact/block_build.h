#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "contact/near_list.h"
#include "contact/shape_data.h"

namespace hvas::contact {

inline const double kHalfDiagonal = std::sqrt(3.0) / 2;  ///< Half the diagonal of a cube, in sides.
inline constexpr double kBandVoxels = 4.0;               ///< The distance that nodes hold, at most.

/** Depth of the layer on both sides of the surface that is answered exactly [m]: a voxel, but
 deeper than parts are pressed into each other as far as two voxels reach. */
[[nodiscard]] double CalcExactDepth(double voxel);

/** Blocks are kept that come this near the surface [m]. */
[[nodiscard]] double CalcBlockReach(double voxel);

struct Zone {
  std::uint32_t code{zone::kFar};
  std::uint32_t begin{0};  ///< First entry of what zone::kList has, in Block::listed.
  std::uint32_t end{0};
};

/** A block of the field before it is laid down. */
struct Block {
  std::int32_t top{0};  ///< Its place in the field's directory.
  Vec3 origin{Vec3::Zero()};
  std::array<std::int16_t, kBlockNodes> nodes{};
  std::array<Zone, kZonesPerBlock> zones;
  NearList listed;              ///< The lists of all zones, with distances from each zone's centre.
  bool is_near{false};          ///< Some node is near the surface; else the block is not needed.
  bool is_inside{false};        ///< Where it is not near: on which side.
  std::uint32_t face{kNoFace};  ///< That gives all distances in the block by its FaceForm.
};

/** Fills blocks: distances at the nodes, and what decides in each zone. One for each thread. */
class BlockBuilder {
 public:
  BlockBuilder(const Shape::Data& data, const NearSearch& search);

  /** Fills a new block, which has its place and origin.
   @param near  What may be closest within it; not empty. */
  void Build(const NearSet& near, Block* block);

 private:
  using Index3 = std::array<int, 3>;

  // An entry of the list that is cut down.
  struct Candidate {
    NearTriangle entry{kNoFace, 0};
    std::size_t face{0};  // Its number among the faces of the list.
    unsigned side{0};     // The octant of the zone that its point closest to the centre is in.
  };

  // Of the distance of a face from a point [m].
  struct Bounds {
    double low;
    double high;
  };

  struct Cubes;        // Those of half a zone's size.
  struct OctantFaces;  // The faces of a list as seen from the octants of a cube.

  [[nodiscard]] bool IsFar(const Vec3& middle);
  void BuildOctant(const Index3& low, NearSet* octant);
  void BuildZone(const Index3& zone, const BegunFilter& begun);
  bool TryExact(const NearList& list, const Vec3& centre, double half, const Index3& low,
                int zones);
  bool AgreesWithFace(const NearList& list, const Vec3& centre, double half);
  void DropFarFaces(const Vec3& centre, double half, double distance, NearList* list);
  void MeasureFaces(double limit, OctantFaces* faces) const;
  [[nodiscard]] double CalcLimit(double from_mesh, double radius) const;
  [[nodiscard]] double FindDistance(const NearList& list, const Vec3& p, double offset);
  void DropHidden(const Vec3& centre, std::size_t faces, NearList* list);
  void KeepClosest(const Vec3& centre, NearList* list);
  void CollectCandidates(const Vec3& centre, const NearList& list, Cubes* cubes);
  void FindPointsOnSide(const Cubes& cubes);
  [[nodiscard]] bool MayBeClosestInCubes(std::size_t i, Cubes* cubes) const;
  [[nodiscard]] bool MayBeClosest(const Candidate& candidate, const TrianglePoint& point,
                                  const Vec3& c, double radius, const Bounds& bounds,
                                  double* least) const;
  void FillFarZone(const Index3& zone, double distance);
  void FillNodes(const Index3& zone, const BoxedList& list);
  void SetNode(int i, int j, int k, double phi);
  [[nodiscard]] std::int16_t ToUnits(double phi) const;
  [[nodiscard]] std::uint32_t FindOnlyFace() const;
  void DecideZone(const Vec3& centre, const NearList& list, Zone* out);
  [[nodiscard]] bool IsSmooth(const NearList& list) const;
  [[nodiscard]] Vec3 CentreOf(const Index3& zone) const;
  [[nodiscard]] Zone* ZoneOf(const Index3& zone) const;

  const Shape::Data& data_;
  const NearSearch& search_;
  double h_;
  double quantum_;  // Of the nodes [m].
  double exact_depth_;
  double block_reach_;
  double face_margin_;
  double most_deviation_{0};
  Block* block_{nullptr};
  std::array<NearSet, 8> octants_;    // Of the block.
  std::array<BegunFilter, 8> begun_;  // Of the block's octants, then of the octant's zones.
  NearSet zone_;                      // What is near the zone at hand.
  NearList kept_;                     // What is listed of it.
  NodeRoom room_;
  std::array<Nearest, NodeGrid::kMost> nodes_;  // What is closest to each node of it.
  std::vector<std::size_t> face_numbers_;       // Of kept_, among its faces.
  std::vector<TrianglePoint> points_;           // Closest to the zone's centre, of kept_.
  std::vector<Candidate> candidates_;
  std::uint32_t hint_{kNoFace};
};

}  // namespace hvas::contact
