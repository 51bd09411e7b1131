// X16: a tool on a fastener: what angle it has, and turning by contact.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "base/units.h"
#include "haptics/test/rig.h"
#include "orders/tool_reach.h"
#include "orders/tool_turn.h"

namespace hvas::orders {
namespace {

using contact::ShapeSource;
using product::DriveForm;
using product::DriveKind;
using spatial::Pose;
using units::FromDeg;

/** A part of plane faces, as a contact shape and as vertices. */
class PlaneBody {
 public:
  /** Corners in the order seen from outside. */
  void AddFace(const std::vector<Vec3>& corners) {
    AddTriangles({corners}, (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized());
  }

  /** A plane face of several convex pieces. */
  void AddTriangles(const std::vector<std::vector<Vec3>>& pieces, const Vec3& normal) {
    spatial::Surface plane;
    plane.kind = spatial::SurfaceKind::kPlane;
    plane.origin = pieces[0][0];
    plane.axis = normal;
    const auto face = static_cast<std::uint32_t>(source_.faces.size());
    source_.faces.push_back(plane);
    for (const std::vector<Vec3>& corners : pieces) {
      const auto first = static_cast<std::uint32_t>(source_.vertices.size());
      source_.vertices.insert(source_.vertices.end(), corners.begin(), corners.end());
      for (std::uint32_t i = 1; i + 1 < corners.size(); ++i) {
        source_.triangles.push_back({first, first + i, first + i + 1});
        source_.triangle_face.push_back(face);
      }
    }
  }

  [[nodiscard]] std::shared_ptr<const contact::Shape> Build() const {
    return *contact::Shape::Build(source_, {});
  }

  [[nodiscard]] product::Part MakePart() const {
    product::Part part;
    part.mesh.vertices = source_.vertices;
    return part;
  }

 private:
  ShapeSource source_;
};

std::array<Vec3, 6> MakeHexagon(double across, double z) {
  std::array<Vec3, 6> corners;
  for (int i = 0; i < 6; ++i) {
    const double angle = FromDeg(30 + 60 * i);
    corners[static_cast<std::size_t>(i)] = {across / std::numbers::sqrt3 * std::cos(angle),
                                            across / std::numbers::sqrt3 * std::sin(angle), z};
  }
  return corners;
}

void AddHexagonWalls(double across, double low, double high, bool is_recess, PlaneBody* body) {
  const auto bottom = MakeHexagon(across, low);
  const auto top = MakeHexagon(across, high);
  for (std::size_t i = 0; i < 6; ++i) {
    const std::size_t k = (i + 1) % 6;
    if (is_recess) {
      body->AddFace({bottom[k], bottom[i], top[i], top[k]});
    } else {
      body->AddFace({bottom[i], bottom[k], top[k], top[i]});
    }
  }
}

void AddHexagonLid(double across, double z, double up, PlaneBody* body) {
  const auto c = MakeHexagon(across, z);
  if (up > 0) {
    body->AddFace({c.begin(), c.end()});
  } else {
    body->AddFace({c.rbegin(), c.rend()});
  }
}

PlaneBody MakeBlock(const Vec3& low, const Vec3& high) {
  PlaneBody body;
  const auto p = [&](int x, int y, int z) {
    return Vec3(x != 0 ? high.x() : low.x(), y != 0 ? high.y() : low.y(),
                z != 0 ? high.z() : low.z());
  };
  body.AddFace({p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0)});
  body.AddFace({p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)});
  body.AddFace({p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)});
  body.AddFace({p(0, 1, 0), p(0, 1, 1), p(1, 1, 1), p(1, 1, 0)});
  body.AddFace({p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0)});
  body.AddFace({p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1)});
  return body;
}

constexpr double kSocket = 5e-3;
constexpr double kBit = 4.95e-3;

DriveForm MakeSocketDrive(double width) {
  DriveForm drive;
  drive.is_recess = true;
  drive.origin_B = Vec3(0, 0, 10e-3);
  drive.axis_B = -Vec3::UnitZ();
  drive.flat_B = -Vec3::UnitX();
  drive.width = width;
  drive.depth = 5e-3;
  return drive;
}

/** Of a tool that stands on the tip of its bit at its origin. */
DriveForm MakeBitDrive(double width) {
  DriveForm drive;
  drive.axis_B = Vec3::UnitZ();
  drive.flat_B = Vec3::UnitX();
  drive.width = width;
  drive.depth = 20e-3;
  return drive;
}

