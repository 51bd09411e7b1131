#pragma once

#include "base/diagnostics.h"
#include "product/product.h"

/** What enumerators are called in JSON: stable, lower case, words joined by '_'. */
namespace hvas::app {

[[nodiscard]] const char* ToString(Severity severity);
[[nodiscard]] const char* ToString(spatial::SurfaceKind kind);
[[nodiscard]] const char* ToString(product::FeatureKind kind);
[[nodiscard]] const char* ToString(product::FormKind kind);
[[nodiscard]] const char* ToString(product::ThreadKind kind);
[[nodiscard]] const char* ToString(product::InnerConstraintKind kind);
[[nodiscard]] const char* ToString(product::MateKind kind);
[[nodiscard]] const char* ToString(product::MateOrigin origin);
[[nodiscard]] const char* ToString(product::SurfaceConstraintKind kind);
[[nodiscard]] const char* ToString(product::FitKind kind);
[[nodiscard]] const char* ToString(product::DimensionKind kind);
[[nodiscard]] const char* ToString(product::GeometricToleranceKind kind);

}  // namespace hvas::app
