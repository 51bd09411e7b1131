#include "study/study_folder.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/parse_json.h"
#include "base/regular_file.h"
#include "base/units.h"

namespace hvas::study {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFolderFormat = "hvas-study-folder-1";
constexpr const char* kHead = "study.json";

/** Files made from all journals, which therefore contain data of each participant. */
bool IsMadeOfAll(const fs::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".csv" || ending == ".html" || ending == ".pdf";
}

Unexpected FailToWrite(const fs::path& path, const std::error_code& failed) {
  return Fail(ErrorCode::kOutOfResource,
              fmt::format("this cannot be written: {}", failed.message()), path.string(),
              "choose another folder with -o");
}

Result<void> MakeFolder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (!failed) {
    fs::permissions(folder, fs::perms::owner_all, failed);
  }
  return failed ? Result<void>(FailToWrite(folder, failed)) : Result<void>();
}

/** Formats a CSV cell, quoted where RFC 4180 requires it. */
std::string Cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c == '"' ? "\"\"" : std::string(1, c);
  }
  return quoted + "\"";
}

std::string PrintValue(const AnswerValue& value) {
  if (const int* number = std::get_if<int>(&value)) {
    return fmt::format("{}", *number);
  }
  const std::string* text = std::get_if<std::string>(&value);
  return text != nullptr ? *text : "";
}

}  // namespace

Result<StudyFolder> StudyFolder::Create(const fs::path& folder, const Protocol& protocol,
                                        std::uint64_t seed) {
  std::error_code ignored;
  if (fs::exists(folder / kHead, ignored)) {
    auto old = Open(folder);
    if (old && (old->protocol().digest != protocol.digest || old->seed() != seed)) {
      return Fail(ErrorCode::kInvalid, "another study, or one with another seed, is in this folder",
                  folder.string(), "choose another folder with -o, or the study's own seed");
    }
    return old;
  }
  if (fs::exists(folder, ignored) && !fs::is_empty(folder, ignored)) {
    return Fail(ErrorCode::kInvalid, "the folder is not empty, and not the folder of a study",
                folder.string(), "choose another folder with -o");
  }
  for (const fs::path& one : {folder, folder / "participants", folder / "records"}) {
    if (const auto made = MakeFolder(one); !made) {
      return Unexpected(made.error());
    }
  }
  const std::string ending = protocol.file.extension() == ".json" ? ".json" : ".yaml";
  const Json head{{"format", kFolderFormat},
                  {"study", protocol.id},
                  {"protocol", "protocol" + ending},
                  {"digest", protocol.digest},
                  {"seed", seed}};
  const fs::path copy = folder / ("protocol" + ending);
  for (const auto& [file, text] :
       {std::pair(copy, protocol.text), std::pair(folder / kHead, head.dump(2) + "\n")}) {
    if (const auto written = WriteAtomically(file, text, FileReaders::kOwner); !written) {
      return Unexpected(written.error());
    }
  }
  return StudyFolder(folder, protocol, seed);
}

Result<StudyFolder> StudyFolder::Open(const fs::path& folder) {
  const Result<std::string> text = ReadRegularFile(folder / kHead);
  if (!text && text.error().code == ErrorCode::kNotFound) {
    return Fail(ErrorCode::kNotFound, "there is no study in this folder", folder.string(),
                "give the folder that `hvas study run` or the studio wrote with -o");
  }
  if (!text) {
    return Unexpected(text.error());
  }
  const Json head = ParseJson<Json>(*text);
  const auto text_of = [&head](const char* key) {
    const auto found = head.is_object() ? head.find(key) : head.end();
    return found != head.end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  if (text_of("format") != kFolderFormat || !head.contains("seed") ||
      !head["seed"].is_number_unsigned()) {
    return Fail(ErrorCode::kUnreadable, "the file is not the description of a study",
                (folder / kHead).string(), "restore the file from a copy");
  }
  const fs::path copy = folder / fs::path(text_of("protocol")).filename();
  auto protocol = ReadProtocol(copy);
  if (!protocol) {
    return Unexpected(protocol.error());
  }
  if (protocol->digest != text_of("digest")) {
    return Fail(ErrorCode::kUnreadable, "the protocol has changed since the study began",
                copy.string(), "restore the file from a copy; a changed protocol is another study");
  }
  return StudyFolder(folder, std::move(*protocol), head["seed"].get<std::uint64_t>());
}

std::vector<std::string> StudyFolder::ListParticipants() const {
  std::vector<std::string> ids;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder_ / "participants", failed)) {
    const std::string id = entry.path().stem().string();
    if (entry.path().extension() == ".jsonl" && ParseParticipantId(id)) {
      ids.push_back(id);
    }
  }
  std::sort(ids.begin(), ids.end(), [](const std::string& a, const std::string& b) {
    return *ParseParticipantId(a) < *ParseParticipantId(b);
  });
  return ids;
}

Result<Journal> StudyFolder::OpenJournal(const std::string& id, bool is_simulated) const {
  return Journal::Open(JournalFile(id), {id, protocol_->digest, seed_, is_simulated},
                       !is_simulated);
}