TEST(ToolMateX16, TheHexagonsPlayIsThatOfItsCornersBetweenTheFlats) {
  EXPECT_FALSE(simulation::CalcDrivePlay(MakeSocketDrive(5e-3), MakeBitDrive(5.1e-3)));
  EXPECT_NEAR(*simulation::CalcDrivePlay(MakeSocketDrive(5e-3), MakeBitDrive(5e-3)), 0, 1e-9);
  // Where half the play is turned, a corner is on a flat: r cos(30 deg - play/2) = S/2.
  const double play = *simulation::CalcDrivePlay(MakeSocketDrive(kSocket), MakeBitDrive(kBit));
  EXPECT_NEAR(kBit / std::numbers::sqrt3 * std::cos(FromDeg(30) - 0.5 * play), 0.5 * kSocket,
              1e-12);
  // A bit whose corners pass the flats turns without the fastener.
  EXPECT_FALSE(simulation::CalcDrivePlay(MakeSocketDrive(5e-3), MakeBitDrive(5e-3 * 0.86)));
  EXPECT_TRUE(simulation::CalcDrivePlay(MakeSocketDrive(5e-3), MakeBitDrive(5e-3 * 0.87)));
}

TEST(ToolMateX16, ASlotsPlayIsThatOfTheBladesCorners) {
  DriveForm slot = MakeSocketDrive(1.6e-3);
  slot.kind = DriveKind::kSlot;
  slot.span = 8e-3;
  DriveForm blade = MakeBitDrive(1.5e-3);
  blade.kind = DriveKind::kSlot;
  blade.span = 7e-3;
  const double half = 0.5 * *simulation::CalcDrivePlay(slot, blade);
  EXPECT_NEAR(0.5 * 7e-3 * std::sin(half) + 0.5 * 1.5e-3 * std::cos(half), 0.8e-3, 1e-12);
  EXPECT_NEAR(simulation::MakeToolMate(slot, blade)->pitch, std::numbers::pi, 1e-12);
}

/** A bar along x from the axis, 6 mm wide, on a screw between walls that face it. */
struct WallRig {
  static constexpr double kLength = 80e-3;
  static constexpr double kHalfWidth = 3e-3;

  /** @param distances  Of walls from the axis towards +y and -y; 0: none. */
  explicit WallRig(std::array<double, 2> distances)
      : body(MakeBlock(Vec3(-kHalfWidth, -kHalfWidth, 0), Vec3(kLength, kHalfWidth, 10e-3))),
        tool(body.Build()),
        part(body.MakePart()) {
    fastener = scene.Add(MakeBlock(Vec3(-1e-3, -1e-3, 0), Vec3(1e-3, 1e-3, 10e-3)).Build(), Pose());
    for (const double d : distances) {
      walls.push_back(scene.Add(MakeBlock(Vec3(-0.5, 0, -0.05), Vec3(0.5, 10e-3, 0.05)).Build(),
                                walls.empty()
                                    ? Pose(Vec3(0, d > 0 ? d : 10, 0))
                                    : Pose(Quat(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitZ())),
                                           Vec3(0, -(d > 0 ? d : 10), 0))));
    }
  }

  [[nodiscard]] ToolReach Find() const {
    ReachQuery query;
    query.scene = &scene;
    query.fastener = fastener;
    query.tool = tool.get();
    query.tool_part = &part;
    return CalcToolReach(
        query, *simulation::MakeToolMate(MakeSocketDrive(kSocket), MakeBitDrive(kBit)), Pose());
  }

  /** Angle of the bar at which its corner meets a wall. */
  [[nodiscard]] static double CalcStop(double distance) {
    return std::asin(distance / std::hypot(kLength, kHalfWidth)) - std::atan2(kHalfWidth, kLength);
  }

  PlaneBody body;
  std::shared_ptr<const contact::Shape> tool;
  product::Part part;
  contact::Scene scene;
  contact::BodyId fastener;
  std::vector<contact::BodyId> walls;
};

TEST(ToolReachX16, NothingInTheWayLeavesTheWholeTurn) {
  const ToolReach reach = WallRig({0, 0}).Find();
  ASSERT_EQ(reach.arcs.size(), 1);
  EXPECT_TRUE(reach.arcs[0].is_full);
  EXPECT_TRUE(reach.arcs[0].can_go_on);
  EXPECT_NEAR(reach.lever, std::hypot(WallRig::kLength, WallRig::kHalfWidth), 1e-9);
}

TEST(ToolReachX16, TheAngleBeforeAWallIsThatOfTheBarsCorners) {
  const double distance = 30e-3;
  const WallRig rig({distance, 0});
  const ToolReach reach = rig.Find();
  ASSERT_EQ(reach.arcs.size(), 1);
  const double stop = WallRig::CalcStop(distance);
  EXPECT_NEAR(reach.arcs[0].angle(), std::numbers::pi + 2 * stop, FromDeg(0.05));
  EXPECT_EQ(reach.arcs[0].at_from, rig.walls[0]);
  EXPECT_EQ(reach.arcs[0].at_to, rig.walls[0]);
  EXPECT_TRUE(reach.arcs[0].can_go_on);
  EXPECT_FALSE(reach.is_truncated);
}

