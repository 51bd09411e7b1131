#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/id.h"
#include "spatial/pose.h"

/** Values as JSON and back, every number to its last bit: what is not finite is a text, as JSON has
 no such numbers. */
namespace hvas::session {

using Json = nlohmann::ordered_json;

[[nodiscard]] Json MakeJson(double value);
[[nodiscard]] Json MakeJson(const Vec3& v);
/** w, x, y, z */
[[nodiscard]] Json MakeJson(const Quat& q);
/** p, then q */
[[nodiscard]] Json MakeJson(const spatial::Pose& X);

/** Reads fields of objects, remembers the first one that is not what it should be, and leaves that
 value as it was. */
class JsonFields {
 public:
  explicit JsonFields(const Json& object) : object_(&object) {}

  void operator()(const char* name, double& value);
  void operator()(const char* name, bool& value);
  void operator()(const char* name, std::string& value);
  void operator()(const char* name, std::array<double, 2>& value);
  void operator()(const char* name, std::vector<double>& value);
  void operator()(const char* name, Vec3& value);
  void operator()(const char* name, Quat& value);
  void operator()(const char* name, spatial::Pose& value);

  /** One of some names, by its place among them. */
  template <typename E, std::size_t N>
  void operator()(const char* name, E& value, const std::array<const char*, N>& names) {
    const Json* field = Find(name);
    for (std::size_t i = 0; field != nullptr && i < N; ++i) {
      if (*field == names[i]) {
        value = static_cast<E>(i);
        return;
      }
    }
    Refuse(name);
  }

  /** An index below `count`. */
  void Index(const char* name, std::size_t count, std::size_t* value);

  template <typename Tag>
  void IdBelow(const char* name, std::size_t count, Id<Tag>* value) {
    std::size_t index = 0;
    Index(name, count, &index);
    *value = Id<Tag>(index);
  }

  /** A field that is an array, with its elements; empty where it is none. */
  [[nodiscard]] const Json& Array(const char* name);

  /** A field that is an object, to be read by itself and then given to Take(). */
  [[nodiscard]] JsonFields Inner(const char* name);
  void Take(const JsonFields& inner);

  void Refuse(const std::string& name);

  [[nodiscard]] bool has(const char* name) const {
    return object_->is_object() && object_->contains(name);
  }

  /** Empty: all was as it should be. */
  [[nodiscard]] const std::string& refused() const { return refused_; }

 private:
  [[nodiscard]] const Json* Find(const char* name) const;
  template <std::size_t N>
  bool Numbers(const char* name, std::array<double, N>* numbers);

  const Json* object_;
  std::string path_;
  std::string refused_;
};

}  // namespace hvas::session
