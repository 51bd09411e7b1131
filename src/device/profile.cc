#include "device/profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/parse_json.h"
#include "device/known_profiles.h"

namespace hvas::device {
namespace {

using nlohmann::json;

// The version of profiles that is read (data/schemas/device_profile.schema.json).
constexpr int kSchema = 1;

/** A figure of a profile, and what it can be. */
struct Figure {
  const char* key;
  double DeviceProfile::*member;
  double least;  ///< 0 is allowed besides where `may_be_zero`.
  double most;
  bool may_be_zero;
};

// Between what is too little to be felt or sensed and some times what the strongest, largest and
// fastest haptic devices have (250 N, 3 m, 20 kHz): beyond that, a figure is a mistake. Choices.
constexpr std::array kFigures{
    Figure{"max_force_n", &DeviceProfile::max_force, 0.01, 1000, true},
    Figure{"continuous_force_n", &DeviceProfile::continuous_force, 1e-3, 1000, true},
    Figure{"max_torque_nm", &DeviceProfile::max_torque, 1e-4, 200, true},
    Figure{"continuous_torque_nm", &DeviceProfile::continuous_torque, 1e-5, 200, true},
    Figure{"max_stiffness_n_per_m", &DeviceProfile::max_stiffness, 1, 1e6, true},
    Figure{"max_damping_ns_per_m", &DeviceProfile::max_damping, 1e-3, 1e4, true},
    Figure{"max_rotational_stiffness_nm_per_rad", &DeviceProfile::max_rotational_stiffness, 1e-4,
           1e4, true},
    Figure{"max_rotational_damping_nms_per_rad", &DeviceProfile::max_rotational_damping, 1e-6, 100,
           true},
    Figure{"position_resolution_m", &DeviceProfile::position_resolution, 1e-10, 0.01, true},
    Figure{"rotation_resolution_rad", &DeviceProfile::rotation_resolution, 1e-8, 0.5, true},
    Figure{"rate_hz", &DeviceProfile::rate_hz, 1, 1e5, false},
    Figure{"mass_kg", &DeviceProfile::mass, 1e-4, 100, false},
    Figure{"inertia_kg_m2", &DeviceProfile::inertia, 1e-9, 10, false},
    Figure{"damping_ns_per_m", &DeviceProfile::damping, 1e-6, 1e4, true},
    Figure{"rotational_damping_nms_per_rad", &DeviceProfile::rotational_damping, 1e-9, 100, true},
    Figure{"friction_n", &DeviceProfile::friction, 1e-6, 100, true},
    Figure{"rotational_friction_nm", &DeviceProfile::rotational_friction, 1e-9, 100, true},
    Figure{"delay_s", &DeviceProfile::delay, 1e-7, 2, true},
};
// Edges of a workspace [m], as the figures above.
constexpr double kLeastEdge = 1e-3;
constexpr double kMostEdge = 50;
constexpr double kRotationSlack = 1e-6;  // Error of the length of a unit quaternion: rounding.
constexpr const char* kWorkspace = "workspace_m";

Unexpected Invalid(const std::string& where, const std::string& key, const std::string& what) {
  return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" {}", key, what), where,
              "see data/schemas/device_profile.schema.json");
}

/** What is impossible about a figure, with its value and its range; nothing where it can be. */
std::string DescribeImpossible(const Figure& figure, double value) {
  const bool is_possible =
      (value >= figure.least && value <= figure.most) || (figure.may_be_zero && value == 0);
  return is_possible ? ""
                     : fmt::format("is {}, which is impossible: it must be {}{} to {}", value,
                                   figure.may_be_zero ? "0, or " : "", figure.least, figure.most);
}

Result<const json*> FindFigure(const json& figures, const std::string& key,
                               const std::string& where, SourcedProfile* profile) {
  const auto found = figures.find(key);
  if (found == figures.end() || !found->is_object() || !found->contains("value")) {
    return Invalid(where, key, "is missing, or has no \"value\"");
  }
  const json& source = found->value("source", json());
  const json& verified = found->value("verified", json());
  if (!source.is_string() || source.get_ref<const std::string&>().empty() ||
      !verified.is_boolean()) {
    return Invalid(where, key, "needs a \"source\" and whether it is \"verified\"");
  }
  profile->sources[key] = {source.get<std::string>(), verified.get<bool>()};
  return &(*found)["value"];
}

/** Which way an axis as "-z" points in D; zero for another text. */
Vec3 ParseAxis(const json& text) {
  const std::string axis = text.is_string() ? text.get<std::string>() : std::string();
  if (axis.size() != 2 || (axis[0] != '+' && axis[0] != '-') || axis[1] < 'x' || axis[1] > 'z') {
    return Vec3::Zero();
  }
  return (axis[0] == '+' ? 1 : -1) * Vec3::Unit(axis[1] - 'x');
}

Result<void> ReadAxes(const json& document, const std::string& where, SourcedProfile* profile) {
  constexpr const char* kAxes = "axes";
  const auto value = FindFigure(document, kAxes, where, profile);
  if (!value) {
    return Unexpected(value.error());
  }
  const json& axes = **value;
  Mat3 R_UD = Mat3::Zero();
  for (std::size_t k = 0; k < 3 && axes.is_array() && axes.size() == 3; ++k) {
    R_UD.row(static_cast<Eigen::Index>(k)) = ParseAxis(axes[k]).transpose();
  }
  if (std::abs(R_UD.determinant() - 1) > 1e-9) {
    return Invalid(where, kAxes,
                   "must be three right-handed axes such as [\"+x\", \"-z\", \"+y\"]");
  }
  profile->profile.q_UD = Quat(R_UD);
  return {};
}