TEST(ToolReachX16, BetweenTwoWallsAHexagonKeyNeedsSixtyDegreesToGoOn) {
  // 30 mm leave two arcs of 42 degrees, 45 mm two of more than 60.
  for (const double distance : {30e-3, 45e-3}) {
    const WallRig rig({distance, distance});
    const ToolReach reach = rig.Find();
    ASSERT_EQ(reach.arcs.size(), 2);
    const double angle = 2 * WallRig::CalcStop(distance);
    for (const FreeArc& arc : reach.arcs) {
      EXPECT_NEAR(arc.angle(), angle, FromDeg(0.05));
      EXPECT_NE(arc.at_from, arc.at_to);
      EXPECT_TRUE(arc.can_put_on);
      EXPECT_EQ(arc.can_go_on, angle > FromDeg(60));
    }
    EXPECT_NEAR(reach.FindBest()->angle(), angle, FromDeg(0.05));
  }
}

/** A bit of 4.95 mm for a socket of 5 mm in a block. */
struct SocketRig {
  SocketRig() {
    AddHexagonWalls(10e-3, 0, 10e-3, false, &block);
    AddHexagonLid(10e-3, 0, -1, &block);
    AddHexagonWalls(kSocket, 5e-3, 10e-3, true, &block);
    AddHexagonLid(kSocket, 5e-3, 1, &block);
    const auto outer = MakeHexagon(10e-3, 10e-3);
    const auto inner = MakeHexagon(kSocket, 10e-3);
    std::vector<std::vector<Vec3>> ring;
    for (std::size_t i = 0; i < 6; ++i) {
      const std::size_t k = (i + 1) % 6;
      ring.push_back({outer[i], outer[k], inner[k], inner[i]});
    }
    block.AddTriangles(ring, Vec3::UnitZ());
    AddHexagonWalls(kBit, 0, 40e-3, false, &bit);
    AddHexagonLid(kBit, 0, -1, &bit);
    AddHexagonLid(kBit, 40e-3, 1, &bit);
    fastener = scene.Add(block.Build(), Pose());
    tool = bit.Build();
    part = bit.MakePart();
    options.mass = 7e-3;
    options.p_BoBcm_B = Vec3(0, 0, 20e-3);
    options.I_BBcm_B = Vec3(1e-6, 1e-6, 2.5e-8).asDiagonal();
    options.lead = 1e-3;
  }

  [[nodiscard]] TurnResult Turn() {
    ReachQuery query;
    query.scene = &scene;
    query.fastener = fastener;
    query.tool = tool.get();
    query.tool_part = &part;
    const FreeArc whole{0, units::kTurn, {}, {}, true, true, true};
    return TurnByContact(&scene, query, mate, Pose(), &whole, options);
  }

  PlaneBody block, bit;
  contact::Scene scene;
  contact::BodyId fastener;
  std::shared_ptr<const contact::Shape> tool;
  product::Part part;
  simulation::ToolMate mate =
      *simulation::MakeToolMate(MakeSocketDrive(kSocket), MakeBitDrive(kBit));
  TurnOptions options;
};

TEST(ToolTurnX16, TheSocketIsTurnedByItsFlatsAgainstItsFriction) {
  for (const double angle : {FromDeg(50), FromDeg(-30)}) {
    SocketRig rig;
    rig.options.angle = angle;
    const TurnResult turn = rig.Turn();
    EXPECT_TRUE(turn.is_complete);
    EXPECT_EQ(turn.strokes, 1);
    EXPECT_NEAR(turn.angle, angle, FromDeg(0.2));
    // Outwards it follows its thread; what is seated goes no further in.
    EXPECT_NEAR(turn.travel, std::max(0.0, turn.angle) / units::kTurn * 1e-3, 1e-9);
    EXPECT_NEAR(turn.peak_torque, 0.5, 0.05);
    EXPECT_LT(turn.deepest, 60e-6);
    EXPECT_FALSE(turn.is_truncated);
    EXPECT_NEAR((rig.scene.pose(rig.fastener).p() - Vec3(0, 0, turn.travel)).norm(), 0, 1e-9);
    int moving = 0;
    for (const TurnSample& sample : turn.samples) {
      if (std::abs(sample.torque) < 0.45) {
        continue;
      }
      // All that turns the fastener is what the hand feels, and comes after the play is taken up.
      ++moving;
      EXPECT_GT(sample.contact_count, 0);
      EXPECT_NEAR(sample.hand_torque, -sample.torque, 0.1);
      EXPECT_GT(std::abs(sample.tool_angle - sample.fastener_angle), 0.5 * rig.mate.play);
    }
    EXPECT_GT(moving, 20);
  }
}

