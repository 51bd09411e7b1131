#include "simulation/actual_faces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "mates/mate_kind.h"
#include "mates/prismatic_fits.h"
#include "sequence/mate_way.h"
#include "simulation/model.h"

namespace hvas::simulation {
namespace {

// [m] at each wall, or of radius, where the fit leaves no play and answers for the force: contact
// just lets the inner part pass. Half of what faces that give way leave.
constexpr double kRoom = 5e-6;

using product::Mate;
using product::OccurrenceId;

/** Where shaft and hole share their axis, along the hole connector's z [m]. */
struct Overlap {
  double low{0};
  double high{0};
};

Overlap FindOverlap(const product::Product& product, const Mate& mate) {
  const auto placed = [&](const product::Connector& c) {
    return product.occurrences[c.occurrence.index()].X_WB * c.X_BM;
  };
  const spatial::Pose X_WM = placed(mate.a);
  const double along = (X_WM.q() * Vec3::UnitZ()).dot(placed(mate.b).p() - X_WM.p());
  return {std::max(mate.hole_low, along + mate.shaft_low),
          std::min(mate.hole_high, along + mate.shaft_high)};
}

/** True where the shaft comes in from the end of larger z: the side on which it lies before. */
bool IsMouthHigh(const ActualFacesInput& input, const Mate& mate) {
  const product::Occurrence& hole = input.product->occurrences[mate.a.occurrence.index()];
  const Vec3 z_W = (hole.X_WB * mate.a.X_BM).q() * Vec3::UnitZ();
  const Vec3 way_W = sequence::FindWayOut(*input.sequence, mate);
  return way_W.isZero() || way_W.dot(z_W) > 0;
}

/** The least of S over the length of a fit [m]. */
double LeastClearance(const fits::FitForce& fit) {
  const auto clearances = fit.clearances();
  return *std::min_element(clearances.begin(), clearances.end());
}

/** The offsets of a slot's first wall and of the opposite one, for a tongue that is `tongue` larger
 on each side and lies where it is drawn. Walls are planes: the least clearance counts for all of
 their length. Where the fit leaves none and answers for the force, contact just lets the tongue
 pass. */
std::array<double, 2> SlotOffsets(const ActualFacesInput& input, const Mate& mate,
                                  const fits::FitForce* fit, double tongue) {
  const double drawn_gap = mate.hole_radius - mate.shaft_radius;
  const double room = fit != nullptr ? LeastClearance(*fit) : drawn_gap;
  const double play = fit == nullptr || input.fits_answer ? std::max(kRoom, room) : room;
  const double drawn_shift = mates::CalcDrawnShift(*input.product, mate);
  // The tongue stays within its play where it is drawn beside it, as in the tick's guidance.
  const double most = std::max(0.0, play);
  const double excess = drawn_shift - std::clamp(drawn_shift, -most, most);
  return {drawn_gap + excess - tongue - play, drawn_gap - excess - tongue - play};
}

/** Cosine of the angle between across and the normals of the walls: that of a dovetail's flanks,
 else one. Offsets are along the normals, sizes across. */
double FlankCosine(const product::Product& product, const product::Connector& side) {
  const product::Feature& wall = product.part_of(side.occurrence).features[side.feature.index()];
  return std::abs(wall.axis_B.dot(side.X_BM.q() * Vec3::UnitZ()));
}

/** The hole's offsets at equal steps of z over the overlap, for a shaft that is `shaft` larger. */
std::vector<double> HoleStations(const Mate& mate, const fits::FitForce& fit, double shaft,
                                 bool is_mouth_high) {
  const double drawn_gap = mate.hole_radius - mate.shaft_radius;
  std::vector<double> stations;
  for (const double clearance : fit.clearances()) {
    stations.push_back(drawn_gap - shaft - clearance);
  }
  if (is_mouth_high) {
    std::reverse(stations.begin(), stations.end());
  }
  return stations;
}

/** The offsets of one part's faces while they are collected. */
struct PartFaces {
  std::vector<contact::FaceOffset> offsets;
  std::vector<bool> is_given;

