#pragma once

#include <memory>
#include <utility>

#include "haptics/test/rig.h"

namespace hvas::haptics::testing {

/** A table at z = 0 with parts on it that are fixed, loose or in the hand. */
struct Table {
  explicit Table(double friction = 0.3, double rest_time = TickOptions().contact.rest_time) {
    options.contact.rest_time = rest_time;
    options.contact.friction.static_coefficient = friction;
    options.contact.friction.kinetic_coefficient = friction;
    scene.SetGround(0);
    tick = std::make_unique<HapticTick>(options, &scene);
  }

  contact::BodyId AddFixed(std::shared_ptr<const contact::Shape> shape, const spatial::Pose& X_WB) {
    return scene.Add(std::move(shape), X_WB);
  }

  contact::BodyId AddLoose(std::shared_ptr<const contact::Shape> shape, const spatial::Pose& X_WB,
                           double mass, const Mat3& inertia) {
    const contact::BodyId id = scene.Add(std::move(shape), X_WB);
    BodyProperties properties;
    properties.mass = mass;
    properties.I_BBcm_B = inertia;
    tick->SetProperties(id, properties);
    tick->SetLoose(id, true);
    return id;
  }

  /** Takes a part up and lets go of it where it is, so that it falls. */
  void Drop(contact::BodyId id, std::shared_ptr<const contact::Shape> shape, double mass,
            const Mat3& inertia) {
    part.body = id;
    part.bodies = {id};
    part.shape = std::move(shape);
    part.mass = mass;
    part.I_BBcm_B = inertia;
    part.X_WB_start = scene.pose(id);
    part.X_WB_goal = spatial::Pose(Vec3(1, 1, 1));
    part.falls_when_dropped = true;
    tick->Take(&part);
    (void)tick->Drop();
  }

  /** Ticks with nothing in the hand. */
  void Wait(double time) {
    ScriptedHand hand(tick.get(), spatial::Pose(Vec3(1, 0, 1)));
    hand.Wait(time);
  }

  TickOptions options;
  contact::Scene scene;
  std::unique_ptr<HapticTick> tick;
  HeldPart part;
};

inline Mat3 BoxInertia(double mass, const Vec3& half) {
  const Vec3 s = half.cwiseProduct(half);
  return (mass / 3 * Vec3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y())).asDiagonal();
}

}  // namespace hvas::haptics::testing
