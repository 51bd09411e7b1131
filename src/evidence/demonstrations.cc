#include "evidence/demonstrations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evidence/hdf5_writer.h"
#include "evidence/output_file.h"
#include "evidence/session_data.h"
#include "haptics/constraint_solver.h"
#include "haptics/tick_output.h"
#include "paths/path.h"
#include "sequence/sequence.h"
#include "session/recorded_model.h"

namespace hvas::evidence {
namespace {

using sequence::SequenceStep;

constexpr double kPlannedSpeed = 0.04;      // [m/s], as the simulated person inserts.
constexpr double kPlannedApproach = 20e-3;  // [m] before the place where it engages: a choice.
// State of ticks (haptics::HoldState).
constexpr std::uint8_t kSeated = static_cast<std::uint8_t>(haptics::HoldState::kSeated);

/** Gathers holds, hand by hand. */
class HoldGatherer {
 public:
  HoldGatherer(const product::Product& product, std::vector<Demonstration>* found)
      : product_(product), found_(*found) {}

  void Add(const record::TickRecord& tick) {
    Open& open = open_[HandOf(tick)];
    if (open.occurrence != tick.held) {
      Close(&open);
      open.occurrence = tick.held;
    }
    if (tick.held >= product_.occurrences.size()) {
      return;
    }
    open.demonstration.is_seated = open.demonstration.is_seated || tick.state == kSeated;
    open.demonstration.samples.push_back(
        {1e-9 * static_cast<double>(tick.t_ns), tick.X_WD, tick.X_WH, tick.F_felt_W, tick.depth});
  }

  void Finish() {
    for (Open& open : open_) {
      Close(&open);
    }
  }

 private:
  struct Open {
    std::uint32_t occurrence{record::kNoOccurrence};
    Demonstration demonstration;
  };

  void Close(Open* open) {
    Demonstration& demonstration = open->demonstration;
    if (demonstration.samples.size() > 1) {
      const product::Occurrence& occurrence = product_.occurrences[open->occurrence];
      demonstration.part = occurrence.path;
      demonstration.source = "record";
      demonstration.X_WB_goal = occurrence.X_WB;
      found_.push_back(std::move(demonstration));
    }
    *open = {};
  }

