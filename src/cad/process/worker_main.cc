/** hvas-cad: what needs OpenCASCADE, in a process that may die. Started by hvas; see cad/worker.h.
 */

#include <sys/personality.h>
#include <unistd.h>

#include <string>
#include <string_view>
#include <vector>

#include "base/served_process.h"
#include "cad/process/worker_export.h"
#include "cad/process/worker_import.h"
#include "cad/worker.h"

namespace hvas::cad {
namespace {

/** Starts the program again at addresses that are the same every time, where the kernel permits it:
 OpenCASCADE writes what it keeps in tables by address in the order of these. */
void FixAddresses(char** argv) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // They know where they are.
  constexpr unsigned long kAsk = 0xffffffff;  // personality(2): tells, and changes nothing.
  const int before = ::personality(kAsk);
  if (before >= 0 && (before & ADDR_NO_RANDOMIZE) == 0 &&
      ::personality(static_cast<unsigned long>(before) | ADDR_NO_RANDOMIZE) >= 0) {
    ::execv("/proc/self/exe", argv);  // Goes on as it is where that fails.
  }
#else
  static_cast<void>(argv);
#endif
}

int Run(std::vector<std::string> arguments) {
  if (const int status = BeginServing(
          &arguments, "hvas-cad reads and writes CAD files for hvas, which starts it.");
      status != 0) {
    return status;
  }
  const std::string command = arguments.front();
  arguments.erase(arguments.begin());
  if (command == "import") {
    return WorkerImport(arguments);
  }
  if (command == "export-step") {
    return WorkerExportStep(arguments);
  }
  return kWorkerUsage;
}

}  // namespace
}  // namespace hvas::cad

int main(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "export-step") {
    hvas::cad::FixAddresses(argv);
  }
  // All is handed over; what libraries tidy up at their end is only waited for.
  ::_exit(hvas::cad::Run({argv + 1, argv + argc}));
}