  [[nodiscard]] bool IsFree(const std::vector<product::FaceId>& faces) const {
    return std::none_of(faces.begin(), faces.end(),
                        [this](product::FaceId f) { return is_given[f.index()]; });
  }
};

/** Gives faces of one side of a mate an offset, or a hole or shaft a profile over z. */
void Give(const product::Part& part, const product::Connector& connector,
          const std::vector<product::FaceId>& given, const Overlap& overlap,
          const std::vector<double>& stations, PartFaces* faces) {
  const Vec3 z_B = connector.X_BM.q() * Vec3::UnitZ();
  for (const product::FaceId id : given) {
    const spatial::Surface& surface = part.faces[id.index()].surface;
    contact::FaceOffset& offset = faces->offsets[id.index()];
    faces->is_given[id.index()] = true;
    if (stations.size() == 1) {
      offset.uniform = stations.front();
      continue;
    }
    const auto height = [&](double z) {
      return (connector.X_BM.p() + z * z_B - surface.origin).dot(surface.axis);
    };
    offset.stations = stations;
    offset.begin = height(overlap.low);
    offset.end = height(overlap.high);
    if (offset.begin > offset.end) {
      std::swap(offset.begin, offset.end);
      std::reverse(offset.stations.begin(), offset.stations.end());
    }
  }
}

bool IsTooLarge(const std::vector<double>& stations) {
  return std::any_of(stations.begin(), stations.end(),
                     [](double v) { return !(std::abs(v) <= contact::FaceOffsets::kLargest); });
}

bool LeavesRoom(const fits::FitForce& fit) {
  return LeastClearance(fit) > 0;
}

class Collector {
 public:
  explicit Collector(const ActualFacesInput& input) : input_(input) {
    for (const product::Occurrence& occurrence : input.product->occurrences) {
      const std::size_t count = input.product->part_of(occurrence.id).faces.size();
      faces_.push_back({std::vector<contact::FaceOffset>(count), std::vector<bool>(count, false)});
    }
  }

  /** The faces of a mate that contact does not answer for by its sizes: a thread, an interference,
   a mate without a fit. Another mate must not make them larger than they are drawn. */
  void KeepAsDrawn(const Mate& mate) {
    for (const product::Connector* connector : {&mate.a, &mate.b}) {
      for (const product::FaceId id : FacesOf(*input_.product, *connector)) {
        faces_[connector->occurrence.index()].is_given[id.index()] = true;
      }
    }
  }

  /** Widens a hole that is drawn narrower than the shaft that is pressed into it, so that the end
   of the shaft passes its mouth: the fit answers for the force. */
  void LetPass(const Mate& mate) {
    const double narrower = mate.shaft_radius - mate.hole_radius;
    if (narrower <= 0 || narrower + kRoom > contact::FaceOffsets::kLargest) {
      return;
    }
    for (const product::FaceId id : FacesOf(*input_.product, mate.a)) {
      contact::FaceOffset& offset = faces_[mate.a.occurrence.index()].offsets[id.index()];
      offset.uniform = std::min(offset.uniform, -narrower - kRoom);
    }
  }

  void Add(const Mate& mate, const fits::FitForce& fit, Diagnostics* diagnostics) {
    const product::Product& product = *input_.product;
    PartFaces& hole_faces = faces_[mate.a.occurrence.index()];
    const std::vector<product::FaceId> bore = FacesOf(product, mate.a);
    const std::vector<product::FaceId> side = FacesOf(product, mate.b);
    const Overlap overlap = FindOverlap(product, mate);
    if (!(overlap.high > overlap.low) || !hole_faces.IsFree(bore)) {
      return;
    }
    const double offset = ShaftOffset(mate, &fit, 1);
    const std::vector<double> stations = HoleStations(mate, fit, offset, IsMouthHigh(input_, mate));
    if (IsTooLarge({offset}) || IsTooLarge(stations)) {
      WarnTooLarge(mate, diagnostics);
      return;
    }
    Give(product.part_of(mate.a.occurrence), mate.a, bore, overlap, stations, &hole_faces);
    GiveShaft(mate, offset);
  }

  /** @param fit  Null where the mate has none. */
  void AddPrismatic(const Mate& mate, const fits::FitForce* fit, Diagnostics* diagnostics) {
    const product::Product& product = *input_.product;
    PartFaces& slot_faces = faces_[mate.a.occurrence.index()];
    if (!slot_faces.IsFree(FacesOf(product, mate.a))) {
      return;
    }
    const double cosine = FlankCosine(product, mate.a);
    const double offset = ShaftOffset(mate, fit, cosine);
    auto [low, high] = SlotOffsets(input_, mate, fit, offset / cosine);
    low *= cosine;
    high *= cosine;
    if (IsTooLarge({offset, low, high})) {
      WarnTooLarge(mate, diagnostics);
      return;
    }
    const product::Part& part = product.part_of(mate.a.occurrence);
    const std::vector<product::Feature>& features = part.features;
    Give(part, mate.a, features[mate.a.feature.index()].faces, {}, {low}, &slot_faces);
    Give(part, mate.a, features[mate.a.opposite.index()].faces, {}, {high}, &slot_faces);
    GiveShaft(mate, offset);
  }

