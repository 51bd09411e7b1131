#include "studio/audit_log.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <future>
#include <limits>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include "base/descriptor.h"
#include "base/write_all.h"
#include "studio/json_fields.h"

namespace hvas::studio {
namespace {

std::string PrintTime() {
  const auto now = std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
  const auto ms = now.time_since_epoch().count() % 1000;
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(now)), ms);
}

/** Whether a text may be an id of the studio's, and nothing that a user has made up. */
bool IsPlain(const std::string& text) {
  constexpr std::size_t kLongestId = 100;  // Characters: a choice.
  return text.size() <= kLongestId && std::all_of(text.begin(), text.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
         });
}

/** @returns whether the line is written. */
bool Append(const std::filesystem::path& file, const std::string& line) {
  std::error_code failed;
  if (std::filesystem::file_size(file, failed) > AuditLog::kMaxBytes && !failed) {
    std::filesystem::rename(file, file.string() + ".1", failed);
  }
  const Descriptor opened(
      ::open(file.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK,
             S_IRUSR | S_IWUSR));
  return opened.is_open() &&
         WriteAll(opened.value(), std::as_bytes(std::span<const char>(line))) == 0;
}

}  // namespace

void AuditLog::Note(std::uint32_t link, const Entry& entry, std::int64_t now_ns) {
  Entry done = entry;
  {
    const std::lock_guard lock(mutex_);
    Deeds& deeds = deeds_[link];
    if (const std::int64_t minute = now_ns / kRefusalPauseNs; minute != deeds.minute) {
      deeds.minute = minute;
      deeds.noted = 0;
    }
    if (deeds.noted >= kMostInMinute) {
      ++deeds.unnoted;
      return;
    }
    ++deeds.noted;
    if (deeds.unnoted > 0) {
      done.did["left_out_before"] = std::exchange(deeds.unnoted, 0);
    }
  }
  Print(done);
}

void AuditLog::Print(const Entry& entry) {
  Json line{{"time", PrintTime()}, {"who", entry.who}, {"address", entry.address}};
  if (!entry.client.empty()) {
    line["client"] = entry.client;
  }
  line.update(entry.did);
  Write(line);
}

void AuditLog::NoteRefusal(std::uint32_t link, const Entry& entry, const std::string& why,
                           std::int64_t now_ns) {
  Entry refused = entry;
  {
    const std::lock_guard lock(mutex_);
    const auto [found, is_first] = refusals_.try_emplace(link);
    Refusals& refusals = found->second;
    if (!is_first && now_ns - refusals.noted_ns < kRefusalPauseNs) {
      ++refusals.unnoted;
      return;
    }
    if (refusals.unnoted > 0) {
      refused.did["refused_before"] = refusals.unnoted;
    }
    refusals = {now_ns, 0};
  }
  refused.did["refused"] = why;
  Print(refused);
}

void AuditLog::Write(const Json& line) {
  if (file_.empty()) {
    return;
  }
  Json told = line;
  {
    const std::lock_guard lock(mutex_);
    if (lost_ > 0) {
      told["lost_before"] = lost_;
    }
  }
  const std::string text =
      told.dump(-1, ' ', /*ensure_ascii=*/true, Json::error_handler_t::replace) + "\n";
  const auto append = [this, text](const std::stop_token& /*stop*/) {
    if (!Append(file_, text) && std::exchange(can_write_, false)) {
      fmt::print(stderr, "warning: the audit log cannot be written: {}\n", file_.string());
    }
  };
  const bool is_kept = writer_.TryPost(append, kMostWaiting);
  const std::lock_guard lock(mutex_);
  lost_ = is_kept ? 0 : lost_ + 1;
}

void AuditLog::Stop() {
  std::promise<void> written;
  const auto tell = [&written](const std::stop_token& /*stop*/) { written.set_value(); };
  if (writer_.TryPost(tell, std::numeric_limits<std::size_t>::max())) {
    written.get_future().wait();
  }
  writer_.Stop();
}

Json DescribeForAudit(const Json& command) {
  constexpr std::array kFields{"action",    "hand",   "to",   "other", "occurrence",
                               "mate",      "on",     "off",  "count", "device",
                               "recording", "shared", "note", "scale", "example"};
  const std::string name = TextOr(command, "command", "");
  Json did{{"command", IsPlain(name) ? name : "(other)"}};
  for (const char* field : kFields) {
    const auto found = command.find(field);
    if (found == command.end() || found->is_structured()) {
      continue;
    }
    const bool is_other = found->is_string() && !IsPlain(found->get_ref<const std::string&>());
    did[field] = is_other ? Json("(other)") : *found;
  }
  return did;
}

}  // namespace hvas::studio