  const product::Product& product_;
  std::vector<Demonstration>& found_;
  std::array<Open, haptics::kMaxHands> open_;
};

/** Poses of a part from outside to its place. */
paths::Path MakeWayIn(const SequenceStep& step, const spatial::Pose& X_WB_goal) {
  paths::Path way = step.way;
  if (way.empty()) {
    const auto at = [&](double travel) {
      return spatial::Pose(X_WB_goal.q(), X_WB_goal.p() + travel * step.extraction_W);
    };
    way = {at(0), at(step.engage_distance + kPlannedApproach)};
  }
  std::reverse(way.begin(), way.end());
  return way;
}

/** Numbers of a row by the name of their set. */
struct Set {
  const char* name;
  hsize_t width;
  void (*append)(const Demonstration&, std::size_t, std::vector<double>*);
};

void Append(const Vec3& v, std::vector<double>* row) {
  row->insert(row->end(), {v.x(), v.y(), v.z()});
}

void Append(const Quat& q, std::vector<double>* row) {
  row->insert(row->end(), {q.w(), q.x(), q.y(), q.z()});
}

constexpr std::array<Set, 7> kObservations{{
    {"part_pos", 3,
     [](const Demonstration& d, std::size_t i, std::vector<double>* row) {
       Append(d.samples[i].X_WB.p(), row);
     }},
    {"part_quat", 4,
     [](const Demonstration& d, std::size_t i, std::vector<double>* row) {
       Append(d.samples[i].X_WB.q(), row);
     }},
    {"part_to_goal", 6,
     [](const Demonstration& d, std::size_t i, std::vector<double>* row) {
       const spatial::Pose& X_WB = d.samples[i].X_WB;
       Append(Vec3(d.X_WB_goal.p() - X_WB.p()), row);
       Append(spatial::RotationBetween(X_WB.q(), d.X_WB_goal.q()), row);
     }},
    {"hand_pos", 3,
     [](const Demonstration& d, std::size_t i, std::vector<double>* row) {
       Append(d.samples[i].X_WH.p(), row);
     }},
    {"hand_quat", 4,
     [](const Demonstration& d, std::size_t i, std::vector<double>* row) {
       Append(d.samples[i].X_WH.q(), row);
     }},
    {"felt_wrench", 6,
     [](const Demonstration& d, std::size_t i, std::vector<double>* row) {
       Append(d.samples[i].F_felt_W.f, row);
       Append(d.samples[i].F_felt_W.t, row);
     }},
    {"insertion", 1,
     [](const Demonstration& d, std::size_t i, std::vector<double>* row) {
       row->push_back(d.samples[i].insertion);
     }},
}};

// The last action of an episode moves nothing and lets go.
constexpr std::array<Set, 3> kSteps{{
    {"actions", 7,
     [](const Demonstration& d, std::size_t i, std::vector<double>* row) {
       const spatial::Pose& X_WH = d.samples[i].X_WH;
       const bool is_last = i + 1 == d.samples.size();
       const spatial::Pose& X_next = is_last ? X_WH : d.samples[i + 1].X_WH;
       Append(Vec3(X_next.p() - X_WH.p()), row);
       Append(spatial::RotationBetween(X_WH.q(), X_next.q()), row);
       row->push_back(is_last ? -1 : 1);
     }},
    {"rewards", 1,
     [](const Demonstration& d, std::size_t i, std::vector<double>* row) {
       row->push_back(d.is_seated && i + 1 == d.samples.size() ? 1 : 0);
     }},
    {"dones", 1,
     [](const Demonstration& d, std::size_t i, std::vector<double>* row) {
       row->push_back(i + 1 == d.samples.size() ? 1 : 0);
     }},
}};

template <std::size_t count>
void WriteSets(const std::array<Set, count>& sets, const Demonstration& demonstration, hid_t group,
               Hdf5Writer* writer) {
  for (const Set& set : sets) {
    std::vector<double> rows;
    for (std::size_t i = 0; i < demonstration.samples.size(); ++i) {
      set.append(demonstration, i, &rows);
    }
    const Hdf5Handle data = writer->MakeSet(group, set.name, set.width);
    writer->Append(data.id(), 0, rows, set.width);
  }
}

}  // namespace

Result<std::vector<Demonstration>> ListDemonstrations(record::Reader* reader,
                                                      const Selection& selection) {
  const auto product = session::LoadProduct(reader);
  if (!product) {
    return Unexpected(product.error());
  }
  std::vector<Demonstration> found;
  HoldGatherer gatherer(*product, &found);
  const auto done = ForEachSelected(reader, selection,
                                    [&](const record::TickRecord& tick) { gatherer.Add(tick); });
  if (!done) {
    return Unexpected(done.error());
  }
  gatherer.Finish();
  return found;
}

std::vector<Demonstration> ListPlannedWays(const simulation::Model& model, double rate) {
  std::vector<Demonstration> found;
  for (const SequenceStep& step : model.sequence.steps) {
    if (step.kind != SequenceStep::Kind::kInsert) {
      continue;
    }
    const simulation::Body& body = model.bodies[step.occurrence.index()];
    Demonstration demonstration;
    demonstration.part = model.product->occurrences[step.occurrence.index()].path;
    demonstration.source = "plan";
    demonstration.X_WB_goal = sequence::GoalOf(step, body.X_WB_goal);
    demonstration.is_seated = true;
    const paths::Path way = paths::Resample(MakeWayIn(step, demonstration.X_WB_goal),
                                            body.shape->box_B(), kPlannedSpeed / rate);
    const Vec3 p_BCm = simulation::CombineMass(model, step).p_BoBcm_B;
    for (const spatial::Pose& X_WB : way) {
      const double t = static_cast<double>(demonstration.samples.size()) / rate;
      demonstration.samples.push_back({t, X_WB, {X_WB.q(), X_WB * p_BCm}, {}, 0});
    }
    if (demonstration.samples.size() > 1) {
      found.push_back(std::move(demonstration));
    }
  }
  return found;
}

Result<void> WriteDemonstrations(const std::vector<Demonstration>& demonstrations,
                                 const std::string& environment,
                                 const std::filesystem::path& file) {
  if (demonstrations.empty()) {
    return Fail(ErrorCode::kInvalid, "there is no demonstration to write", file.string(),
                "take a record in which a part was in a hand");
  }
  if (file.extension() == ".mcap") {
    return WriteMcap(demonstrations, file);
  }
  auto output = OutputFile::Create(file);
  if (!output) {
    return Unexpected(output.error());
  }
  {
    Hdf5Writer writer(output->working_path());
    const Hdf5Handle data = writer.MakeGroup(writer.root(), "data");
    constexpr int kGymType = 2;  // EnvType.GYM_TYPE of robomimic.
    const nlohmann::json arguments{
        {"env_name", environment}, {"type", kGymType}, {"env_kwargs", nlohmann::json::object()}};
    writer.Describe(data.id(), "env_args", arguments.dump());
    std::int64_t total = 0;
    std::vector<std::string> seated;
    for (std::size_t i = 0; i < demonstrations.size(); ++i) {
      const Demonstration& demonstration = demonstrations[i];
      const std::string name = fmt::format("demo_{}", i);
      const Hdf5Handle group = writer.MakeGroup(data.id(), name.c_str());
      const auto count = static_cast<std::int64_t>(demonstration.samples.size());
      writer.Describe(group.id(), "num_samples", count);
      writer.Describe(group.id(), "part", demonstration.part);
      writer.Describe(group.id(), "source", demonstration.source);
      WriteSets(kSteps, demonstration, group.id(), &writer);
      const Hdf5Handle observations = writer.MakeGroup(group.id(), "obs");
      WriteSets(kObservations, demonstration, observations.id(), &writer);
      total += count;
      if (demonstration.is_seated) {
        seated.push_back(name);
      }
    }
    writer.Describe(data.id(), "total", total);
    const Hdf5Handle mask = writer.MakeGroup(writer.root(), "mask");
    writer.WriteTexts(mask.id(), "seated", seated);
    if (!writer.Flush()) {
      return Fail(ErrorCode::kOutOfResource, "the file could not be written completely",
                  file.string(), "free disk space, or choose another folder");
    }
  }
  return output->Finish();
}

}  // namespace hvas::evidence
