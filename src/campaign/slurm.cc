#include "campaign/slurm.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <system_error>

#include <fmt/format.h>
#include <spawn.h>

#include "base/atomic_file.h"
#include "base/descriptor.h"
#include "base/shell_words.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): unistd.h need not have it.

namespace hvas::campaign {
namespace {

constexpr int kLargestArray = 4'000'000;  // MaxArraySize of slurm.conf(5) goes no further.

/** The first folder of submissions/0001, 0002, ... that is not there. */
Result<std::filesystem::path> MakeSubmissionFolder(const CampaignFolder& folder) {
  std::error_code failed;
  for (int number = 1;; ++number) {
    const auto path = folder.path() / "submissions" / fmt::format("{:04d}", number);
    std::filesystem::create_directories(path.parent_path(), failed);
    if (!failed && std::filesystem::create_directory(path, failed)) {
      return std::filesystem::absolute(path);
    }
    if (failed) {
      return Fail(ErrorCode::kInvalid, "the folder cannot be made: " + failed.message(),
                  path.string(), "check the path and its permissions");
    }
  }
}

std::string MakeScript(const CampaignFolder& folder, const std::filesystem::path& here,
                       const SlurmOptions& options) {
  return fmt::format(
      "#!/bin/sh\n"
      "# The campaign {}: each task calculates the shards of one line of the file tasks.\n"
      "#SBATCH --job-name=hvas-{}\n"
      "#SBATCH --ntasks=1\n"
      "#SBATCH --cpus-per-task=1\n"
      "#SBATCH --requeue\n"
      "#SBATCH --open-mode=append\n"
      "shards=$(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" {})\n"
      "exec {} campaign shard {} \"$shards\" --jobs 1 --quiet\n",
      folder.plan().id, folder.plan().id, QuoteWord((here / "tasks").string()),
      QuoteWord(options.hvas), QuoteWord(std::filesystem::absolute(folder.path()).string()));
}

std::string ReadAll(int descriptor) {
  std::string text;
  std::array<char, 4096> block{};
  for (;;) {
    const ssize_t count = ::read(descriptor, block.data(), block.size());
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count <= 0) {
      return text;
    }
    text.append(block.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace

std::vector<std::int64_t> ListUnfinished(const CampaignFolder& folder) {
  std::vector<std::int64_t> shards;
  for (std::int64_t shard = 0; shard < folder.plan().CountShards(); ++shard) {
    if (!ReadShard(folder.PathOf(shard), folder.MakeKey(shard))) {
      shards.push_back(shard);
    }
  }
  return shards;
}

Result<Submission> WriteSubmission(const CampaignFolder& folder,
                                   const std::vector<std::int64_t>& shards,
                                   const SlurmOptions& options) {
  if (options.array_size < 1 || options.array_size > kLargestArray) {
    return Fail(ErrorCode::kInvalid, "the size of the array is out of range", "--array-size",
                fmt::format("give 1 to {}", kLargestArray));
  }
  const auto here = MakeSubmissionFolder(folder);
  if (!here) {
    return Unexpected(here.error());
  }
  const auto count = static_cast<std::int64_t>(shards.size());
  const std::int64_t per_task = (count + options.array_size - 1) / options.array_size;
  Submission submission;
  submission.script = *here / "job.sh";
  submission.shards = count;
  std::string tasks;
  for (std::int64_t first = 0; first < count; first += per_task) {
    const std::int64_t end = std::min(first + per_task, count);
    tasks += FormatRanges({shards.begin() + first, shards.begin() + end}) + "\n";
    ++submission.tasks;
  }
  auto written = WriteAtomically(*here / "tasks", tasks);
  written =
      written ? WriteAtomically(submission.script, MakeScript(folder, *here, options)) : written;
  if (!written) {
    return Unexpected(written.error());
  }
  submission.command = {"sbatch", "--parsable", "--requeue",
                        fmt::format("--array=0-{}", submission.tasks - 1),
                        "--output=" + (*here / "task-%a.log").string()};
  submission.command.insert(submission.command.end(), options.sbatch.begin(), options.sbatch.end());
  submission.command.push_back(submission.script.string());
  return submission;
}

Result<std::string> RunCommand(const std::vector<std::string>& command) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) {
    return Fail(ErrorCode::kOutOfResource, "no pipe can be made", command.front(),
                "close other programs");
  }
  Descriptor reading(ends[0]);
  Descriptor writing(ends[1]);
  std::vector<std::string> words = command;
  std::vector<char*> arguments;
  for (std::string& word : words) {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addclose(&actions, reading.value());
  posix_spawn_file_actions_adddup2(&actions, writing.value(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, writing.value(), STDERR_FILENO);
  pid_t child = 0;
  const int failure =
      ::posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  static_cast<void>(writing.Close());
  if (failure != 0) {
    return Fail(ErrorCode::kNotFound,
                "cannot be started: " + std::error_code(failure, std::generic_category()).message(),
                command.front(), "install SLURM's client programs, or run it where they are");
  }
  std::string text = ReadAll(reading.value());
  while (text.ends_with('\n')) {
    text.pop_back();
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    return Fail(ErrorCode::kUnsupported, "failed: " + text, command.front(),
                "check SLURM and the options that are passed to it");
  }
  return text;
}

std::string FormatRanges(const std::vector<std::int64_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) {
      ++last;
    }
    text += text.empty() ? "" : ",";
    text +=
        last == i ? fmt::format("{}", numbers[i]) : fmt::format("{}-{}", numbers[i], numbers[last]);
    i = last + 1;
  }
  return text;
}

Result<std::vector<std::int64_t>> ParseRanges(const std::string& text, std::int64_t count) {
  std::vector<std::int64_t> numbers;
  const auto refuse = [&] {
    return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" does not name shards", text), "shards",
                fmt::format("write numbers from 0 to {}, for example 0-3,7", count - 1));
  };
  const char* at = text.data();
  const char* const end = at + text.size();
  for (;;) {
    std::int64_t first = 0;
    auto [rest, failed] = std::from_chars(at, end, first);
    std::int64_t last = first;
    if (failed == std::errc() && rest != end && *rest == '-') {
      const auto second = std::from_chars(rest + 1, end, last);
      rest = second.ptr;
      failed = second.ec;
    }
    if (failed != std::errc() || first < 0 || last < first || last >= count) {
      return refuse();
    }
    for (std::int64_t number = first; number <= last; ++number) {
      numbers.push_back(number);
    }
    if (rest == end) {
      return numbers;
    }
    if (*rest != ',') {
      return refuse();
    }
    at = rest + 1;
  }
}

}  // namespace hvas::campaign