  void Relieve(const sequence::FaceRelief& relief) {
    contact::FaceOffset& offset = faces_[relief.occurrence.index()].offsets[relief.face];
    const auto lower = [&relief](double value) {
      return std::max(-contact::FaceOffsets::kLargest, value - relief.depth);
    };
    offset.uniform = offset.stations.empty() ? lower(offset.uniform) : offset.uniform;
    for (double& station : offset.stations) {
      station = lower(station);
    }
  }

  [[nodiscard]] std::vector<std::shared_ptr<const contact::FaceOffsets>> Make(
      Diagnostics* diagnostics) const {
    std::vector<std::shared_ptr<const contact::FaceOffsets>> made(faces_.size());
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const std::vector<contact::FaceOffset>& wanted = faces_[i].offsets;
      if (std::all_of(wanted.begin(), wanted.end(), [](const contact::FaceOffset& offset) {
            return offset.uniform == 0 && offset.stations.empty();
          })) {
        continue;
      }
      const auto offsets = contact::FaceOffsets::Make(input_.shapes[i], wanted);
      if (offsets) {
        made[i] = *offsets;
      } else {
        diagnostics->Warn("face-offset", input_.product->occurrences[i].path,
                          offsets.error().message, "contact takes this part as drawn");
      }
    }
    return made;
  }

 private:
  /** How far the shaft's or tongue's faces move: to their size, or as an earlier mate has moved
   * them.
   */
  [[nodiscard]] double ShaftOffset(const Mate& mate, const fits::FitForce* fit,
                                   double cosine) const {
    const PartFaces& faces = faces_[mate.b.occurrence.index()];
    const std::vector<product::FaceId> side = FacesOf(*input_.product, mate.b);
    if (!faces.IsFree(side)) {
      return faces.offsets[side.front().index()].uniform;
    }
    return fit != nullptr ? cosine * (0.5 * fit->shaft_diameter() - mate.shaft_radius) : 0.0;
  }

  void GiveShaft(const Mate& mate, double offset) {
    PartFaces& faces = faces_[mate.b.occurrence.index()];
    const std::vector<product::FaceId> side = FacesOf(*input_.product, mate.b);
    if (faces.IsFree(side)) {
      Give(input_.product->part_of(mate.b.occurrence), mate.b, side, {}, {offset}, &faces);
    }
  }

  static void WarnTooLarge(const Mate& mate, Diagnostics* diagnostics) {
    diagnostics->Warn("fit-far-from-drawing", fmt::format("mate m{}", mate.id.value()),
                      "its actual sizes are more than 0.25 mm from the drawn radii",
                      "contact takes these faces as drawn; draw them nearer to their size");
  }

  const ActualFacesInput& input_;
  std::vector<PartFaces> faces_;
};

}  // namespace

ActualFacesInput MakeActualFacesInput(const Model& model) {
  ActualFacesInput input;
  input.product = model.product.get();
  input.sequence = &model.sequence;
  for (const Body& body : model.bodies) {
    input.shapes.push_back(body.shape);
  }
  for (const ModelMate& mate : model.mates) {
    input.fits.push_back(mate.fit);
  }
  return input;
}

std::vector<std::shared_ptr<const contact::FaceOffsets>> MakeActualFaces(
    const ActualFacesInput& input, Diagnostics* diagnostics) {
  Collector collector(input);
  std::vector<const Mate*> sized;
  for (const Mate& mate : input.product->mates) {
    const auto& fit = input.fits[mate.id.index()];
    if (!mates::HasFit(mate.kind)) {
      continue;
    }
    if (mate.kind == product::MateKind::kPrismatic ||
        (fit != nullptr && (LeavesRoom(*fit) || !input.fits_answer))) {
      sized.push_back(&mate);
    } else {
      collector.KeepAsDrawn(mate);
      if (fit != nullptr) {
        collector.LetPass(mate);
      }
    }
  }
  for (const Mate* mate : sized) {
    const fits::FitForce* fit = input.fits[mate->id.index()].get();
    if (mate->kind == product::MateKind::kPrismatic) {
      collector.AddPrismatic(*mate, fit, diagnostics);
    } else {
      collector.Add(*mate, *fit, diagnostics);
    }
  }
  for (const sequence::FaceRelief& relief : input.sequence->reliefs) {
    collector.Relieve(relief);
  }
  return collector.Make(diagnostics);
}

}  // namespace hvas::simulation
