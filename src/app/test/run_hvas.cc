#include "app/test/run_hvas.h"

#include <signal.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <regex>
#include <sstream>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <spawn.h>
#include <stdlib.h>

#include "base/test/temporary_folder.h"

extern char** environ;

namespace hvas::app::testing {
namespace {

using hvas::testing::TemporaryFolder;

/** Prepared parts are shared by the runs of one test program, and with nothing else; the terminal
 of who runs the tests does not matter. */
void UseOwnCache() {
  ::unsetenv("COLUMNS");
  ::unsetenv("NO_COLOR");
  static const TemporaryFolder folder;
  ::setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
}

/** The arguments of `hvas` as the system takes them. */
class CommandWords {
 public:
  explicit CommandWords(const std::vector<std::string>& arguments) : words_{HVAS_BINARY} {
    words_.insert(words_.end(), arguments.begin(), arguments.end());
    for (std::string& word : words_) {
      argv_.push_back(word.data());
    }
    argv_.push_back(nullptr);
  }

  CommandWords(const CommandWords&) = delete;
  CommandWords& operator=(const CommandWords&) = delete;

  [[nodiscard]] char* const* argv() const { return argv_.data(); }

  [[nodiscard]] std::string Join() const {
    std::string line;
    for (const std::string& word : words_) {
      line += (line.empty() ? "" : " ") + word;
    }
    return line;
  }

 private:
  std::vector<std::string> words_;
  std::vector<char*> argv_;
};

/** @returns the exit status; -1 when a signal ended it, or it never began. */
int AwaitExit(pid_t child) {
  int status = 0;
  const bool has_exited = child > 0 && ::waitpid(child, &status, 0) == child && WIFEXITED(status);
  return has_exited ? WEXITSTATUS(status) : -1;
}

pid_t Start(const std::vector<std::string>& arguments, const std::string& out,
            const std::string& err) {
  UseOwnCache();
  const CommandWords command(arguments);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  const int flags = O_WRONLY | O_CREAT | O_TRUNC;
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), flags, 0600);
  ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), flags, 0600);
  // Also where the test itself runs in the background of a shell, which ignores Ctrl-C then.
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  sigset_t interrupt;
  ::sigemptyset(&interrupt);
  ::sigaddset(&interrupt, SIGINT);
  ::posix_spawnattr_setsigdefault(&attributes, &interrupt);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  pid_t child = -1;
  const int error =
      ::posix_spawn(&child, HVAS_BINARY, &actions, &attributes, command.argv(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&actions);
  EXPECT_EQ(error, 0) << "cannot start " << HVAS_BINARY;
  return error == 0 ? child : -1;
}

}  // namespace

void ExpectAllSeated(const nlohmann::json& run, std::size_t count, double most_felt_n) {
  EXPECT_EQ(run["seated"], count);
  ASSERT_EQ(run["parts"].size(), count);
  for (const nlohmann::json& part : run["parts"]) {
    EXPECT_TRUE(part["seated"].get<bool>()) << part.dump(1);
    EXPECT_EQ(part["reason"], "");
    EXPECT_LT(part["pose_error_um"].get<double>(), 1) << part["name"];
    EXPECT_LT(part["pose_error_urad"].get<double>(), 1) << part["name"];
    EXPECT_LE(part["arrival_um"].get<double>(), 3000) << part["name"];
    EXPECT_EQ(part["arrival_um"].get<double>() > 0, part["time_s"].get<double>() > 0)
        << part["name"] << ": the hand brings nothing exactly to its place";
    EXPECT_LE(part["deepest_um"].get<double>(), 50) << part["name"];
    EXPECT_GE(part["peak_true_n"].get<double>(), 0);
    EXPECT_LE(part["peak_felt_n"].get<double>(), most_felt_n + 1e-9) << part["name"];
  }
}

std::string ReadText(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

Ran RunHvasInto(const std::string& output, const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  Ran ran;
  ran.status = AwaitExit(Start(arguments, output, (folder / "err").string()));
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

Ran RunHvasAtTerminal(unsigned short columns, const std::vector<std::string>& arguments,
                      bool no_color) {
  UseOwnCache();
  const CommandWords command(arguments);
  winsize size{};
  size.ws_row = 50;
  size.ws_col = columns;
  int terminal = -1;
  const pid_t child = ::forkpty(&terminal, nullptr, nullptr, &size);
  if (child == 0) {
    ::setenv("TERM", "xterm-256color", 1);
    ::unsetenv("COLUMNS");
    ::setenv("NO_COLOR", no_color ? "1" : "", 1);
    ::execv(HVAS_BINARY, command.argv());
    ::_exit(127);
  }
  Ran ran;
  std::array<char, 4096> buffer{};
  for (ssize_t got = 0; child > 0 && (got = ::read(terminal, buffer.data(), buffer.size())) > 0;) {
    ran.out.append(buffer.data(), static_cast<std::size_t>(got));
  }
  ::close(terminal);
  ran.status = AwaitExit(child);
  return ran;
}

Ran ExpectRefusal(const std::vector<std::string>& arguments,
                  const std::vector<std::string>& texts) {
  SCOPED_TRACE(CommandWords(arguments).Join());
  Ran ran = RunHvas(arguments);
  EXPECT_TRUE(ran.status == 1 || ran.status == 64) << ran.status;
  EXPECT_EQ(ran.out, "");
  for (const std::string& text : texts) {
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, text, ran.err);
  }
  return ran;
}

std::string WithoutControls(const std::string& text) {
  static const std::regex controls("\033\\[[0-9;]*[A-Za-z]");
  const std::string plain = std::regex_replace(text, controls, "");
  std::string lines;
  std::string line;
  for (const char c : plain) {
    if (c == '\n') {
      lines += line + "\n";
      line.clear();
    } else if (c == '\r') {
      lines += line.empty() ? "" : line + "\n";
      line.clear();
    } else {
      line += c;
    }
  }
  return lines + line;
}

pid_t StartHvas(const std::vector<std::string>& arguments, const std::string& output) {
  return Start(arguments, output, "/dev/null");
}

std::string ProductFile(const std::string& name) {
  return (std::filesystem::path(HVAS_SOURCE_DIR) / "products" / (name + ".step")).string();
}

std::string WriteShortStudy(const std::string& id, const std::filesystem::path& folder) {
  const std::filesystem::path studies = std::filesystem::path(HVAS_SOURCE_DIR) / "data/studies";
  const std::string text = ReadText(studies / (id + ".yaml"));
  const std::string shortened =
      std::regex_replace(text, std::regex("repetitions: [0-9]+"), "repetitions: 1");
  EXPECT_NE(shortened, text) << id << " shows each of its blocks once";
  const std::filesystem::path file = folder / (id + "-short.yaml");
  std::ofstream(file, std::ios::binary) << shortened;
  return file.string();
}

}  // namespace hvas::app::testing
