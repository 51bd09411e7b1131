#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "contact/scene.h"
#include "contact/shape.h"
#include "contact/shape_cache.h"
#include "dynamics/world.h"
#include "fits/fit_force.h"
#include "fits/pair_choice.h"
#include "haptics/held_part.h"
#include "mates/thread_joints.h"
#include "product/drive_forms.h"
#include "product/product.h"
#include "sequence/sequence.h"
#include "simulation/deformation.h"
#include "simulation/pressed_pairs.h"

namespace hvas::simulation {

/** What an occurrence is to the assembly (X16). */
enum class BodyRole : std::uint8_t {
  kPart,     ///< Part of the product.
  kTool,     ///< It is held, and turns fasteners; no step of the assembly puts it in.
  kFixture,  ///< It stands where it was put, and is met.
  kPending,  ///< A part whose contact shape is not there yet: it is seen, and not met.
};

/** Tools and fixtures among the occurrences of a product, as its tree has them
 (product/accessories.h). */
struct Accessories {
  std::vector<product::OccurrenceId> tools;
  std::vector<product::OccurrenceId> fixtures;  ///< Those of the bench come last.
  std::size_t bench_count{0};                   ///< Fixtures that are laid out on the table.
  double fastener_torque{0.5};  ///< Dry friction of fasteners that tools turn [N m]. A choice.
};

/** A part as the loops see it. */
struct Body {
  product::OccurrenceId occurrence;
  std::shared_ptr<const contact::Shape> shape;
  dynamics::MassProperties mass;  ///< Never without mass: what has none gets a little.
  spatial::Pose X_WB_goal;        ///< Place as drawn.
  spatial::Pose X_WB_start;       ///< Lying on the table.
  std::shared_ptr<const contact::FaceOffsets> faces;  ///< Faces as made; null: as drawn.
  BodyRole role{BodyRole::kPart};
  /** Forms for tools, where the model has tools and this is a tool or a fastener. */
  std::vector<product::DriveForm> drives;
};

/** A mate with what the loops need besides its geometry. */
struct ModelMate {
  product::MateId id;
  std::shared_ptr<const haptics::MateFaces> faces_a;
  std::shared_ptr<const haptics::MateFaces> faces_b;
  std::shared_ptr<const fits::FitForce> fit;  ///< Null for planes and threads.
  /** The joint, where the mate is a thread; else null. */
  std::shared_ptr<const mates::ThreadJoint> thread;
};

struct Model;

struct CompileOptions {
  std::uint64_t seed{1};  ///< Draws the actual sizes of the fits.
  fits::PairChoice pairs{fits::PairChoice::kOfKind};
  /** Parts that come first, as Reorder() takes them; the others follow in the order that is found.
   */
  std::vector<std::string> first_parts;
  std::string base;  ///< Name, path or id of the part that stays in the fixture; empty: found.
  /** The whole order of assembly, as a record keeps it, in place of the one that is found; empty:
   that one. */
  std::vector<sequence::SequenceStep> steps;
  contact::ShapeOptions shape;                       ///< Its `stop` ends all of the preparation.
  std::shared_ptr<contact::ShapeCache> shape_cache;  ///< Null: shapes are always built.
  unsigned threads{0};                               ///< That build shapes; 0: one a core.
  std::uint64_t way_looks{
      sequence::kWayLooks};  ///< Limits the search for ways that turn, for each part.
  /** Limits the search for the order, in all of the product. */
  std::uint64_t search_queries{sequence::kSearchQueries};
  std::function<void(const std::string& stage, double fraction)> progress;
  /** Called by the calling thread with a model of the parts that are ready, long before the others
   are; never where that is no gain. All others are pending in it. May be null. */
  std::function<void(const std::shared_ptr<const Model>& model)> on_first_parts;
  /** It is no gain where the shapes of the others take less than this, by what those of the first
   took. A choice, as a person waits. */
  std::chrono::duration<double> least_gain{1.5};
};

/** Immutable; shared by all loops. A change of fit or mate compiles a new one. */
struct Model {
  std::shared_ptr<const product::Product> product;
  std::vector<Body> bodies;                            ///< Indexed by OccurrenceId.
  std::vector<ModelMate> mates;                        ///< Indexed by MateId.
  std::vector<std::vector<product::MateId>> mates_of;  ///< Indexed by OccurrenceId.
  sequence::Sequence sequence;
  std::vector<PressedPair> presses;     ///< What parts press together on their way, in this order.
  std::vector<Deformable> deformables;  ///< Parts that are drawn deformed, in this order.
  Accessories accessories;
  double table_z{0};            ///< [m]
  Vec3 centre_W{Vec3::Zero()};  ///< The product's.
  double transfer_radius{0};    ///< A part carried this far from the centre meets nothing [m].
  std::uint64_t seed{1};
  fits::PairChoice pairs{fits::PairChoice::kOfKind};
};

/** Counts the bodies that belong to the product: neither tools nor fixtures. */
[[nodiscard]] inline std::size_t CountParts(const Model& model) {
  return model.bodies.size() - model.accessories.tools.size() - model.accessories.fixtures.size();
}

/** Counts the parts whose contact shapes are not there yet. */
[[nodiscard]] inline std::size_t CountPending(const Model& model) {
  return static_cast<std::size_t>(
      std::count_if(model.bodies.begin(), model.bodies.end(),
                    [](const Body& body) { return body.role == BodyRole::kPending; }));
}

/** Builds shapes, fits, the order of assembly and the layout of the parts on the table.
 Errors: kInvalid when the product has no parts or a shape cannot be built; those of Reorder();
 kNotFound where no part is called as the base; kCancelled after a stop. */
Result<std::shared_ptr<const Model>> Compile(std::shared_ptr<const product::Product> product,
                                             const CompileOptions& options,
                                             Diagnostics* diagnostics);

/** Makes the same model with other actual sizes of its fits: equal to what Compile makes with this
 seed and choice of pairs, without its work. */
[[nodiscard]] std::shared_ptr<const Model> DrawSizes(const Model& model, std::uint64_t seed,
                                                     fits::PairChoice pairs,
                                                     Diagnostics* diagnostics);

/** Makes the same model with another order of assembly, whose ways are made free as Compile makes
 them. @param steps  All steps, as Sequence has them. */
[[nodiscard]] std::shared_ptr<const Model> ChangeOrder(const Model& model,
                                                       std::vector<sequence::SequenceStep> steps,
                                                       const std::stop_token& stop,
                                                       Diagnostics* diagnostics);

/** What the planners of a model's order and of its disassembly need.
 @param scene  Gets all parts at their drawn poses; outlives the result. */
[[nodiscard]] sequence::SequenceInput MakeSequenceInput(const Model& model, contact::Scene* scene);

/** Mass of what moves in a step, about the leading part's frame, with its members as drawn. */
[[nodiscard]] dynamics::MassProperties CombineMass(const Model& model,
                                                   const sequence::SequenceStep& step);

/** The world of dynamics in which a model's loose parts lie. */
[[nodiscard]] dynamics::WorldOptions TableOptions(const Model& model);

}  // namespace hvas::simulation
