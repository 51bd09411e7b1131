#include "app/test/run_hvas.h"

#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <stdlib.h>

#include "base/test/temporary_folder.h"

extern char** environ;

namespace hvas::app::testing {
namespace {

using hvas::testing::TemporaryFolder;

/** Prepared parts are shared by the runs of one test program, and with nothing else. */
void UseOwnCache() {
  static const TemporaryFolder folder;
  ::setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
}

pid_t Start(const std::vector<std::string>& arguments, const std::string& out,
            const std::string& err) {
  UseOwnCache();
  std::vector<std::string> words{HVAS_BINARY};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) {
    argv.push_back(word.data());
  }
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  const int flags = O_WRONLY | O_CREAT | O_TRUNC;
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), flags, 0600);
  ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), flags, 0600);
  pid_t child = -1;
  const int error = ::posix_spawn(&child, HVAS_BINARY, &actions, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  EXPECT_EQ(error, 0) << "cannot start " << HVAS_BINARY;
  return error == 0 ? child : -1;
}

}  // namespace

std::string ReadText(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

Ran RunHvasInto(const std::string& output, const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  Ran ran;
  const pid_t child = Start(arguments, output, (folder / "err").string());
  int status = 0;
  if (child > 0 && ::waitpid(child, &status, 0) == child && WIFEXITED(status)) {
    ran.status = WEXITSTATUS(status);
  }
  ran.err = ReadText(folder / "err");
  return ran;
}

Ran RunHvas(const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  Ran ran = RunHvasInto((folder / "out").string(), arguments);
  ran.out = ReadText(folder / "out");
  return ran;
}

nlohmann::json RunHvasJson(std::vector<std::string> arguments, int status) {
  arguments.emplace_back("--json");
  const Ran ran = RunHvas(arguments);
  EXPECT_EQ(ran.status, status) << ran.err;
  EXPECT_EQ(ran.err, "");
  nlohmann::json json = nlohmann::json::parse(ran.out, nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << ran.out;
  return json;
}

pid_t StartHvas(const std::vector<std::string>& arguments) {
  return Start(arguments, "/dev/null", "/dev/null");
}

std::string ProductFile(const std::string& name) {
  return (std::filesystem::path(HVAS_SOURCE_DIR) / "products" / (name + ".step")).string();
}

}  // namespace hvas::app::testing