Result<Participant> StudyFolder::ReadParticipant(const std::string& id) const {
  const auto number = ParseParticipantId(id);
  if (!number) {
    return Unexpected(number.error());
  }
  const auto journal = ReadJournal(JournalFile(id));
  if (!journal) {
    return Unexpected(journal.error());
  }
  Participant participant{id, std::make_unique<StudySession>(protocol_.get(), *number, seed_),
                          journal->head.is_simulated};
  if (const auto applied = ApplyAll(journal->events, participant.session.get()); !applied) {
    return Unexpected(applied.error());
  }
  return participant;
}

Result<std::vector<Participant>> StudyFolder::ReadParticipants() const {
  std::vector<Participant> participants;
  for (const std::string& id : ListParticipants()) {
    auto participant = ReadParticipant(id);
    if (!participant) {
      return Unexpected(participant.error());
    }
    participants.push_back(std::move(*participant));
  }
  return participants;
}

fs::path StudyFolder::RecordFile(const std::string& id, std::size_t trial) const {
  const fs::path folder = folder_ / "records" / id;
  static_cast<void>(MakeFolder(folder));  // the recorder reports the error
  return folder / fmt::format("{:03}.hvasrec", trial + 1);
}

Result<std::vector<fs::path>> StudyFolder::Delete(const std::string& id) const {
  if (const auto number = ParseParticipantId(id); !number) {
    return Unexpected(number.error());
  }
  std::error_code failed;
  std::vector<fs::path> files;
  const fs::path records = folder_ / "records" / id;
  if (fs::exists(JournalFile(id), failed)) {
    files.push_back(JournalFile(id));
  }
  for (const auto& entry : fs::directory_iterator(records, failed)) {
    files.push_back(entry.path());
  }
  if (files.empty() && !fs::exists(records, failed)) {
    return Fail(ErrorCode::kNotFound, "there are no data of this participant", id,
                "`hvas study list` lists the participants");
  }
  for (const auto& entry : fs::directory_iterator(folder_, failed)) {
    if (IsMadeOfAll(entry.path())) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    if (!fs::remove(file, failed) || failed) {
      return FailToWrite(file, failed);
    }
  }
  fs::remove(records, failed);
  return files;
}

Result<void> ApplyAll(const std::vector<StudyEvent>& events, StudySession* session) {
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (const auto applied = session->Apply(events[i]); !applied) {
      return Fail(ErrorCode::kUnreadable,
                  fmt::format("event {} of the journal contradicts the protocol: {}", i + 1,
                              applied.error().ToString()),
                  FormatParticipantId(session->participant()), "restore the journal from a copy");
    }
  }
  return {};
}

namespace {

/** The columns of a pair. Clearances are of the diameter, as tolerances are, with the surface. */
std::string FormatPair(const std::optional<TrialPair>& pair) {
  if (!pair || pair->clearances.empty()) {
    return ",,,,,";
  }
  const auto& s = pair->clearances;
  const auto [least, most] = std::minmax_element(s.begin(), s.end());
  return fmt::format("{:.6f},{:.6f},{:.3f},{:.3f},{:.3f},", units::ToMm(pair->hole_diameter),
                     units::ToMm(pair->shaft_diameter), 2 * units::ToUm(*least),
                     units::ToUm(pair->hole_diameter - pair->shaft_diameter),
                     2 * units::ToUm(*most));
}

}  // namespace

std::string MakeTrialsCsv(const std::vector<Participant>& participants) {
  std::string csv =
      "participant,simulated,block,condition,repetition,trial,outcome,time_s,collisions,"
      "peak_force_n,peak_true_force_n,insertion_mm,hole_mm,shaft_mm,least_clearance_um,"
      "mean_clearance_um,largest_clearance_um,answer,is_right\r\n";
  for (const Participant& participant : participants) {
    const StudySession& session = *participant.session;
    for (const DoneTrial& done : session.done()) {
      const PlannedTrial& planned = session.schedule()[done.index];
      const TrialResult& r = done.result;
      const bool is_answered = !done.answer.empty();
      const bool is_right = done.answer == AnswerNameOf(session.ConditionOf(done.index));
      csv += fmt::format("{},{},{},{},{},{},{},", participant.id, participant.is_simulated ? 1 : 0,
                         session.BlockOf(done.index).id, session.ConditionOf(done.index).id,
                         planned.repetition, done.index + 1,
                         kOutcomes[static_cast<std::size_t>(r.outcome)]);
      csv += r.time ? fmt::format("{},{},{},{},{},", *r.time, r.collisions, r.peak_felt,
                                  r.peak_true, units::ToMm(r.insertion))
                    : ",,,,,";
      csv += FormatPair(r.pair);
      csv += fmt::format("{},{}\r\n", Cell(done.answer), is_answered ? (is_right ? "1" : "0") : "");
    }
  }
  return csv;
}

std::string MakeAnswersCsv(const std::vector<Participant>& participants) {
  std::string csv = "participant,simulated,question,after_trial,value\r\n";
  for (const Participant& participant : participants) {
    for (const GivenAnswer& answer : participant.session->answers()) {
      csv += fmt::format("{},{},{},{},{}\r\n", participant.id, participant.is_simulated ? 1 : 0,
                         answer.question, answer.trial ? fmt::format("{}", *answer.trial + 1) : "",
                         Cell(PrintValue(answer.value)));
    }
  }
  return csv;
}

}  // namespace hvas::study
