// Libraries that are not as they should be (N8).

#include <algorithm>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "device/drivers/dynamic_library.h"
#include "device/drivers/vendor_drivers.h"
#include "device/emulation/library_emulator.h"
#include "device/test/library_probe_folder.h"

namespace hvas::device {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace)

std::string ReadFile(const std::filesystem::path& file) {
  std::ostringstream content;
  content << std::ifstream(file, std::ios::binary).rdbuf();
  return content.str();
}

Error OpenError(const Driver& driver, const Surroundings& surroundings) {
  const auto device = driver.Open("", surroundings);
  EXPECT_FALSE(device.has_value());
  return device ? Error() : device.error();
}

TEST(DynamicLibraryTest, ADependencyThatIsMissingIsNamed) {
  const ProbeFolder machine;
  Surroundings surroundings = machine.surroundings();
  surroundings.library_folders = {StubFolder() / "needy"};
  const Error error = OpenError(OpenHapticsDriver(), surroundings);
  EXPECT_EQ(error.code, ErrorCode::kUnsupported);
  EXPECT_EQ(error.message,
            "libHD.so of OpenHaptics (3D Systems) needs libhvas_missing.so, which is not "
            "installed");
  EXPECT_NE(error.remedy.find("apt-file search libhvas_missing.so"), std::string::npos);
  const ProbeReport report = OpenHapticsDriver().Probe(surroundings, true);
  const auto finding = std::find_if(report.looked_for.begin(), report.looked_for.end(),
                                    [](const Finding& f) { return f.is_found; });
  ASSERT_NE(finding, report.looked_for.end());
  EXPECT_NE(finding->note.find("libhvas_missing.so: cannot open"), std::string::npos);
}

TEST(DynamicLibraryTest, ALibraryForAnotherProcessorIsNamed) {
  const ProbeFolder machine;
  std::string library = ReadFile(StubFolder() / "libdrd.so");
  library[18] = static_cast<char>(243);  // RISC-V, which these tests do not run on.
  library[19] = 0;
  machine.Put("usr/lib/libdrd.so.3.17.5", library);
  const Error error = OpenError(ForceDimensionDriver(), machine.surroundings());
  EXPECT_EQ(error.code, ErrorCode::kUnsupported);
  EXPECT_EQ(error.message,
            "libdrd.so.3.17.5 of Force Dimension (DHD/DRD) is built for another processor "
            "architecture");
  EXPECT_EQ(error.where, machine.Path("usr/lib/libdrd.so.3.17.5"));
}

TEST(DynamicLibraryTest, AFileThatIsNoLibraryIsNamed) {
  const ProbeFolder machine;
  machine.Put("usr/local/lib/virtuoseAPI.so", "download failed");
  const Error error = OpenError(VirtuoseDriver(), machine.surroundings());
  EXPECT_EQ(error.message,
            "virtuoseAPI.so of Haption Virtuose (VirtuoseAPI 4) is not a library: it is damaged or "
            "a placeholder");
}

TEST(DynamicLibraryTest, FunctionsThatAreMissingAreNamed) {
  const ProbeFolder machine;
  machine.Put("usr/lib/libdrd.so", ReadFile(StubFolder() / "version3/virtuoseAPI.so"));
  const Error error = OpenError(ForceDimensionDriver(), machine.surroundings());
  EXPECT_EQ(error.code, ErrorCode::kUnsupported);
  EXPECT_NE(error.message.find("has no function dhdGetSDKVersion, dhdGetDeviceCount, "),
            std::string::npos)
      << error.message;
  EXPECT_EQ(error.message.find("dhdSetWatchdog"), std::string::npos);  // Can be done without.
  EXPECT_NE(error.remedy.find("version 3.5 or later of the SDK is needed"), std::string::npos);
}

TEST(DynamicLibraryTest, AGoodLibraryIsTakenWhereABadOneStandsBeforeIt) {
  const ProbeFolder machine;
  machine.Put("bad/libHD.so", "damaged");
  Surroundings surroundings = machine.surroundings();
  surroundings.library_folders = {machine.Path("bad"), StubFolder()};
  const Error error = OpenError(OpenHapticsDriver(), surroundings);
  EXPECT_NE(error.message.find("could not be started"), std::string::npos);  // Loaded, no device.
}

TEST(DynamicLibraryTest, TheNewestOfSeveralVersionsComesFirst) {
  const ProbeFolder machine;
  for (const char* name : {"libHD.so.3.0", "libHD.so.3.4.0", "libHD.so"}) {
    machine.Put(std::string("usr/lib/") + name, "");
  }
  LibrarySearch search = MakeLibrarySearch(machine.surroundings(), {}, {});
  search.names = {"libHD.so.3*", "libHD.so"};
  std::vector<Finding> looked_for;
  const auto files = LookForLibrary(search, &looked_for);
  ASSERT_EQ(files.size(), 3U);
  EXPECT_EQ(files[0].filename(), "libHD.so.3.4.0");
  EXPECT_EQ(files[1].filename(), "libHD.so.3.0");
  EXPECT_EQ(files[2].filename(), "libHD.so");
}

TEST(DynamicLibraryTest, FoldersGivenComeBeforeVariablesBeforeTheUsualOnes) {
  Surroundings surroundings;
  surroundings.library_folders = {"/given"};
  ASSERT_EQ(::setenv("HVAS_TEST_SDK", "/sdk", 1), 0);
  const LibrarySearch search = MakeLibrarySearch(
      surroundings, {{"HVAS_TEST_SDK", "lib"}, {"HVAS_TEST_NONE", ""}}, {"/opt/x"});
  ::unsetenv("HVAS_TEST_SDK");
  ASSERT_GE(search.folders.size(), 4U);
  EXPECT_EQ(search.folders[0], "/given");
  EXPECT_EQ(search.folders[1], "/sdk/lib");
  EXPECT_EQ(search.folders[2], "/opt/x");
  EXPECT_EQ(search.folders[3], "/usr/local/lib");
  EXPECT_TRUE(search.asks_loader);
}

TEST(DynamicLibraryTest, TheLoadersOwnPathIsAskedLast) {
  LibrarySearch search;
  search.title = "nothing";
  search.names = {"libhvas_no_such_library.so"};
  std::vector<Finding> looked_for;
  const auto none = DynamicLibrary::Load(search, &looked_for);
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().where, " and the loader's own path");
  ASSERT_EQ(looked_for.size(), 1U);
  EXPECT_NE(looked_for[0].note.find("cannot open shared object file"), std::string::npos);
  search.names = {"libm.so.6"};
  const auto found = DynamicLibrary::Load(search, &looked_for);
  ASSERT_TRUE(found.has_value());
  EXPECT_TRUE(found->Has("cos"));
  EXPECT_FALSE(found->is_emulated());
}

}  // namespace
}  // namespace hvas::device
