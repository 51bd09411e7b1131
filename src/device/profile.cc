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

struct Figure {
  const char* key;
  double DeviceProfile::*member;
  bool may_be_zero;
};

constexpr std::array kFigures{
    Figure{"max_force_n", &DeviceProfile::max_force, true},
    Figure{"continuous_force_n", &DeviceProfile::continuous_force, true},
    Figure{"max_torque_nm", &DeviceProfile::max_torque, true},
    Figure{"continuous_torque_nm", &DeviceProfile::continuous_torque, true},
    Figure{"max_stiffness_n_per_m", &DeviceProfile::max_stiffness, true},
    Figure{"max_damping_ns_per_m", &DeviceProfile::max_damping, true},
    Figure{"max_rotational_stiffness_nm_per_rad", &DeviceProfile::max_rotational_stiffness, true},
    Figure{"max_rotational_damping_nms_per_rad", &DeviceProfile::max_rotational_damping, true},
    Figure{"position_resolution_m", &DeviceProfile::position_resolution, true},
    Figure{"rotation_resolution_rad", &DeviceProfile::rotation_resolution, true},
    Figure{"rate_hz", &DeviceProfile::rate_hz, false},
    Figure{"mass_kg", &DeviceProfile::mass, false},
    Figure{"inertia_kg_m2", &DeviceProfile::inertia, false},
    Figure{"damping_ns_per_m", &DeviceProfile::damping, true},
    Figure{"rotational_damping_nms_per_rad", &DeviceProfile::rotational_damping, true},
    Figure{"friction_n", &DeviceProfile::friction, true},
    Figure{"rotational_friction_nm", &DeviceProfile::rotational_friction, true},
    Figure{"delay_s", &DeviceProfile::delay, true},
};
constexpr const char* kWorkspace = "workspace_m";

Unexpected Invalid(const std::string& where, const std::string& key, const char* what) {
  return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" {}", key, what), where,
              "see data/schemas/device_profile.schema.json");
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
    const double number = (*value)->is_number() ? (*value)->get<double>() : -1;
    if (!std::isfinite(number) || number < 0 || (number == 0 && !figure.may_be_zero)) {
      return Invalid(where, figure.key,
                     figure.may_be_zero ? "must be 0 or more" : "must be above 0");
    }
    profile->profile.*figure.member = number;
  }
  const auto value = FindFigure(figures, kWorkspace, where, profile);
  if (!value) {
    return Unexpected(value.error());
  }
  const json& edges = **value;
  const bool is_box =
      edges.is_array() && edges.size() == 3 &&
      std::all_of(edges.begin(), edges.end(), [](const json& edge) {
        return edge.is_number() && edge.get<double>() > 0 && edge.get<double>() < 100;
      });
  if (!is_box) {
    return Invalid(where, kWorkspace, "must be three edges of a box, each above 0");
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
  const DeviceProfile& profile = result.profile;
  if (profile.continuous_force > profile.max_force ||
      profile.continuous_torque > profile.max_torque) {
    return Invalid(where, "continuous_force_n", "or the torque is above its peak");
  }
  return result;
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
