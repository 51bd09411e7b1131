// Text messages of a client of the studio.
#include <cstddef>
#include <string>

#include "fuzz/target.h"
#include "studio/json_fields.h"

namespace hvas::fuzz {
namespace {

std::size_t CountFields(const studio::Json& json) {
  std::size_t count = json.is_object() ? json.size() : 0;
  for (const studio::Json& item : json) {
    count += item.is_structured() ? CountFields(item) : 0;
  }
  return count;
}

}  // namespace

void TestOne(std::string_view bytes) {
  const auto command = studio::ParseCommand(bytes);
  if (!command) {
    Check(command.error().code == ErrorCode::kInvalid && !command.error().message.empty());
    return;
  }
  constexpr std::size_t kMostFields = 64;  // docs/protocol.md
  Check(command->is_object() && CountFields(*command) <= kMostFields);
  for (const char* name : {"command", "occurrence", "on", "a"}) {
    (void)studio::TextAt(*command, name);
    (void)studio::IndexAt(*command, name);
    (void)studio::FlagAt(*command, name);
    (void)studio::FaceAt(*command, name);
  }
  // What was understood is understood again.
  const auto again =
      studio::ParseCommand(command->dump(-1, ' ', false, studio::Json::error_handler_t::replace));
  Check(again && CountFields(*again) == CountFields(*command));
}

}  // namespace hvas::fuzz
