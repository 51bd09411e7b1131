#pragma once

#include <string>

#include "evidence/summary.h"

namespace hvas::app {

/** A session as one HTML page that needs nothing else: no network, no scripts; light and dark by
 what the reader prefers, light on paper. Same session, same bytes. */
[[nodiscard]] std::string MakeReportPage(const evidence::Summary& summary);

}  // namespace hvas::app
