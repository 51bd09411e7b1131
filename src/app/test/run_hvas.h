#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

/** Runs the program itself, as a person at a terminal would. */
namespace hvas::app::testing {

struct Ran {
  int status{-1};  ///< Exit status; -1 when a signal ended it.
  std::string out;
  std::string err;
};

/** Runs `hvas` to its end. */
[[nodiscard]] Ran RunHvas(const std::vector<std::string>& arguments);

/** Runs `hvas` with its standard output going to a file or device; `out` stays empty. */
[[nodiscard]] Ran RunHvasInto(const std::string& output, const std::vector<std::string>& arguments);

/** Runs `hvas` at a terminal of so many columns; `out` has all that it shows.
 @param no_color  Whether NO_COLOR is set. */
[[nodiscard]] Ran RunHvasAtTerminal(unsigned short columns,
                                    const std::vector<std::string>& arguments,
                                    bool no_color = false);

/** A text without what colours it and moves the cursor; of a line that is written over and over,
 the last of each. */
[[nodiscard]] std::string WithoutControls(const std::string& text);

/** Runs `hvas ... --json`, expects an exit status, and reads what it printed. */
[[nodiscard]] nlohmann::json RunHvasJson(std::vector<std::string> arguments, int status = 0);

/** Expects that `hvas` refuses to work: exit status 1 or 64, nothing on standard output, and all
 these texts on standard error. */
Ran ExpectRefusal(const std::vector<std::string>& arguments, const std::vector<std::string>& texts);

/** Starts `hvas` with its standard output going to a file or device, and its errors thrown away. */
[[nodiscard]] pid_t StartHvas(const std::vector<std::string>& arguments,
                              const std::string& output = "/dev/null");

/** The example product's STEP file. */
[[nodiscard]] std::string ProductFile(const std::string& name);

/** Writes a shipped study whose blocks are shown once each into a file.
 @returns the file. */
[[nodiscard]] std::string WriteShortStudy(const std::string& id,
                                          const std::filesystem::path& folder);

/** Expects that `hvas assemble --json` has put all parts exactly in their place.
 @param most_felt_n  What the hand's device can show; that of a guided hand 120 N. */
void ExpectAllSeated(const nlohmann::json& run, std::size_t count, double most_felt_n = 120);

[[nodiscard]] std::string ReadText(const std::filesystem::path& file);

}  // namespace hvas::app::testing
