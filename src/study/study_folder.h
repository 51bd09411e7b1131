#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "study/journal.h"
#include "study/protocol.h"
#include "study/study_session.h"

namespace hvas::study {

/** A participant as the folder has it. */
struct Participant {
  std::string id;
  std::unique_ptr<StudySession> session;
  bool is_simulated{false};
};

/** The folder of a study:

     study.json            what it is: seed, digest of the protocol
     protocol.yaml         a copy of it, .json where it is that
     participants/P01.jsonl   journals
     records/P01/001.hvasrec  records of trials
     trials.csv, report.html  made of them, at any time again

 Only the user may look into it. */
class StudyFolder {
 public:
  /** Begins a study in a folder that is not there, or is empty; or opens it where the same protocol
   and seed are there already. Errors: kInvalid for another study's folder. */
  [[nodiscard]] static Result<StudyFolder> Create(const std::filesystem::path& folder,
                                                  const Protocol& protocol, std::uint64_t seed);

  /** Errors: kNotFound where there is no study; kUnreadable where the copy of the protocol is not
   the one that the study began with. */
  [[nodiscard]] static Result<StudyFolder> Open(const std::filesystem::path& folder);

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

  /** Stays where it is for as long as this object, or one that it was moved to. */
  [[nodiscard]] const Protocol& protocol() const { return *protocol_; }

  [[nodiscard]] std::uint64_t seed() const { return seed_; }

  /** Ids of those who have a journal, in their order. */
  [[nodiscard]] std::vector<std::string> ListParticipants() const;

  /** Begins or goes on with a participant's journal. @param id  Of a form that ParseParticipantId
   takes. */
  [[nodiscard]] Result<Journal> OpenJournal(const std::string& id, bool is_simulated) const;

  /** Where they stand. Errors: the journal's. */
  [[nodiscard]] Result<Participant> ReadParticipant(const std::string& id) const;
  [[nodiscard]] Result<std::vector<Participant>> ReadParticipants() const;

  /** Where a trial's record belongs; makes the folders. @param trial  Index into the schedule. */
  [[nodiscard]] std::filesystem::path RecordFile(const std::string& id, std::size_t trial) const;

  /** Removes all of a participant: journal, records, and what was made of all journals together.
   Errors: kNotFound where there is nothing of them. @returns the files that were removed. */
  [[nodiscard]] Result<std::vector<std::filesystem::path>> Delete(const std::string& id) const;

 private:
  StudyFolder(std::filesystem::path folder, Protocol protocol, std::uint64_t seed)
      : folder_(std::move(folder)),
        protocol_(std::make_unique<Protocol>(std::move(protocol))),
        seed_(seed) {}

  [[nodiscard]] std::filesystem::path JournalFile(const std::string& id) const {
    return folder_ / "participants" / (id + ".jsonl");
  }

  std::filesystem::path folder_;
  std::unique_ptr<Protocol> protocol_;
  std::uint64_t seed_;
};

/** Applies the events of a journal to a session. Errors: kUnreadable for one that cannot have
 happened. */
[[nodiscard]] Result<void> ApplyAll(const std::vector<StudyEvent>& events, StudySession* session);

/** All trials of all participants, a row each, as RFC 4180 has tables:
 participant,simulated,block,condition,repetition,trial,outcome,time_s,collisions,peak_force_n,
 peak_true_force_n,insertion_mm,answer,is_right. What is not known is an empty cell. */
[[nodiscard]] std::string MakeTrialsCsv(const std::vector<Participant>& participants);

/** All answers: participant,simulated,question,after_trial,value. */
[[nodiscard]] std::string MakeAnswersCsv(const std::vector<Participant>& participants);

}  // namespace hvas::study
