#include "shopfloor/step_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "evidence/picture.h"

namespace hvas::shopfloor {
namespace {

using evidence::PictureBody;
using evidence::Projection;
using product::OccurrenceId;
using simulation::Model;
using spatial::Pose;

// Sizes [pixels]: choices. Views are chosen by small ones.
constexpr int kWidth = 720;
constexpr int kHeight = 540;
constexpr int kTrialWidth = 96;
constexpr int kTrialHeight = 72;

constexpr product::Color kComing{0.96F, 0.62F, 0.2F};  // Orange: a choice.
constexpr float kPale = 0.55F;                         // Share of light grey: a choice.
constexpr float kLightGrey = 0.82F;

product::Color Pale(const product::Color& color) {
  const auto mix = [](float channel) { return kPale * kLightGrey + (1 - kPale) * channel; };
  return {mix(color.r), mix(color.g), mix(color.b)};
}

/** The turn that brings the side that is upwards to the top of the picture, about the vertical as
 little as can be. */
Quat TurnUp(const Vec3& up_W) {
  return Quat::FromTwoVectors(up_W, Vec3::UnitZ());
}

/** Faces of what is there to which mates bring the part that comes. */
std::map<OccurrenceId, std::vector<std::uint32_t>> FindPlaces(const Model& model,
                                                              const WorkStep& step) {
  std::map<OccurrenceId, std::vector<std::uint32_t>> places;
  for (const OccurrenceId part : step.coming) {
    for (const product::MateId id : model.mates_of[part.index()]) {
      const product::Mate& mate = model.product->mates[id.index()];
      const product::Connector& other = mate.a.occurrence == part ? mate.b : mate.a;
      if (std::find(step.there.begin(), step.there.end(), other.occurrence) == step.there.end()) {
        continue;
      }
      for (const product::FaceId face : product::FacesOf(*model.product, other)) {
        places[other.occurrence].push_back(static_cast<std::uint32_t>(face.index()));
      }
    }
  }
  for (auto& [id, faces] : places) {
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  }
  return places;
}

/** The scene of a step, turned so that its upper side is upwards. */
struct StepScene {
  std::vector<PictureBody> there;
  std::vector<PictureBody> coming;

