/** hvas-record: reads records that anybody may have made, in a process that may die. Started by the
 studio; see studio/record_process.h. */

#include <unistd.h>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "base/served_process.h"
#include "base/write_all.h"
#include "studio/record_process.h"

namespace hvas::studio {
namespace {

int Run(std::vector<std::string> arguments) {
  if (const int status = BeginServing(
          &arguments, "hvas-record reads recordings for hvas studio, which starts it.");
      status != 0) {
    return status;
  }
  const auto part = std::find(kRecordParts.begin(), kRecordParts.end(), arguments.front());
  if (arguments.size() != 4 || part == kRecordParts.end()) {
    return kWorkerUsage;
  }
  const std::string output =
      PackOutcome(ReadRecordPart(arguments[1], static_cast<RecordPart>(part - kRecordParts.begin()),
                                 {arguments[2], arguments[3] == "shared"}));
  return WriteAll(kOutputDescriptor, std::as_bytes(std::span(output))) == 0 ? 0 : kWorkerNoOutput;
}

}  // namespace
}  // namespace hvas::studio

int main(int argc, char** argv) {
  // All is handed over; what libraries tidy up at their end is only waited for.
  ::_exit(hvas::studio::Run({argv + 1, argv + argc}));
}
