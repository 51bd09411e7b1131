#include "mates/thread_joints.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "fits/materials.h"
#include "product/fastener_name.h"
#include "product/threads.h"
#include "product/words.h"

namespace hvas::mates {
namespace {

using product::Feature;
using product::Mate;
using product::Part;
using product::ThreadKind;

// Property class 8.8 of ISO 898-1 up to M16: R_p0.2 [Pa].
constexpr double kYieldStress = 640e6;

bool IsSelfTappingByName(std::string_view name) {
  // ISO 1479 to 1483, 7049 to 7051 and their DIN predecessors are tapping screws.
  static constexpr std::array<std::string_view, 16> kWords{
      "self tapping", "tapping screw", "wood screw", "plastite", "blechschraube", "blechschrauben",
      "din 7981",     "din 7982",      "din 7983",   "iso 1479", "iso 1481",      "iso 1482",
      "iso 1483",     "iso 7049",      "iso 7050",   "iso 7051"};
  return product::HasOneOf(product::FoldName(name), kWords);
}

bool IsPlastic(const product::Material& material) {
  const auto match = fits::FindMaterial(material.name);
  return match && match->material->group == "polymer";
}

const fits::Thread* FindStandard(const Part& hub, const Part& screw, const Mate& mate,
                                 double pitch) {
  const fits::Thread* const pair =
      pitch > 0 ? nullptr : fits::FindThreadOfPair(2 * mate.hole_radius, 2 * mate.shaft_radius);
  for (const Part* part : {&screw, &hub}) {
    const auto size = product::ParseThreadSize(part->name);
    const fits::Thread* const named =
        size ? fits::FindThread(size->diameter, size->pitch) : nullptr;
    if (named != nullptr) {
      // A name that states the size alone leaves the pitch to the two diameters.
      const bool is_same = pair != nullptr && pair->diameter == named->diameter;
      return is_same && !size->is_pitch_stated ? pair : named;
    }
  }
  if (pair != nullptr) {
    return pair;
  }
  const fits::Thread* const thread = fits::FindThread(2 * mate.shaft_radius, pitch);
  return thread != nullptr ? thread : fits::FindThread(2 * mate.hole_radius, pitch);
}

ThreadJoint MakeJoint(const product::Product& product, const Mate& mate) {
  const Part& hub = product.part_of(mate.a.occurrence);
  const Part& screw = product.part_of(mate.b.occurrence);
  const Feature& hole = hub.features[mate.a.feature.index()];
  const Feature& shaft = screw.features[mate.b.feature.index()];
  const Feature& drawn = shaft.thread == ThreadKind::kModelled ? shaft : hole;
  ThreadJoint joint;
  joint.mate = mate.id;
  joint.engaged = mate.overlap;
  joint.is_modelled = drawn.thread == ThreadKind::kModelled;
  if (joint.is_modelled) {
    const Part& part = &drawn == &shaft ? screw : hub;
    joint.is_left_handed = product::IsLeftHanded(part, drawn);
  }
  joint.pitch = joint.is_modelled ? drawn.thread_pitch : 0;
  joint.thread = FindStandard(hub, screw, mate, joint.pitch);
  joint.diameter = 2 * mate.shaft_radius;
  const bool is_bought_nut = product::ClassifyName(hub.name) == product::FastenerKind::kNut;
  if (IsSelfTappingByName(screw.name) ||
      (IsPlastic(hub.material) && !is_bought_nut && hole.thread == ThreadKind::kNone)) {
    joint.kind = ThreadJointKind::kSelfTapping;
  }
  if (joint.thread != nullptr) {
    joint.diameter = joint.thread->diameter;
    joint.pitch = joint.is_modelled ? joint.pitch : joint.thread->pitch;
    joint.hole = fits::ClassifyThreadHole(*joint.thread, 2 * mate.hole_radius);
    if (joint.kind == ThreadJointKind::kThreaded) {
      joint.tightening = fits::CalcTightening(*joint.thread, kYieldStress, kThreadFriction,
                                              kThreadFriction, kHeadContact * joint.diameter);
    }
  }
  joint.turns = joint.pitch > 0 ? joint.engaged / joint.pitch : 0;
  return joint;
}

}  // namespace

std::vector<ThreadJoint> FindThreadJoints(const product::Product& product) {
  std::vector<ThreadJoint> joints;
  for (const Mate& mate : product.mates) {
    if (mate.fit && mate.fit->kind == product::FitKind::kThread) {
      joints.push_back(MakeJoint(product, mate));
    }
  }
  return joints;
}

const char* ToString(ThreadJointKind kind) {
  return kind == ThreadJointKind::kThreaded ? "threaded" : "self_tapping";
}

}  // namespace hvas::mates
