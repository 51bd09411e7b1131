#pragma once

#include <cstddef>
#include <string>

#include "evidence/summary.h"

namespace hvas::app {

/** The parts of a session that have no way in. */
struct ReportedLeftOut {
  std::size_t count{0};
  std::string section;  ///< Which, and why: MakeLeftOutSection, or MakeLeftOutList.
};

/** A session as one HTML page that needs nothing else: no network, no scripts; light and dark by
 what the reader prefers, light on paper. Same session, same bytes. */
[[nodiscard]] std::string MakeReportPage(const evidence::Summary& summary,
                                         const ReportedLeftOut& left_out = {});

}  // namespace hvas::app
