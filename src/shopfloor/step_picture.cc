#include "shopfloor/step_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "base/parallel.h"
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
constexpr float kLightGrey = 0.82F;  // What pale colours are mixed with: a choice.

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

/** How far each part is deformed in a step: springs that nothing presses yet are longer than drawn.
 */
std::vector<double> CalcStepDeformations(const Model& model, const WorkStep& step, double apart) {
  std::vector<Pose> X_WB;
  for (const simulation::Body& body : model.bodies) {
    X_WB.push_back(body.X_WB_goal);
  }
  std::vector<bool> present(model.bodies.size(), false);
  for (const OccurrenceId id : step.there) {
    present[id.index()] = true;
  }
  for (const OccurrenceId id : step.coming) {
    present[id.index()] = true;
    X_WB[id.index()] = FindApart(model, step, id, apart);
  }
  return simulation::CalcDeformations(*model.product, model.deformables, X_WB, &present);
}

StepScene MakeScene(const Model& model, const WorkStep& step) {
  StepScene scene;
  const Pose X_UW(TurnUp(step.up_W), Vec3::Zero());
  const double apart = step.there.empty() ? 0 : CalcApart(model, step);
  const std::vector<double> amounts = CalcStepDeformations(model, step, apart);
  const auto map = [&](OccurrenceId id) {
    return simulation::MakePointMap(model.deformables, amounts, id);
  };
  for (const OccurrenceId id : step.there) {
    const product::Part& part = model.product->part_of(id);
    scene.there.push_back({&part, X_UW * model.bodies[id.index()].X_WB_goal, Pale(part.color), {}});
    scene.there.back().deform = map(id);
  }
  for (const OccurrenceId id : step.coming) {
    scene.coming.push_back(
        {&model.product->part_of(id), X_UW * FindApart(model, step, id, apart), kComing, {}});
    scene.coming.back().deform = map(id);
  }
  return scene;
}

std::vector<std::uint32_t> ListFaces(const product::Part& part) {
  std::vector<std::uint32_t> faces(part.faces.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    faces[f] = f;
  }
  return faces;
}

/** What is in the picture: all that is there, or where the part is small against it, the part and
 its place with what is around them. */
spatial::Box ChooseFrame(const Model& model, const WorkStep& step, const StepScene& scene) {
  const spatial::Box all = evidence::BoxAround(scene.All());
  spatial::Box focus = evidence::BoxAround(scene.coming);
  const Pose X_UW(TurnUp(step.up_W), Vec3::Zero());
  for (const OccurrenceId id : step.coming) {
    focus.Add(spatial::Transform(X_UW * model.bodies[id.index()].X_WB_goal,
                                 model.product->part_of(id).box_B));
  }
  // Shares of the picture: choices, tried on the gear pump and a follower arm.
  constexpr double kLeastShare = 0.65;
  const double wanted = kLeastShare * all.size().norm();
  const double grow = 0.5 * std::max(0.0, wanted - focus.size().norm()) / std::sqrt(3.0);
  spatial::Box frame;
  frame.Add(Vec3((focus.low - Vec3::Constant(grow)).cwiseMax(all.low)));
  frame.Add(Vec3((focus.high + Vec3::Constant(grow)).cwiseMin(all.high)));
  return frame;
}

/** Says of views how much they show of what comes and of where it goes. */
class ViewRating {
 public:
  ViewRating(const Model& model, const WorkStep& step, const StepScene& scene,
             const spatial::Box& frame)
      : frame_(frame), marked_(scene.All()) {
    const auto places = FindPlaces(model, step);
    for (std::size_t i = 0; i < marked_.size(); ++i) {
      const bool is_there = i < scene.there.size();
      marked_[i].mark_group = is_there ? kPlace : kPart;
      if (!is_there) {
        marked_[i].marked_faces = ListFaces(*marked_[i].part);
      } else if (const auto found = places.find(step.there[i]); found != places.end()) {
        marked_[i].marked_faces = found->second;
      }
    }
  }

  [[nodiscard]] double Rate(const Vec3& to_eye) const {
    const auto rates =
        evidence::RateMarks(marked_, Projection(frame_, kTrialWidth, kTrialHeight, to_eye));
    // Square roots, as a little of both tells more than much of one.
    return std::sqrt(rates[kPart]) + std::sqrt(rates[kPlace]);
  }

 private:
  enum MarkGroup : std::size_t { kPart, kPlace };

  spatial::Box frame_;
  std::vector<PictureBody> marked_;
};

/** The view from above that shows most; the last one, or the usual one, where it is nearly as good.
 */
Vec3 ChooseView(const ViewRating& rating, const Vec3& last_to_eye) {
  constexpr int kTurns = 8;        // Steps of 45 degrees: a choice.
  constexpr double kBetter = 1.3;  // Another view has to be worth the reader's turn: a choice.
  std::vector<Vec3> views{last_to_eye.isZero() ? evidence::UsualView() : last_to_eye};
  for (int turn = 0; turn < kTurns; ++turn) {
    const double angle = 2 * std::numbers::pi * (turn + 0.4) / kTurns;
    const double height = turn % 2 == 0 ? 0.5 : 1.2;
    views.emplace_back(std::cos(angle), std::sin(angle), height);
  }
  std::vector<double> rates(views.size());
  ForEachIndex(views.size(), 0, [&](std::size_t i) { rates[i] = rating.Rate(views[i]); });
  const auto best = std::max_element(rates.begin(), rates.end()) - rates.begin();
  return rates[static_cast<std::size_t>(best)] > kBetter * rates.front()
             ? views[static_cast<std::size_t>(best)]
             : views.front();
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

StepPicture DrawStep(const Model& model, const WorkStep& step, const Vec3& last_to_eye) {
  const StepScene scene = MakeScene(model, step);
  const std::vector<PictureBody> all = scene.All();
  if (all.empty()) {
    return {};
  }
  const spatial::Box frame = ChooseFrame(model, step, scene);
  const Vec3 view = step.there.empty()
                        ? evidence::UsualView()
                        : ChooseView(ViewRating(model, step, scene, frame), last_to_eye);
  const Projection projection(frame, kWidth, kHeight, view);
  return {evidence::MakePicture(all, projection), MakeArrows(model, step, projection), kWidth,
          kHeight, view};
}

}  // namespace hvas::shopfloor
