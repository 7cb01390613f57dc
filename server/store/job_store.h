#ifndef BCCSKEL_SERVER_STORE_JOB_STORE_H_
#define BCCSKEL_SERVER_STORE_JOB_STORE_H_

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/rows.h"

namespace bccskel::server {

// Tables of uploads, volumes, jobs, their events and results. Changes are made within Begin() and
// Commit(); what Commit() has confirmed survives the process and the machine. Nobody else changes
// anything in between, be it another server of a fleet: so what a transaction has found holds until
// its end.
// Errors of all: RESOURCE_EXHAUSTED when the disk is full; DATA_LOSS for a damaged file or row;
// UNAVAILABLE when the database cannot be reached just now: then what Commit() was to confirm may
// have happened, or not; INTERNAL. Looking for what is not there is no error.
// Every row has a checksum. What yields a list of rows leaves damaged ones out and counts them, but
// for ListJobs() and EventsAfter(), whose callers would take the rest for everything.
// Threads: one at a time.
class JobStore {
 public:
  virtual ~JobStore() = default;

  // A store has one of its own from its first opening on.
  virtual absl::StatusOr<std::string> Id() = 0;
  // DATA_LOSS when a row was found damaged since the store was opened, and when its file is gone or
  // another one has its name: what is written then is lost. Threads: safe.
  virtual absl::Status Health() const = 0;
  virtual int damaged_rows() const = 0;  // found since it was opened. Threads: safe.

  // Errors: a file that is gone, as Health() says; UNAVAILABLE when this server was fenced off.
  virtual absl::Status Begin() = 0;
  // After an error nothing since Begin() has happened.
  virtual absl::Status Commit() = 0;
  virtual void Rollback() = 0;
  // Steps within a transaction, each of which can be taken back alone.
  virtual absl::Status BeginStep() = 0;
  virtual absl::Status KeepStep() = 0;
  virtual absl::Status UndoStep() = 0;

  virtual absl::Status InsertUpload(const UploadRow& row) = 0;
  virtual absl::Status UpdateUpload(const UploadRow& row) = 0;  // its volume, file and last use
  virtual absl::Status DeleteUpload(const std::string& tenant, const std::string& name) = 0;
  virtual absl::StatusOr<std::optional<UploadRow>> FindUpload(const std::string& tenant,
                                                              const std::string& name) = 0;
  virtual absl::StatusOr<std::vector<UploadRow>> AllUploads() = 0;

  // Replaces a row of the same name.
  virtual absl::Status PutVolume(const VolumeRow& row) = 0;
  // With the finished uploads that it came with.
  virtual absl::Status DeleteVolume(const std::string& tenant, const std::string& name) = 0;
  virtual absl::StatusOr<std::optional<VolumeRow>> FindVolume(const std::string& tenant,
                                                              const std::string& name) = 0;
  // By blob or volume digest.
  virtual absl::StatusOr<std::vector<VolumeRow>> FindVolumesOf(const std::string& tenant,
                                                               const std::string& digest) = 0;
  virtual absl::StatusOr<std::vector<VolumeRow>> AllVolumes() = 0;

  // Yields its number.
  virtual absl::StatusOr<int64_t> InsertJob(const JobRow& row) = 0;
  // False, and nothing happens, when the stored job has ended already or is gone.
  virtual absl::StatusOr<bool> UpdateJob(const JobRow& row) = 0;
  // With its events.
  virtual absl::Status DeleteJob(int64_t number) = 0;
  virtual absl::Status DeleteDamagedJob(const std::string& tenant, const std::string& name) = 0;
  virtual absl::StatusOr<std::optional<JobRow>> FindJob(const std::string& tenant,
                                                        const std::string& name) = 0;
  virtual absl::StatusOr<std::optional<JobRow>> FindJobOfRequest(const std::string& tenant,
                                                                 const std::string& request_id) = 0;
  // Those that come after `after`, or all, in one of the states (a bit each, by number): newest
  // first, and by name where they are of the same time.
  virtual absl::StatusOr<std::vector<JobRow>> ListJobs(const std::string& tenant,
                                                       const std::optional<JobPosition>& after,
                                                       uint32_t states, int most) = 0;
  virtual absl::StatusOr<std::vector<JobRow>> UnfinishedJobs() = 0;  // oldest first
  virtual absl::StatusOr<std::vector<JobRow>> JobsEndedBefore(Time time, int most) = 0;
  // The name of an unfinished job that needs the volume.
  virtual absl::StatusOr<std::optional<std::string>> UserOfVolume(const std::string& tenant,
                                                                  const std::string& volume) = 0;

  virtual absl::Status InsertEvent(const EventRow& row) = 0;
  virtual absl::StatusOr<std::vector<EventRow>> EventsAfter(int64_t job, uint64_t sequence) = 0;

  // Yields its number, or that of the result which already has this key: then `row` is not stored.
  // Takes the place and the number of a damaged one, so that it heals the jobs that have that.
  virtual absl::StatusOr<int64_t> InsertResult(const ResultRow& row) = 0;
  // Its file is damaged: it is not found by its key any more, but by its number.
  virtual absl::Status DropResult(const ResultRow& row) = 0;
  virtual absl::StatusOr<std::optional<ResultRow>> FindResult(int64_t number) = 0;
  virtual absl::StatusOr<std::optional<ResultRow>> FindResultOf(const std::string& tenant,
                                                                const std::string& key) = 0;
  // Deletes the result when no job has it any more, and then yields it.
  virtual absl::StatusOr<std::optional<ResultRow>> TakeResultIfUnused(int64_t number) = 0;
  virtual absl::StatusOr<std::vector<ResultRow>> AllResults() = 0;

  virtual absl::Status InsertRemoval(const RemovalRow& row) = 0;
  virtual absl::Status DeleteRemoval(const RemovalRow& row) = 0;
  virtual absl::StatusOr<std::vector<RemovalRow>> AllRemovals() = 0;

  // ---- The fleet. Where nobody shares the store, the one server that has it is all of it.

  // Whether other servers may use the same tables.
  virtual bool shared() const = 0;
  // From now on transactions are this server's, and fail once it was fenced off. Needs: a name that
  // no server ever had, of hexadecimal digits.
  virtual absl::Status Join(const std::string& server) = 0;
  virtual absl::Status Leave() = 0;
  // Whether a transaction has failed since, because this server was fenced off: it has to join
  // anew.
  virtual bool fenced() const = 0;
  // One more sign of life of this server.
  virtual absl::Status Beat() = 0;
  virtual absl::StatusOr<std::vector<Member>> Members() = 0;
  // Needs: a transaction. Takes the member away, unless it has given a sign of life since. Yields
  // whether it was there: then it writes nothing any more.
  virtual absl::StatusOr<bool> Fence(const Member& member) = 0;
  // What has become of jobs since a change; from -1 on the unfinished ones as they are.
  virtual absl::StatusOr<JobChanges> ChangesAfter(int64_t number) = 0;
  // A job with the same options, of the same volume, that another server runs.
  virtual absl::StatusOr<bool> RunsElsewhere(const JobRow& job, const std::string& volume_digest,
                                             const std::string& server) = 0;
  // Bytes of all files that the tables name, by tenant; of unfinished uploads as declared.
  virtual absl::StatusOr<std::map<std::string, uint64_t>> DiskUse() = 0;

  // What was deleted is then nowhere in the store's files any more.
  virtual absl::Status Forget() = 0;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_JOB_STORE_H_
