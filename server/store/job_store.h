#ifndef BCCSKEL_SERVER_STORE_JOB_STORE_H_
#define BCCSKEL_SERVER_STORE_JOB_STORE_H_

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/rows.h"
#include "server/store/sql_database.h"

namespace bccskel::server {

// Tables of uploads, volumes, jobs, their events and results. Changes are made between Begin() and
// Commit(); what Commit() has confirmed survives a crash of the process and the machine. Nobody
// else, not even another server of a fleet, changes anything in between, so what a transaction has
// read holds until its end.
// Errors of all: RESOURCE_EXHAUSTED when the disk is full; DATA_LOSS for a damaged file or row;
// UNAVAILABLE when the database cannot be reached: the changes of a failed Commit() may then have
// happened or not; INTERNAL. Finding nothing is not an error.
// Every row has a checksum. Functions that list rows skip damaged ones and count them, except for
// ListJobs() and EventsAfter(), whose callers would take the rest for everything.
// Threads: one at a time.
class JobStore {
 public:
  explicit JobStore(std::unique_ptr<SqlDatabase> database) : database_(std::move(database)) {}

  // Identifies the store; chosen when it is first opened.
  absl::StatusOr<std::string> Id();
  // DATA_LOSS when a damaged row was found since the store was opened, and when its file is gone or
  // replaced: writes would then be lost. Threads: safe.
  absl::Status Health() const;
  int damaged_rows() const { return damaged_rows_; }  // found since it was opened. Threads: safe.

  // Errors: DATA_LOSS for a missing file, as in Health(); UNAVAILABLE when this server was fenced
  //         off.
  absl::Status Begin();
  // An error means that nothing since Begin() has happened.
  absl::Status Commit();
  void Rollback();
  // Steps within a transaction, which can be rolled back individually.
  absl::Status BeginStep();
  // Increases with every statement that has changed something or failed: a step that leaves it
  // unchanged needs no rollback.
  uint64_t traces() const { return traces_; }
  absl::Status KeepStep();
  absl::Status UndoStep();

  // ---- Rows of any kind
  // For uploads and events; the functions below insert other rows.
  template <typename Row>
  absl::Status Insert(const Row& row) {
    return Put(row, "");
  }
  // For uploads, volumes and removals. Replaces a row of the same name.
  template <typename Row>
  absl::Status Put(const Row& row);
  // For uploads, volumes and jobs, which have names.
  template <typename Row>
  absl::StatusOr<std::optional<Row>> Find(const std::string& tenant, const std::string& name);
  // The same, but NOT_FOUND with the name if there is none.
  template <typename Row>
  absl::StatusOr<Row> Get(const std::string& tenant, const std::string& name);
  // For uploads and jobs. Deletes a job with its events, even if it is damaged.
  template <typename Row>
  absl::Status Delete(const std::string& tenant, const std::string& name);
  // For uploads, volumes, results and removals.
  template <typename Row>
  absl::StatusOr<std::vector<Row>> All();

  // Also deletes the finished uploads that the volume came from.
  absl::Status DeleteVolume(const std::string& tenant, const std::string& name);
  // The volumes with this blob or volume digest.
  absl::StatusOr<std::vector<VolumeRow>> FindVolumesOf(const std::string& tenant,
                                                       const std::string& digest);

  // Yields the job's number.
  absl::StatusOr<int64_t> InsertJob(JobRow row);
  // Yields false and does nothing if the stored job has ended or is gone, or if its sequence is not
  // `from`.
  absl::StatusOr<bool> UpdateJob(const JobRow& row, std::optional<uint64_t> from = std::nullopt);
  // Also deletes its events.
  absl::Status DeleteJob(int64_t number);
  absl::StatusOr<std::optional<JobRow>> FindJobOfRequest(const std::string& tenant,
                                                         const std::string& request_id);
  // The jobs after `after`, or all, in any of `states` (one bit per state, by number): newest
  // first, jobs of the same time by name.
  absl::StatusOr<std::vector<JobRow>> ListJobs(const std::string& tenant,
                                               const std::optional<JobPosition>& after,
                                               uint32_t states, int most);
  absl::StatusOr<std::vector<JobRow>> UnfinishedJobs();  // oldest first
  absl::StatusOr<std::vector<JobRow>> JobsEndedBefore(Time time, int most);
  // The name of an unfinished job that needs the volume.
  absl::StatusOr<std::optional<std::string>> UserOfVolume(const std::string& tenant,
                                                          const std::string& volume);

  absl::StatusOr<std::vector<EventRow>> EventsAfter(int64_t job, uint64_t sequence);

