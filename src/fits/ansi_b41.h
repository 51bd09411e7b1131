#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "fits/iso286.h"

/** Fits in inches after ANSI B4.1-1967: running and sliding fits RC 1 to RC 9, interference
 locational fits LN 1 to LN 3 and force fits FN 1 to FN 5. The figures are those of public tables
 that quote the standard, which is out of print; each was checked by the limits of clearance that
 these tables state beside it. The locational fits LC and LT are not there: no complete table of
 them could be checked so. */
namespace hvas::fits {

struct AnsiFit {
  std::string name;        ///< "RC4".
  std::string_view hole;   ///< The class of the hole in the ABC system: "H8".
  std::string_view shaft;  ///< That of the shaft; empty where it has none.
  FitLimits limits;
};

/** Whether a word is meant to name such a fit: "RC4", "rc 4", "FN2", and "LC1", too. */
[[nodiscard]] bool IsAnsiFit(std::string_view text);

/** The fit at a nominal diameter [m], which belongs to the range that ends with it. Errors:
 kNotFound for a fit that the tables lack, kUnsupported for a diameter outside of them. */
[[nodiscard]] Result<AnsiFit> FindAnsiFit(std::string_view text, double nominal);

}  // namespace hvas::fits
