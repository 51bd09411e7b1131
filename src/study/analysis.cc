#include "study/analysis.h"

namespace hvas::study {}  // namespace hvas::study
