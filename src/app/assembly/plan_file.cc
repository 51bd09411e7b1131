#include "app/assembly/plan_file.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/parse_json.h"
#include "base/regular_file.h"
#include "sequence/step_check.h"
#include "session/command_json.h"

namespace hvas::app {
namespace {

// 500 parts with ways of 1,000 poses each have a tenth of this.
constexpr std::size_t kLargestPlan = 1'000'000'000;

using sequence::SequenceStep;

/** A step without signs of zeros, which people would wonder at. */
SequenceStep WithoutSignedZeros(SequenceStep step) {
  step.extraction_W += Vec3::Zero();
  step.offset_W += Vec3::Zero();
  for (spatial::Pose& X_WB : step.way) {
    const Quat& q = X_WB.q();
    X_WB = {Quat(q.w() + 0.0, q.x() + 0.0, q.y() + 0.0, q.z() + 0.0),
            Vec3(X_WB.p() + Vec3::Zero())};
  }
  return step;
}

}  // namespace

nlohmann::ordered_json MakeFollowedPlan(const product::Product& product,
                                        const std::vector<sequence::SequenceStep>& steps) {
  nlohmann::ordered_json parts = nlohmann::ordered_json::array();
  for (const product::Occurrence& occurrence : product.occurrences) {
    parts.push_back(occurrence.path);
  }
  std::vector<SequenceStep> plain;
  std::transform(steps.begin(), steps.end(), std::back_inserter(plain), WithoutSignedZeros);
  return {{"parts", std::move(parts)}, {"steps", session::MakeStepsJson(plain)}};
}

Result<std::vector<sequence::SequenceStep>> ReadPlan(const std::filesystem::path& file,
                                                     const product::Product& product) {
  const auto text = ReadRegularFile(file, kLargestPlan);
  if (!text) {
    return Unexpected(text.error());
  }
  constexpr const char* kRemedy = "write it with hvas plan FILE -o plan.json";
  const auto json = ParseJson<nlohmann::json>(*text);
  const bool is_plan = json.is_object() && json.contains("followed") &&
                       json["followed"].is_object() && json["followed"].contains("parts") &&
                       json["followed"]["parts"].is_array() && json["followed"].contains("steps");
  if (!is_plan) {
    return Fail(ErrorCode::kUnreadable, "this is no plan of an assembly", file.string(), kRemedy);
  }
  const auto& parts = json["followed"]["parts"];
  bool is_same = parts.size() == product.occurrences.size();
  for (std::size_t i = 0; is_same && i < parts.size(); ++i) {
    is_same = parts[i].is_string() && parts[i].get<std::string>() == product.occurrences[i].path;
  }
  if (!is_same) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("the plan is of a product with other parts than {}", product.source),
                file.string(), kRemedy);
  }
  auto steps = session::ParseSteps(json["followed"]["steps"], product.occurrences.size());
  if (!steps) {
    return Fail(steps.error().code, steps.error().message, file.string(), kRemedy);
  }
  if (const auto checked = sequence::CheckSteps(*steps, parts.size()); !checked) {
    return Fail(checked.error().code, checked.error().message, file.string(), kRemedy);
  }
  return steps;
}

}  // namespace hvas::app
