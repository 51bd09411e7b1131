#pragma once

#include "base/diagnostics.h"
#include "product/product.h"

/** What enumerators are called in JSON: stable, lower case, words joined by '_'. */
namespace hvas {

[[nodiscard]] const char* ToString(Severity severity);

}  // namespace hvas

namespace hvas::spatial {

[[nodiscard]] const char* ToString(SurfaceKind kind);

}  // namespace hvas::spatial

namespace hvas::product {

[[nodiscard]] const char* ToString(FeatureKind kind);
[[nodiscard]] const char* ToString(FormKind kind);
[[nodiscard]] const char* ToString(ThreadKind kind);
[[nodiscard]] const char* ToString(InnerConstraintKind kind);
[[nodiscard]] const char* ToString(MateKind kind);
[[nodiscard]] const char* ToString(MateOrigin origin);
[[nodiscard]] const char* ToString(SurfaceConstraintKind kind);
[[nodiscard]] const char* ToString(FitKind kind);
[[nodiscard]] const char* ToString(DimensionKind kind);
[[nodiscard]] const char* ToString(GeometricToleranceKind kind);

}  // namespace hvas::product
