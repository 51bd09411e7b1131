#include "study/journal.h"

#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/digest.h"
#include "base/file_lock.h"
#include "base/parse_json.h"
#include "base/regular_file.h"
#include "base/write_all.h"

namespace hvas::study {
namespace {

using Json = nlohmann::ordered_json;
using Kind = StudyEvent::Kind;

constexpr const char* kJournalFormat = "hvas-study-journal-1";

template <typename E, std::size_t N>
bool ReadWord(const Json& json, const std::array<std::string_view, N>& words, E* value) {
  for (std::size_t i = 0; i < N; ++i) {
    if (json == words[i]) {
      *value = static_cast<E>(i);
      return true;
    }
  }
  return false;
}

Json MakeResultJson(const TrialResult& result) {
  Json mating = Json::array();
  for (const MatingSample& s : result.mating) {
    mating.push_back({s.t, s.f.x(), s.f.y(), s.f.z(), s.torque.x(), s.torque.y(), s.torque.z()});
  }
  Json json{{"outcome", kOutcomes[static_cast<std::size_t>(result.outcome)]}};
  if (result.time) {
    json["time_s"] = *result.time;
  }
  json["collisions"] = result.collisions;
  json["peak_felt_n"] = result.peak_felt;
  json["peak_true_n"] = result.peak_true;
  json["insertion_m"] = result.insertion;
  if (result.pair) {
    json["pair"] = {{"hole_diameter_m", result.pair->hole_diameter},
                    {"shaft_diameter_m", result.pair->shaft_diameter},
                    {"clearances_m", result.pair->clearances}};
  }
  json["mating"] = std::move(mating);
  return json;
}

/** Reads an integer; throws where an int cannot hold it. */
int ParseInt(const Json& json) {
  const double number = json.get<double>();
  if (!json.is_number_integer() || std::abs(number) > std::numeric_limits<int>::max()) {
    throw Json::other_error::create(0, "integer", nullptr);
  }
  return json.get<int>();
}

TrialResult ParseResult(const Json& json) {
  TrialResult result;
  if (!ReadWord(json.at("outcome"), kOutcomes, &result.outcome)) {
    throw Json::other_error::create(0, "outcome", nullptr);
  }
  if (json.contains("time_s")) {
    result.time = json.at("time_s").get<double>();
  }
  result.collisions = ParseInt(json.at("collisions"));
  result.peak_felt = json.at("peak_felt_n").get<double>();
  result.peak_true = json.at("peak_true_n").get<double>();
  result.insertion = json.at("insertion_m").get<double>();
  if (json.contains("pair")) {
    const Json& pair = json.at("pair");
    result.pair = TrialPair{pair.at("hole_diameter_m").get<double>(),
                            pair.at("shaft_diameter_m").get<double>(),
                            pair.at("clearances_m").get<std::vector<double>>()};
  }
  for (const Json& s : json.at("mating")) {
    const auto at = [&](std::size_t i) { return s.at(i).get<double>(); };
    result.mating.push_back({at(0), Vec3(at(1), at(2), at(3)), Vec3(at(4), at(5), at(6))});
  }
  return result;
}

Json MakeValueJson(const AnswerValue& value) {
  if (const int* number = std::get_if<int>(&value)) {
    return *number;
  }
  const std::string* text = std::get_if<std::string>(&value);
  return text != nullptr ? Json(*text) : Json(nullptr);
}

AnswerValue ParseValue(const Json& json) {
  if (json.is_number_integer()) {
    return ParseInt(json);
  }
  return json.is_string() ? AnswerValue(json.get<std::string>()) : AnswerValue();
}

Json MakeEventJson(const StudyEvent& event) {
  Json json{{"event", kEventKinds[static_cast<std::size_t>(event.kind)]}};
  if (event.unix_ms != 0) {
    json["unix_ms"] = event.unix_ms;
  }
  switch (event.kind) {
    case Kind::kConsent:
      json["agrees"] = event.agrees;
      json["language"] = event.language;
      break;
    case Kind::kTrialBegun:
      json["trial"] = event.trial;
      break;
    case Kind::kTrialEnded:
      json["trial"] = event.trial;
      json["result"] = MakeResultJson(event.result);
      break;
    case Kind::kAnswered:
      json["trial"] = event.trial;
      json["question"] = event.question;
      json["value"] = MakeValueJson(event.value);
      break;
    case Kind::kNote:
    case Kind::kAborted:
      json["text"] = event.text;
      break;
    case Kind::kBegun:
    case Kind::kTrainingBegun:
    case Kind::kTrainingEnded:
    case Kind::kResumed:
      break;
  }
  return json;
}

/** Parses an event of MakeEventJson(); throws nlohmann's exceptions for anything else. */
StudyEvent ParseEvent(const Json& json) {
  StudyEvent event;
  if (!ReadWord(json.at("event"), kEventKinds, &event.kind)) {
    throw Json::other_error::create(0, "event", nullptr);
  }
  event.unix_ms = json.value("unix_ms", std::int64_t{0});
  event.agrees = json.value("agrees", false);
  event.language = json.value("language", "");
  event.trial = json.value("trial", std::size_t{0});
  event.question = json.value("question", "");
  event.text = json.value("text", "");
  if (json.contains("value")) {
    event.value = ParseValue(json["value"]);
  }
  if (event.kind == Kind::kTrialEnded) {
    event.result = ParseResult(json.at("result"));
  }
  return event;
}

std::string SumOf(std::string_view text) {
  return fmt::format("{:016x}", Checksum64(std::as_bytes(std::span(text.data(), text.size()))));
}

std::string MakeLine(const Json& json) {
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text + "\t" + SumOf(text) + "\n";
}

/** Parses a line; none where it is incomplete or damaged. */
std::optional<Json> ParseLine(std::string_view line) {
  const std::size_t tab = line.rfind('\t');
  if (tab == std::string_view::npos || SumOf(line.substr(0, tab)) != line.substr(tab + 1)) {
    return std::nullopt;
  }
  Json json = ParseJson<Json>(line.substr(0, tab));
  return json.is_object() ? std::optional<Json>(std::move(json)) : std::nullopt;
}

Json MakeHeadJson(const JournalHead& head) {
  return {{"format", kJournalFormat},
          {"participant", head.participant},
          {"protocol", head.protocol},
          {"seed", head.seed},
          {"simulated", head.is_simulated}};
}

JournalHead ParseHead(const Json& json) {
  if (json.at("format") != kJournalFormat) {
    throw Json::other_error::create(0, "format", nullptr);
  }
  return {json.at("participant").get<std::string>(), json.at("protocol").get<std::string>(),
          json.at("seed").get<std::uint64_t>(), json.at("simulated").get<bool>()};
}

Unexpected FailDamaged(const std::filesystem::path& file, int line) {
  return Fail(ErrorCode::kUnreadable, "this line of the journal is damaged",
              fmt::format("{}:{}", file.string(), line),
              "restore the file from a copy; only the last line may be incomplete");
}

Unexpected FailAsRunning(const std::filesystem::path& file) {
  return Fail(ErrorCode::kInvalid, "another program runs the session of this participant",
              file.string(), "end that program first");
}

Unexpected FailToAppend(const std::filesystem::path& file, int error) {
  return Fail(ErrorCode::kOutOfResource,
              fmt::format("the journal cannot be written: {}", std::strerror(error)), file.string(),
              "free disk space, or make the folder writable");
}

}  // namespace

Result<ReadOnlyJournal> ReadJournal(const std::filesystem::path& file) {
  const Result<std::string> read = ReadRegularFile(file);
  if (!read) {
    return Unexpected(read.error());
  }
  const std::string& bytes = *read;
  ReadOnlyJournal journal;
  int number = 0;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = bytes.find('\n', at);
    if (end == std::string::npos) {
      break;  // an incomplete line
    }
    ++number;
    const auto json = ParseLine(std::string_view(bytes).substr(at, end - at));
    if (!json) {
      if (end + 1 == bytes.size()) {
        break;  // a power cut can leave the full length without all bytes
      }
      return FailDamaged(file, number);
    }
    try {
      if (number == 1) {
        journal.head = ParseHead(*json);
      } else {
        journal.events.push_back(ParseEvent(*json));
      }
    } catch (const Json::exception&) {
      return FailDamaged(file, number);
    }
    at = end + 1;
    journal.good_bytes = static_cast<std::int64_t>(at);
  }
  return journal;
}

