#include "base/diagnostics.h"

#include <gtest/gtest.h>

namespace hvas {
namespace {

TEST(Diagnostics, KeepsTheOrderAndCountsBySeverity) {
  Diagnostics diagnostics;
  diagnostics.Warn("no-solid", "Plate", "Plate has no solid.", "Close its shell.");
  diagnostics.Note("unit", "file", "The file is in inches.");
  diagnostics.Warn("no-density", "Screw", "Screw has no density.");
  diagnostics.Add({Severity::kError, "empty", "file", "Nothing is in it.", ""});

  ASSERT_EQ(diagnostics.items().size(), 4u);
  EXPECT_EQ(diagnostics.items()[0].code, "no-solid");
  EXPECT_EQ(diagnostics.items()[0].remedy, "Close its shell.");
  EXPECT_EQ(diagnostics.items()[1].severity, Severity::kNote);
  EXPECT_EQ(diagnostics.items()[2].entity, "Screw");
  EXPECT_EQ(diagnostics.Count(Severity::kNote), 1);
  EXPECT_EQ(diagnostics.Count(Severity::kWarning), 2);
  EXPECT_EQ(diagnostics.Count(Severity::kError), 1);
}

}  // namespace
}  // namespace hvas
