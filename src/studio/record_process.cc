#include "studio/record_process.h"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/parse_json.h"
#include "cad/worker.h"
#include "session/json_values.h"

namespace hvas::studio {
namespace {

// The first byte of what is handed over.
constexpr char kIsPart = '+';
constexpr char kIsError = '-';

constexpr std::int64_t kLongestNs = 20 * kNsPerSecond;     // A choice.
constexpr std::uint64_t kMemory = std::uint64_t{2} << 30;  // [bytes]: a choice.

Result<std::string> UnpackOutcome(std::string_view bytes, const std::filesystem::path& file) {
  if (!bytes.empty() && bytes.front() == kIsPart) {
    return std::string(bytes.substr(1));
  }
  const Json json = bytes.empty() ? Json() : ParseJson<Json>(bytes.substr(1));
  constexpr auto kLast = static_cast<std::uint32_t>(ErrorCode::kInternal);  // Of the codes.
  const auto code = std::min(session::IndexOr(json, "code", kLast), kLast);
  return Fail(
      static_cast<ErrorCode>(code), session::TextOr(json, "message", "the record cannot be read"),
      file.filename().string(), session::TextOr(json, "remedy", "restore the file from a copy"));
}

}  // namespace

std::string PackOutcome(const Result<std::string>& outcome) {
  if (outcome) {
    return kIsPart + *outcome;
  }
  const Error& error = outcome.error();
  const Json json{{"code", static_cast<std::uint32_t>(error.code)},
                  {"message", error.message},
                  {"remedy", error.remedy}};
  return kIsError + json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<std::string> ReadInProcess(const std::filesystem::path& file, RecordPart part,
                                  const std::stop_token& stop, const RecordLabels& labels) {
  auto program = cad::FindWorker({"hvas-record", "HVAS_RECORD_WORKER", HVAS_BUILT_RECORD_WORKER});
  if (!program) {
    return Unexpected(program.error());
  }
  cad::WorkerCall call;
  call.program = *std::move(program);
  call.arguments = {kRecordParts[static_cast<std::size_t>(part)], file.string(), labels.name,
                    labels.is_shared ? "shared" : "own"};
  call.deadline_ns = MonotonicNs() + kLongestNs;
  call.part_limit_ns = kLongestNs;
  call.memory = kMemory;
  call.stop = stop;
  const cad::WorkerRun run = cad::RunWorker(call);
  if (run.fate == cad::WorkerFate::kCancelled) {
    return Fail(ErrorCode::kCancelled, "reading the recording was stopped",
                file.filename().string());
  }
  if (run.fate != cad::WorkerFate::kFinished) {
    return Fail(ErrorCode::kUnreadable,
                fmt::format("the program that reads recordings {}", run.Describe()),
                file.filename().string(), "restore the file from a copy");
  }
  const auto bytes = run.output.bytes();
  return UnpackOutcome({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
}

Result<Json> ReadSummary(const std::filesystem::path& file, const std::stop_token& stop) {
  constexpr std::size_t kMostBytes = 16 << 10;  // Of a few numbers and lines: a choice.
  const auto text = ReadInProcess(file, RecordPart::kSummary, stop);
  if (!text) {
    return Unexpected(text.error());
  }
  Json json = text->size() <= kMostBytes ? ParseJson<Json>(*text) : Json();
  // What the list of recordings relies on.
  if (session::FieldOf(json, "name") == nullptr || !json["name"].is_string() ||
      session::FieldOf(json, "started_unix_ms") == nullptr ||
      !json["started_unix_ms"].is_number_integer()) {
    return Fail(ErrorCode::kUnreadable, "the program that reads recordings wrote no summary",
                file.filename().string());
  }
  return json;
}

}  // namespace hvas::studio
