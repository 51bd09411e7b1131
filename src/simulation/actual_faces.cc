#include "simulation/actual_faces.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace hvas::simulation {
namespace {

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

bool Moves(const SequenceStep& step, OccurrenceId id) {
  return step.occurrence == id ||
         std::find(step.members.begin(), step.members.end(), id) != step.members.end();
}

/** True where the shaft comes in from the end of larger z: the side on which it lies before. */
bool IsMouthHigh(const ActualFacesInput& input, const Mate& mate) {
  const product::Occurrence& hole = input.product->occurrences[mate.a.occurrence.index()];
  const Vec3 z_W = (hole.X_WB * mate.a.X_BM).q() * Vec3::UnitZ();
  // The last move of one without the other joins them; after it they move together.
  const auto& steps = input.sequence->steps;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    const bool moves_hole = Moves(*step, mate.a.occurrence);
    if (step->kind == SequenceStep::Kind::kInsert &&
        moves_hole != Moves(*step, mate.b.occurrence)) {
      return (step->extraction_W.dot(z_W) > 0) != moves_hole;
    }
  }
  return true;
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

  [[nodiscard]] bool IsFree(const product::Feature& feature) const {
    return std::none_of(feature.faces.begin(), feature.faces.end(),
                        [this](product::FaceId f) { return is_given[f.index()]; });
  }
};

/** Gives the faces of a hole or shaft a profile over z of its connector. */
void Give(const product::Part& part, const product::Connector& connector, const Overlap& overlap,
          const std::vector<double>& stations, PartFaces* faces) {
  const Vec3 z_B = connector.X_BM.q() * Vec3::UnitZ();
  for (const product::FaceId id : part.features[connector.feature.index()].faces) {
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
  const auto clearances = fit.clearances();
  return std::all_of(clearances.begin(), clearances.end(), [](double s) { return s > 0; });
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
      const product::Part& part = input_.product->part_of(connector->occurrence);
      for (const product::FaceId id : part.features[connector->feature.index()].faces) {
        faces_[connector->occurrence.index()].is_given[id.index()] = true;
      }
    }
  }

  void Add(const Mate& mate, const fits::FitForce& fit, Diagnostics* diagnostics) {
    const product::Part& hub = input_.product->part_of(mate.a.occurrence);
    const product::Part& shaft = input_.product->part_of(mate.b.occurrence);
    PartFaces& hole_faces = faces_[mate.a.occurrence.index()];
    PartFaces& shaft_faces = faces_[mate.b.occurrence.index()];
    const product::Feature& bore = hub.features[mate.a.feature.index()];
    const product::Feature& side = shaft.features[mate.b.feature.index()];
    const Overlap overlap = FindOverlap(*input_.product, mate);
    if (!(overlap.high > overlap.low) || !hole_faces.IsFree(bore)) {
      return;
    }
    const bool is_new = shaft_faces.IsFree(side);
    const double offset = is_new ? 0.5 * fit.shaft_diameter() - mate.shaft_radius
                                 : shaft_faces.offsets[side.faces.front().index()].uniform;
    const std::vector<double> stations = HoleStations(mate, fit, offset, IsMouthHigh(input_, mate));
    if (IsTooLarge({offset}) || IsTooLarge(stations)) {
      diagnostics->Warn("fit-far-from-drawing", fmt::format("mate m{}", mate.id.value()),
                        "its actual sizes are more than 0.25 mm from the drawn radii",
                        "contact takes these faces as drawn; draw them nearer to their size");
      return;
    }
    Give(hub, mate.a, overlap, stations, &hole_faces);
    if (is_new) {
      Give(shaft, mate.b, overlap, {offset}, &shaft_faces);
    }
  }

  void Relieve(const FaceRelief& relief) {
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
  const ActualFacesInput& input_;
  std::vector<PartFaces> faces_;
};

}  // namespace

std::vector<std::shared_ptr<const contact::FaceOffsets>> MakeActualFaces(
    const ActualFacesInput& input, Diagnostics* diagnostics) {
  Collector collector(input);
  std::vector<const Mate*> sized;
  for (const Mate& mate : input.product->mates) {
    const auto& fit = input.fits[mate.id.index()];
    if (mate.kind != product::MateKind::kAxisHole) {
      continue;
    }
    if (fit != nullptr && LeavesRoom(*fit)) {
      sized.push_back(&mate);
    } else {
      collector.KeepAsDrawn(mate);
    }
  }
  for (const Mate* mate : sized) {
    collector.Add(*mate, *input.fits[mate->id.index()], diagnostics);
  }
  for (const FaceRelief& relief : input.sequence->reliefs) {
    collector.Relieve(relief);
  }
  return collector.Make(diagnostics);
}

}  // namespace hvas::simulation