  [[nodiscard]] std::vector<PictureBody> All() const {
    std::vector<PictureBody> all = there;
    all.insert(all.end(), coming.begin(), coming.end());
    return all;
  }
};

/** Where a part of a step is drawn: before its place. */
Pose FindApart(const Model& model, const WorkStep& step, OccurrenceId id, double apart) {
  const Pose& X_WB = model.bodies[id.index()].X_WB_goal;
  if (step.way.empty()) {
    return {X_WB.q(), Vec3(X_WB.p() + apart * step.out_W)};
  }
  const Pose& leader = model.bodies[step.leading.front().index()].X_WB_goal;
  return step.way.back() * leader.Inverse() * X_WB;
}

StepScene MakeScene(const Model& model, const WorkStep& step) {
  StepScene scene;
  const Pose X_UW(TurnUp(step.up_W), Vec3::Zero());
  for (const OccurrenceId id : step.there) {
    const product::Part& part = model.product->part_of(id);
    scene.there.push_back({&part, X_UW * model.bodies[id.index()].X_WB_goal, Pale(part.color), {}});
  }
  const double apart = step.there.empty() ? 0 : CalcApart(model, step);
  for (const OccurrenceId id : step.coming) {
    scene.coming.push_back(
        {&model.product->part_of(id), X_UW * FindApart(model, step, id, apart), kComing, {}});
  }
  return scene;
}

spatial::Box BoxOf(const std::vector<PictureBody>& bodies) {
  spatial::Box box;
  for (const PictureBody& body : bodies) {
    box.Add(spatial::Transform(body.X_WB, body.part->box_B));
  }
  return box;
}

std::vector<std::uint32_t> ListFaces(const product::Part& part) {
  std::vector<std::uint32_t> faces(part.faces.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    faces[f] = f;
  }
  return faces;
}

/** The view from above that shows most of what comes and of where it goes. */
Vec3 ChooseView(const Model& model, const WorkStep& step, const StepScene& scene,
                const spatial::Box& box) {
  std::vector<PictureBody> coming_marked = scene.All();
  for (std::size_t i = scene.there.size(); i < coming_marked.size(); ++i) {
    coming_marked[i].marked_faces = ListFaces(*coming_marked[i].part);
  }
  std::vector<PictureBody> place_marked = scene.All();
  const auto places = FindPlaces(model, step);
  for (std::size_t i = 0; i < step.there.size(); ++i) {
    if (const auto found = places.find(step.there[i]); found != places.end()) {
      place_marked[i].marked_faces = found->second;
    }
  }
  const auto rate = [&](const Vec3& to_eye) {
    const Projection projection(box, kTrialWidth, kTrialHeight, to_eye);
    // Square roots, as a little of both tells more than much of one.
    return std::sqrt(evidence::RateMarks(coming_marked, projection)) +
           std::sqrt(evidence::RateMarks(place_marked, projection));
  };
  Vec3 best_view = evidence::UsualView();
  double best = rate(best_view);
  constexpr int kTurns = 8;         // Steps of 45 degrees: a choice.
  constexpr double kBetter = 1.15;  // Another view has to be worth the reader's turn: a choice.
  for (const double height : {0.45, 1.4, -0.35}) {
    for (int turn = 0; turn < kTurns; ++turn) {
      const double angle = 2 * std::numbers::pi * (turn + 0.4) / kTurns;
      const Vec3 to_eye(std::cos(angle), std::sin(angle), height);
      const double own = rate(to_eye);
      if (own > kBetter * best) {
        best = own;
        best_view = to_eye;
      }
    }
  }
  return best_view;
}

/** An arrow from one pixel to another one, or nothing where they are one. */
std::string MakeArrow(const Vec3& from, const Vec3& to) {
  const Eigen::Vector2d along = (to - from).head<2>();
  const double length = along.norm();
  constexpr double kShortest = 12;  // A shorter one cannot be told from a dot [pixels]: a choice.
  if (length < kShortest) {
    return {};
  }
  constexpr double kHead = 14;  // [pixels], a choice.
  const Eigen::Vector2d tip = to.head<2>();
  const Eigen::Vector2d unit = along / length;
  const Eigen::Vector2d side(-unit.y(), unit.x());
  const Eigen::Vector2d neck = tip - kHead * unit;
  const Eigen::Vector2d left = neck + 0.5 * kHead * side;
  const Eigen::Vector2d right = neck - 0.5 * kHead * side;
  return fmt::format(
      "<path class=\"way\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>"
      "<path class=\"head\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z\"/>",
      from.x(), from.y(), neck.x(), neck.y(), tip.x(), tip.y(), left.x(), left.y(), right.x(),
      right.y());
}

/** The arrows of a step: one of each part that leads. */
std::string MakeArrows(const Model& model, const WorkStep& step, const Projection& projection) {
  if (step.there.empty()) {
    return {};
  }
  const Pose X_UW(TurnUp(step.up_W), Vec3::Zero());
  const double apart = CalcApart(model, step);
  std::string arrows;
  for (const OccurrenceId id : step.leading) {
    const Vec3 centre_B = model.product->part_of(id).box_B.centre();
    const Vec3 from = X_UW * FindApart(model, step, id, apart) * centre_B;
    const Vec3 to = X_UW * model.bodies[id.index()].X_WB_goal * centre_B;
    arrows += MakeArrow(projection.Project(from), projection.Project(to));
  }
  return arrows;
}

}  // namespace

double CalcApart(const Model& model, const WorkStep& step) {
  // Beyond where nothing is engaged, by a share of the part's size: choices.
  constexpr double kBeyond = 0.25;
  constexpr double kEngaged = 1.05;
  double size = 0;
  for (const OccurrenceId id : step.leading) {
    const spatial::Box box =
        spatial::Transform(model.bodies[id.index()].X_WB_goal, model.product->part_of(id).box_B);
    size = std::max(size, box.size().norm());
  }
  return kEngaged * step.engaged + kBeyond * size;
}

StepPicture DrawStep(const Model& model, const WorkStep& step) {
  const StepScene scene = MakeScene(model, step);
  const std::vector<PictureBody> all = scene.All();
  if (all.empty()) {
    return {};
  }
  // The place is in the picture, too, where the part is drawn far before it.
  const spatial::Box box = BoxOf(all);
  const Vec3 view =
      step.there.empty() ? evidence::UsualView() : ChooseView(model, step, scene, box);
  const Projection projection(box, kWidth, kHeight, view);
  return {evidence::MakePicture(all, projection), MakeArrows(model, step, projection), kWidth,
          kHeight};
}

}  // namespace hvas::shopfloor
