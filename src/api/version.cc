#include "api/version.h"

namespace hvas::api {

const char* LibraryVersion() noexcept {
  return kHeaderVersion;
}

}  // namespace hvas::api
