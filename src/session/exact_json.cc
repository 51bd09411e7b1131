#include "session/exact_json.h"

#include <cmath>
#include <limits>
#include <utility>

namespace hvas::session {
namespace {

constexpr const char* kInfinite = "inf";
constexpr const char* kMinusInfinite = "-inf";
constexpr const char* kNotANumber = "nan";

bool ReadNumber(const Json& json, double* value) {
  if (json.is_number()) {
    *value = json.get<double>();
    return true;
  }
  const double infinity = std::numeric_limits<double>::infinity();
  if (json == kInfinite || json == kMinusInfinite) {
    *value = json == kInfinite ? infinity : -infinity;
    return true;
  }
  if (json == kNotANumber) {
    *value = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
  return false;
}

}  // namespace

Json MakeJson(double value) {
  if (std::isfinite(value)) {
    return value;
  }
  return std::isnan(value) ? kNotANumber : value > 0 ? kInfinite : kMinusInfinite;
}

Json MakeJson(const Vec3& v) {
  return {MakeJson(v.x()), MakeJson(v.y()), MakeJson(v.z())};
}

Json MakeJson(const Quat& q) {
  return {MakeJson(q.w()), MakeJson(q.x()), MakeJson(q.y()), MakeJson(q.z())};
}

Json MakeJson(const spatial::Pose& X) {
  Json json = MakeJson(X.p());
  for (const Json& number : MakeJson(X.q())) {
    json.push_back(number);
  }
  return json;
}

const Json* JsonFields::Find(const char* name) const {
  if (!object_->is_object()) {
    return nullptr;
  }
  const auto found = object_->find(name);
  return found == object_->end() ? nullptr : &*found;
}

void JsonFields::Refuse(const std::string& name) {
  if (refused_.empty()) {
    refused_ = path_ + name;
  }
}

template <std::size_t N>
bool JsonFields::Numbers(const char* name, std::array<double, N>* numbers) {
  const Json* field = Find(name);
  bool is_good = field != nullptr && field->is_array() && field->size() == N;
  for (std::size_t i = 0; is_good && i < N; ++i) {
    is_good = ReadNumber((*field)[i], &(*numbers)[i]);
  }
  if (!is_good) {
    Refuse(name);
  }
  return is_good;
}

void JsonFields::operator()(const char* name, double& value) {
  const Json* field = Find(name);
  if (field == nullptr || !ReadNumber(*field, &value)) {
    Refuse(name);
  }
}

void JsonFields::operator()(const char* name, bool& value) {
  const Json* field = Find(name);
  if (field == nullptr || !field->is_boolean()) {
    Refuse(name);
    return;
  }
  value = field->get<bool>();
}

void JsonFields::operator()(const char* name, std::string& value) {
  const Json* field = Find(name);
  if (field == nullptr || !field->is_string()) {
    Refuse(name);
    return;
  }
  value = field->get<std::string>();
}

void JsonFields::operator()(const char* name, std::array<double, 2>& value) {
  std::array<double, 2> v{};
  if (Numbers(name, &v)) {
    value = v;
  }
}

void JsonFields::operator()(const char* name, std::vector<double>& value) {
  std::vector<double> numbers;
  for (const Json& one : Array(name)) {
    if (!ReadNumber(one, &numbers.emplace_back())) {
      Refuse(name);
      return;
    }
  }
  value = std::move(numbers);
}

void JsonFields::operator()(const char* name, Vec3& value) {
  std::array<double, 3> v{};
  if (Numbers(name, &v)) {
    value = Vec3(v[0], v[1], v[2]);
  }
}

void JsonFields::operator()(const char* name, Quat& value) {
  std::array<double, 4> v{};
  if (Numbers(name, &v)) {
    value = Quat(v[0], v[1], v[2], v[3]);
  }
}

void JsonFields::operator()(const char* name, spatial::Pose& value) {
  // Error of a quaternion's length; written ones are exact: a choice.
  constexpr double kUnitSlack = 1e-6;
  std::array<double, 7> v{};
  if (!Numbers(name, &v)) {
    return;
  }
  const Quat q(v[3], v[4], v[5], v[6]);
  const Vec3 p(v[0], v[1], v[2]);
  if (p.allFinite() && std::abs(q.norm() - 1) < kUnitSlack) {
    value = {q, p};
  } else {
    Refuse(name);
  }
}

void JsonFields::Index(const char* name, std::size_t count, std::size_t* value) {
  const Json* field = Find(name);
  if (field == nullptr || !field->is_number_unsigned() || field->get<std::size_t>() >= count) {
    Refuse(name);
    return;
  }
  *value = field->get<std::size_t>();
}

const Json& JsonFields::Array(const char* name) {
  static const Json kNone = Json::array();
  const Json* field = Find(name);
  if (field == nullptr || !field->is_array()) {
    Refuse(name);
    return kNone;
  }
  return *field;
}

JsonFields JsonFields::Inner(const char* name) {
  static const Json kNone = Json::object();
  const Json* field = Find(name);
  JsonFields inner(field != nullptr ? *field : kNone);
  inner.path_ = path_ + name + ".";
  return inner;
}

void JsonFields::Take(const JsonFields& inner) {
  if (refused_.empty()) {
    refused_ = inner.refused_;
  }
}

}  // namespace hvas::session