TEST(ToolTurnX16, LessTorqueThanTheFrictionTurnsNothing) {
  SocketRig rig;
  rig.options.angle = FromDeg(90);
  rig.options.torque = 20;
  rig.options.coupling.k_rot = 1;
  const TurnResult turn = rig.Turn();
  EXPECT_FALSE(turn.is_complete);
  EXPECT_FALSE(turn.has_slipped);
  EXPECT_EQ(turn.angle, 0);
  EXPECT_NEAR(turn.peak_torque, 1, 0.1);  // 1 rad of the coupling.
  int light = 0;
  for (const TurnSample& sample : turn.samples) {
    if (std::abs(sample.torque) > 0.02 && std::abs(sample.torque) < 0.06) {
      ++light;
      EXPECT_NEAR(std::abs(sample.tool_angle), 0.5 * rig.mate.play, FromDeg(0.2));
    }
  }
  EXPECT_GT(light, 0);
}

TEST(ToolTurnX16, MoreTorqueThanTheFlatsBearMakesTheBitSlip) {
  SocketRig rig;
  rig.options.angle = FromDeg(90);
  rig.options.torque = 20;
  rig.options.coupling.k_rot = 6;
  const TurnResult turn = rig.Turn();
  EXPECT_FALSE(turn.is_complete);
  EXPECT_TRUE(turn.has_slipped);
  EXPECT_EQ(turn.angle, 0);
}

TEST(ToolTurnX16, EqualTurnsAreEqual) {
  const auto turn = [] {
    SocketRig rig;
    rig.options.angle = FromDeg(20);
    return rig.Turn();
  };
  const TurnResult a = turn();
  const TurnResult b = turn();
  ASSERT_EQ(a.samples.size(), b.samples.size());
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    EXPECT_EQ(a.samples[i].torque, b.samples[i].torque);
    EXPECT_EQ(a.samples[i].tool_angle, b.samples[i].tool_angle);
  }
}

/** The bit in the socket and in the hand. */
struct HandRig : haptics::testing::HeldRig {
  explicit HandRig(double torque) : HeldRig({}) {
    const contact::BodyId fastener = sockets.fastener;
    drive.body = scene.Add(sockets.block.Build(), Pose());
    EXPECT_EQ(drive.body, fastener);
    drive.p_WQ = Vec3(0, 0, 10e-3);
    drive.travel = 1e-3 / units::kTurn;
    drive.torque = torque;
    Place(sockets.tool, CalcToolPose(sockets.mate, Pose(), 0, 0));
    part.mass = sockets.options.mass;
    part.p_BoBcm_B = sockets.options.p_BoBcm_B;
    part.I_BBcm_B = sockets.options.I_BBcm_B;
    part.X_WB_goal = Pose(Vec3(1, 1, 1));
    part.lacks_partners = true;
    part.drives = {drive};
    Take();
    hand->Wait(0.1);
  }

  [[nodiscard]] double CalcAngle(const Pose& X_WB) const {
    return spatial::RotationVector(X_WB.q()).z();
  }

  SocketRig sockets;
  haptics::HeldDrive drive;
};

TEST(ToolInHandX16, TurnsAFastenerByContactAndFeelsItsFriction) {
  constexpr double kTorque = 0.2;  // [N m]
  HandRig rig(kTorque);
  rig.hand->MoveEvenly(Vec3::Zero(), 1.5, Vec3(0, 0, FromDeg(30)));
  const Pose& X_WF = rig.scene.pose(rig.drive.body);
  const double fastener = rig.CalcAngle(X_WF);
  const double tool = rig.CalcAngle(rig.hand->last().X_WD);
  EXPECT_NEAR(rig.hand->last().F_felt_W.t.z(), -kTorque, 0.1 * kTorque);
  EXPECT_NEAR(tool - fastener, 0.5 * rig.sockets.mate.play, FromDeg(0.5));
  EXPECT_NEAR(tool, FromDeg(30) - kTorque / rig.options.coupling.k_rot, FromDeg(0.5));
  EXPECT_NEAR(X_WF.p().z(), 1e-3 * fastener / units::kTurn, 1e-6);
  EXPECT_NEAR(X_WF.p().head<2>().norm(), 0, 1e-9);
  ASSERT_EQ(rig.tick->turned().size(), 1);
  EXPECT_GT(rig.tick->turned()[0].rate, 0);
}

TEST(ToolInHandX16, DoesNotTurnAFastenerThatIsTooTight) {
  HandRig rig(20);
  rig.hand->MoveEvenly(Vec3::Zero(), 1, Vec3(0, 0, FromDeg(20)));
  EXPECT_EQ(rig.CalcAngle(rig.scene.pose(rig.drive.body)), 0);
  EXPECT_LT(rig.CalcAngle(rig.hand->last().X_WD), FromDeg(4));
  EXPECT_LT(rig.hand->last().F_felt_W.t.z(), -0.3);
}

}  // namespace
}  // namespace hvas::orders
