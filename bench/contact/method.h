#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "parts.h"
#include "peer_mesh.h"
#include "tracks.h"

namespace hvas::bench {

/** A contact as a method reports it. */
struct FoundContact {
  Vec3 p_W;
  Vec3 nhat_W;   ///< Unit: moving the held part along it separates.
  double depth;  ///< [m], positive for penetration.
};

/** What a query had to look at, where a method counts it. */
struct Effort {
  std::size_t bodies{0}, points{0}, candidates{0};
};

/** A way to answer what a held part touches. Everything that can be prepared is prepared in Load.
 */
class Method {
 public:
  Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;
  virtual ~Method() = default;

  virtual void Load(std::size_t held, const std::vector<PlacedPart>& scene) = 0;
  /** Finds all that it can; returns how many contacts it found. */
  virtual std::size_t Query(const spatial::Pose& X_WH) = 0;
  /** Contacts of the last query; empty where the method tells yes or no only. */
  [[nodiscard]] virtual std::span<const FoundContact> contacts() = 0;

  /** Force of the last query: K sum(d^2 n) / sum(d), for K of 1 N/mm [N]. */
  [[nodiscard]] virtual Vec3 PooledForce();

  [[nodiscard]] virtual Effort effort() const { return {}; }
};

/** Contacts of contact::Scene. */
[[nodiscard]] std::unique_ptr<Method> MakeOurs(const std::vector<BenchPart>* parts, bool is_scalar);
/** FCL with OBBRSS trees under its dynamic AABB tree. @param max_contacts  Of a pair of parts; 0:
 yes or no only. */
[[nodiscard]] std::unique_ptr<Method> MakeFcl(MeshOf mesh_of, std::size_t max_contacts);
/** Bullet's GImpact under its dbvt; all contacts. */
[[nodiscard]] std::unique_ptr<Method> MakeGImpact(MeshOf mesh_of);
/** Boxes of parts, of 3 x 3 x 3 cells and of surfaces, then polygons: requirement X6. */
[[nodiscard]] std::unique_ptr<Method> MakeCellScheme(MeshOf mesh_of);

}  // namespace hvas::bench
