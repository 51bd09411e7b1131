#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/diagnostics.h"
#include "contact/face_offsets.h"
#include "fits/fit_force.h"
#include "product/product.h"
#include "sequence/sequence.h"

namespace hvas::simulation {

struct Model;

/** What the faces as made are found from; by OccurrenceId and by MateId. */
struct ActualFacesInput {
  const product::Product* product{nullptr};
  std::vector<std::shared_ptr<const contact::Shape>> shapes;
  std::vector<std::shared_ptr<const fits::FitForce>> fits;  ///< Null where there is none.
  const sequence::Sequence* sequence{
      nullptr};  ///< Says which end of a hole is its mouth, and has reliefs.
  /** Fits that leave no room answer for their force; else contact has their interference. */
  bool fits_answer{true};
};

/** What the faces of a model's parts are made from. Refers to the model. */
[[nodiscard]] ActualFacesInput MakeActualFacesInput(const Model& model);

/** The faces of the parts as made, so that contact has the clearance that the fits say. A fit that
 leaves room along its whole length, S(l) > 0, moves its two faces: the shaft's to its actual size,
 the hole's by what is left to S(l), with its profile from the mouth inwards. The walls of a slot,
 which are planes, move by what is left to the least S of a prismatic fit, about where the tongue is
 drawn; without room by what lets it just pass, as the fit answers for the force there. A face takes
 the first mate (by id) that gives it a size; a further mate on it moves the other face, or, where
 both have their size, neither. Faces that also have an axis-hole mate with interference, a thread
 or no fit stay as drawn whatever other mates say: what answers for them there takes them so; but a
 hole that is drawn narrower than the shaft pressed into it is widened to let its end pass. Where
 fits do not answer, interference moves the faces as room does. Offsets are not made either beyond
 FaceOffsets::kLargest, with a diagnostic. All faces give way by Sequence::reliefs. Returned by
 OccurrenceId; null: as drawn. */
[[nodiscard]] std::vector<std::shared_ptr<const contact::FaceOffsets>> MakeActualFaces(
    const ActualFacesInput& input, Diagnostics* diagnostics);

}  // namespace hvas::simulation
