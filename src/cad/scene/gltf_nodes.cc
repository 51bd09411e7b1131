#include "cad/scene/gltf_nodes.h"

#include <cstdint>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/parse_json.h"
#include "cad/scene/placed_parts.h"

namespace hvas::cad {
namespace {

using Json = nlohmann::json;

/** The document: of a GLB file its first chunk, behind two heads of 12 and 8 bytes. */
std::string_view FindDocument(std::span<const std::byte> bytes) {
  constexpr std::size_t kHeads = 20;     // 12 of the file and 8 of the chunk.
  constexpr std::size_t kLengthAt = 12;  // The chunk's length lies here, little endian.
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!text.starts_with("glTF")) {
    return text;
  }
  if (text.size() < kHeads) {
    return {};
  }
  std::size_t length = 0;
  for (std::size_t i = 4; i > 0; --i) {
    length = length << 8U | static_cast<unsigned char>(text[kLengthAt + i - 1]);
  }
  return text.substr(kHeads, length);
}

/** The list that an object has under a key; an empty one where there is none. */
const Json& ListOf(const Json& object, const char* key) {
  static const Json none = Json::array();
  const auto list = object.is_object() ? object.find(key) : object.end();
  return list != object.end() && list->is_array() ? *list : none;
}

std::vector<std::uint64_t> NumbersOf(const Json& object, const char* key) {
  std::vector<std::uint64_t> numbers;
  for (const Json& value : ListOf(object, key)) {
    if (value.is_number_unsigned()) {
      numbers.push_back(value.get<std::uint64_t>());
    }
  }
  return numbers;
}

}  // namespace

double CountGltfNodes(std::span<const std::byte> bytes) {
  const Json json = ParseJson<Json>(FindDocument(bytes));
  Uses uses;
  std::uint64_t number = 0;
  for (const Json& node : ListOf(json, "nodes")) {
    uses[number++] = NumbersOf(node, "children");
  }
  double count = 0;
  for (const Json& scene : ListOf(json, "scenes")) {
    count += CountPlaced(uses, NumbersOf(scene, "nodes"));
  }
  return count;
}

}  // namespace hvas::cad