Result<void> ReadFigures(const json& figures, const std::string& where, SourcedProfile* profile) {
  for (const Figure& figure : kFigures) {
    const auto value = FindFigure(figures, figure.key, where, profile);
    if (!value) {
      return Unexpected(value.error());
    }
    if (!(*value)->is_number()) {
      return Invalid(where, figure.key, "must be a number");
    }
    profile->profile.*figure.member = (*value)->get<double>();
  }
  const auto value = FindFigure(figures, kWorkspace, where, profile);
  if (!value) {
    return Unexpected(value.error());
  }
  const json& edges = **value;
  const bool is_box =
      edges.is_array() && edges.size() == 3 &&
      std::all_of(edges.begin(), edges.end(), [](const json& edge) { return edge.is_number(); });
  if (!is_box) {
    return Invalid(where, kWorkspace, "must be the three edges of a box");
  }
  for (int k = 0; k < 3; ++k) {
    profile->profile.workspace[k] = edges[static_cast<std::size_t>(k)].get<double>();
  }
  if (figures.size() != kFigures.size() + 1) {
    return Invalid(where, "figures", "has an unknown key");
  }
  return {};
}

std::vector<SourcedProfile> ReadKnownProfiles() {
  std::vector<SourcedProfile> profiles;
  for (const KnownProfileFile& file : kKnownProfileFiles) {
    auto profile = ParseProfile(file.json, file.name);
    if (!profile) {  // The build put in a file that its own test refuses.
      std::fprintf(stderr, "hvas: %s\n", profile.error().ToString().c_str());
      std::abort();
    }
    profiles.push_back(std::move(*profile));
  }
  return profiles;
}

}  // namespace

Result<SourcedProfile> ParseProfile(std::string_view text, const std::string& where) {
  const json document = ParseJson<json>(text);
  if (!document.is_object()) {
    return Fail(ErrorCode::kUnreadable, "the file is not a JSON object", where,
                "see data/schemas/device_profile.schema.json");
  }
  if (document.value("schema", json()) != kSchema) {
    return Invalid(where, "schema", "must be 1");
  }
  SourcedProfile result;
  const auto read_text = [&](const char* key, std::string* value) {
    const auto found = document.find(key);
    const bool is_text = found != document.end() && found->is_string();
    *value = is_text ? found->get<std::string>() : std::string();
    return !value->empty();
  };
  if (!read_text("id", &result.profile.id)) {
    return Invalid(where, "id", "must be a word");
  }
  if (!read_text("name", &result.profile.name)) {
    return Invalid(where, "name", "must be a name");
  }
  if (!read_text("driver", &result.driver)) {
    return Invalid(where, "driver", "must be the name of a driver");
  }
  const json models = document.value("models", json());
  if (!models.is_array() ||
      !std::all_of(models.begin(), models.end(), [](const json& m) { return m.is_string(); })) {
    return Invalid(where, "models", "must list the names that the device reports");
  }
  result.models = models.get<std::vector<std::string>>();
  if (const auto read = ReadAxes(document, where, &result); !read) {
    return Unexpected(read.error());
  }
  const json figures = document.value("figures", json());
  if (!figures.is_object()) {
    return Invalid(where, "figures", "is missing");
  }
  if (const auto read = ReadFigures(figures, where, &result); !read) {
    return Unexpected(read.error());
  }
  if (const auto checked = CheckProfile(result.profile, where); !checked) {
    return Unexpected(checked.error());
  }
  return result;
}

Result<void> CheckProfile(const DeviceProfile& profile, const std::string& where) {
  for (const Figure& figure : kFigures) {
    if (const std::string problem = DescribeImpossible(figure, profile.*figure.member);
        !problem.empty()) {
      return Invalid(where, figure.key, problem);
    }
  }
  constexpr Figure kEdge{kWorkspace, nullptr, kLeastEdge, kMostEdge, false};
  for (const double edge : profile.workspace) {
    if (const std::string problem = DescribeImpossible(kEdge, edge); !problem.empty()) {
      return Invalid(where, kWorkspace, problem);
    }
  }
  if (profile.continuous_force > profile.max_force) {
    return Invalid(where, "continuous_force_n",
                   fmt::format("is {}, which is above its peak, {}", profile.continuous_force,
                               profile.max_force));
  }
  if (profile.continuous_torque > profile.max_torque) {
    return Invalid(where, "continuous_torque_nm",
                   fmt::format("is {}, which is above its peak, {}", profile.continuous_torque,
                               profile.max_torque));
  }
  if (!(std::abs(profile.q_UD.norm() - 1) <= kRotationSlack)) {
    return Invalid(where, "axes", "are no rotation");
  }
  return {};
}

const std::vector<SourcedProfile>& KnownProfiles() {
  static const std::vector<SourcedProfile> profiles = ReadKnownProfiles();
  return profiles;
}

const SourcedProfile* FindProfile(std::string_view id) {
  const auto& profiles = KnownProfiles();
  const auto found = std::find_if(profiles.begin(), profiles.end(),
                                  [id](const SourcedProfile& p) { return p.profile.id == id; });
  return found != profiles.end() ? &*found : nullptr;
}

const SourcedProfile* FindProfileOfModel(std::string_view driver, std::string_view model) {
  for (const SourcedProfile& profile : KnownProfiles()) {
    if (profile.driver == driver &&
        std::find(profile.models.begin(), profile.models.end(), model) != profile.models.end()) {
      return &profile;
    }
  }
  return nullptr;
}

const SourcedProfile* FindProfileOfDriver(std::string_view driver, std::string_view id) {
  for (const SourcedProfile& profile : KnownProfiles()) {
    if (profile.driver == driver && (id.empty() || profile.profile.id == id)) {
      return &profile;
    }
  }
  return nullptr;
}

}  // namespace hvas::device