  // Yields the stored row: the new one with its number, or the existing one with this key. Takes
  // the place and the number of a damaged one, which repairs the jobs that refer to it.
  absl::StatusOr<ResultRow> InsertResult(ResultRow row);
  // Marks the file of the result as damaged: it is found by its number only, no longer by its key.
  absl::Status DropResult(const ResultRow& row);
  absl::StatusOr<std::optional<ResultRow>> FindResult(int64_t number);
  absl::StatusOr<std::optional<ResultRow>> FindResultOf(const std::string& tenant,
                                                        const std::string& key);
  // Deletes and yields the result if no job refers to it any more.
  absl::StatusOr<std::optional<ResultRow>> TakeResultIfUnused(int64_t number);

  absl::Status DeleteRemoval(const RemovalRow& row);

  // Bytes of all files that the tables name, by tenant; unfinished uploads count as declared.
  absl::StatusOr<std::map<std::string, uint64_t>> DiskUse();

  // Whether other servers may use the same tables.
  bool shared() const { return database_->shared(); }
  // ---- The fleet. Needs of these: shared().

  // Registers the server: its transactions fail once it is fenced off. Needs: a unique name, never
  // used before, of hexadecimal digits.
  absl::Status Join(const std::string& server);
  absl::Status Leave();
  // Whether a transaction has failed because this server was fenced off: it must then join again.
  bool fenced() const { return fenced_; }
  // Records a heartbeat of this server.
  absl::Status Beat();
  absl::StatusOr<std::vector<Member>> Members();
  // Removes the member unless it has had a heartbeat since. Yields whether it was removed: it can
  // then write nothing any more. Needs: a transaction.
  absl::StatusOr<bool> Fence(const Member& member);
  // The jobs that have changed since change `number`; with -1, all unfinished ones.
  absl::StatusOr<JobChanges> ChangesAfter(int64_t number);
  // Whether another server runs a job with the same options and volume.
  absl::StatusOr<bool> RunsElsewhere(const JobRow& job, const std::string& volume_digest,
                                     const std::string& server);
  // The newest progress of a running job, for the other servers.
  absl::Status PutProgress(int64_t job, const ProgressRow& progress);
  absl::StatusOr<std::optional<ProgressRow>> FindProgress(int64_t job);
  // Erases deleted data from the store's files.
  absl::Status Forget();

 private:
  enum class Damaged { kFails, kLeftOut };

  absl::StatusOr<std::vector<SqlRow>> Execute(const std::string& sql,
                                              const std::vector<SqlValue>& values);
  template <typename... Values>
  absl::StatusOr<std::vector<SqlRow>> Query(const std::string& sql, const Values&... values);
  template <typename... Values>
  absl::Status Run(const std::string& sql, const Values&... values);
  // Inserts the row. If one with the same `key` exists, replaces its other columns except its
  // number.
  template <typename Row>
  absl::Status Put(const Row& row, const std::string& key);
  // `where` follows the table's name. kLeftOut is for callers that process all rows and must not
  // stop at a damaged one.
  template <typename Row, typename... Values>
  absl::StatusOr<std::vector<Row>> Select(Damaged damaged, const std::string& where,
                                          const Values&... values);
  template <typename Row, typename... Values>
  absl::StatusOr<std::optional<Row>> One(Damaged damaged, const std::string& where,
                                         const Values&... values);

  const std::unique_ptr<SqlDatabase> database_;
  std::string server_;  // empty before Join()
  bool fenced_ = false;
  uint64_t traces_ = 0;
  std::atomic<int> damaged_rows_ = 0;
};

// A job store in an SQLite file, created if missing.
// Errors: FAILED_PRECONDITION for a file of a newer version; DATA_LOSS for a damaged one.
absl::StatusOr<std::unique_ptr<JobStore>> OpenSqliteJobStore(const std::string& path);

// A job store in a PostgreSQL database, given as a URL or a connection string of libpq. Missing
// tables are created by one of the servers that start at the same time.
// Errors: INVALID_ARGUMENT for a name that libpq cannot parse or that contains a password;
//         FAILED_PRECONDITION for tables of a newer version; UNAVAILABLE; UNIMPLEMENTED in a
//         program built without libpq.
absl::StatusOr<std::unique_ptr<JobStore>> OpenPostgresJobStore(const std::string& database);
// Errors: INVALID_ARGUMENT for a URL that cannot be parsed or contains a password.
absl::Status CheckPostgresName(const std::string& database);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_JOB_STORE_H_
