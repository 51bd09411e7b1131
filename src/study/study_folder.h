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

/** A participant's session, read from the folder. */
struct Participant {
  std::string id;
  std::unique_ptr<StudySession> session;
  bool is_simulated{false};
};

/** The folder of a study:

     study.json               seed, and digest of the protocol
     protocol.yaml            copy of the protocol (protocol.json where it is JSON)
     participants/P01.jsonl   journals
     records/P01/001.hvasrec  records of trials
     trials.csv, report.html  results, made from the journals; they can be made again

 Only this user has access to it. */
class StudyFolder {
 public:
  /** Begins a study in a folder that is missing or empty, or opens one with an equal protocol and
   seed. Errors: kInvalid for the folder of another study. */
  [[nodiscard]] static Result<StudyFolder> Create(const std::filesystem::path& folder,
                                                  const Protocol& protocol, std::uint64_t seed);

  /** Opens a study. Errors: kNotFound when there is none; kUnreadable when the copy of the protocol
   has changed since the study began. */
  [[nodiscard]] static Result<StudyFolder> Open(const std::filesystem::path& folder);

  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }

  /** Protocol of the study; its address stays valid when this object is moved. */
  [[nodiscard]] const Protocol& protocol() const { return *protocol_; }

  [[nodiscard]] std::uint64_t seed() const { return seed_; }

  /** Lists the ids of participants with a journal, in ascending order. */
  [[nodiscard]] std::vector<std::string> ListParticipants() const;

  /** Opens or begins the journal of a participant. @param id  An id that ParseParticipantId
   accepts. Errors: those of Journal::Open. */
  [[nodiscard]] Result<Journal> OpenJournal(const std::string& id, bool is_simulated) const;

  /** Restores the sessions of one or all participants. Errors: those of their journals. */
  [[nodiscard]] Result<Participant> ReadParticipant(const std::string& id) const;
  [[nodiscard]] Result<std::vector<Participant>> ReadParticipants() const;

  /** Path of a trial's record; makes its folders. @param trial  Index into the schedule. */
  [[nodiscard]] std::filesystem::path RecordFile(const std::string& id, std::size_t trial) const;

  /** Deletes all data of a participant: journal, records, and the results made from all journals.
   Errors: kNotFound when there are none; kInvalid while the participant's session runs. @returns
   the deleted files. */
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

/** Applies the events of a journal to a session. Errors: kUnreadable for an event that contradicts
 the protocol. */
[[nodiscard]] Result<void> ApplyAll(const std::vector<StudyEvent>& events, StudySession* session);

/** Makes a CSV table (RFC 4180) with one row for each trial of each participant:
 participant,simulated,block,condition,repetition,trial,outcome,time_s,collisions,peak_force_n,
 peak_true_force_n,insertion_mm, the pair's hole_mm,shaft_mm,least_clearance_um,mean_clearance_um,
 largest_clearance_um (diametral; least and largest with the surface), answer,is_right. Missing
 values are empty cells. */
[[nodiscard]] std::string MakeTrialsCsv(const std::vector<Participant>& participants);

/** Makes a CSV table of all answers: participant,simulated,question,after_trial,value. */
[[nodiscard]] std::string MakeAnswersCsv(const std::vector<Participant>& participants);

}  // namespace hvas::study