Result<Journal> Journal::Open(const std::filesystem::path& file, const JournalHead& head,
                              bool is_synced) {
  // Journals are personal data: only this user may read them.
  constexpr mode_t kOwnerOnly = 0600;
  int error = 0;
  Journal journal(file, OpenLocked(file, kOwnerOnly, &error), is_synced);
  const int descriptor = journal.file_.value();
  if (error == EWOULDBLOCK) {
    return FailAsRunning(file);
  }
  if (error != 0) {
    const auto checked = CheckRegularFile(file);
    return checked ? FailToAppend(file, error) : Unexpected(checked.error());
  }
  auto old = ReadJournal(file);
  if (!old) {
    return Unexpected(old.error());
  }
  const bool is_new = old->good_bytes == 0;
  if (!is_new && MakeHeadJson(old->head) != MakeHeadJson(head)) {
    return Fail(ErrorCode::kInvalid,
                "this journal belongs to another participant, protocol or seed", file.string(),
                "use the folder with the protocol and seed that it was begun with");
  }
  journal.size_ = old->good_bytes;
  journal.events_ = std::move(old->events);
  if (::ftruncate(descriptor, old->good_bytes) != 0 ||
      ::lseek(descriptor, old->good_bytes, SEEK_SET) < 0) {
    return FailToAppend(file, errno);
  }
  if (is_new) {
    if (const auto written = journal.Write(MakeLine(MakeHeadJson(head))); !written) {
      return Unexpected(written.error());
    }
  }
  return journal;
}

Result<Descriptor> LockJournal(const std::filesystem::path& file) {
  auto opened = RegularFile::Open(file);
  if (!opened) {
    return Unexpected(opened.error());
  }
  Descriptor lock(::fcntl(opened->descriptor(), F_DUPFD_CLOEXEC, 0));
  return TryLock(lock) == EWOULDBLOCK ? Result<Descriptor>(FailAsRunning(file)) : std::move(lock);
}

Result<void> Journal::Write(const std::string& line) {
  int error = WriteAll(file_.value(), std::as_bytes(std::span(line.data(), line.size())));
  if (error == 0 && is_synced_ && ::fdatasync(file_.value()) != 0) {
    error = errno;
  }
  if (error != 0) {
    // The incomplete line is removed, so that the next one starts a new line.
    [[maybe_unused]] const int not_cut = ::ftruncate(file_.value(), size_);
    static_cast<void>(::lseek(file_.value(), size_, SEEK_SET));
    return FailToAppend(path_, error);
  }
  size_ += static_cast<std::int64_t>(line.size());
  return {};
}

Result<void> Journal::Append(const StudyEvent& event) {
  Result<void> written = Write(MakeLine(MakeEventJson(event)));
  if (written) {
    events_.push_back(event);
  }
  return written;
}

}  // namespace hvas::study
