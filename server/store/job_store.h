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
  explicit JobStore(std::unique_ptr<SqlDatabase> database) : database_(std::move(database)) {}

  // A store has one of its own from its first opening on.
  absl::StatusOr<std::string> Id();
  // DATA_LOSS when a row was found damaged since the store was opened, and when its file is gone or
  // another one has its name: what is written then is lost. Threads: safe.
  absl::Status Health() const;
  int damaged_rows() const { return damaged_rows_; }  // found since it was opened. Threads: safe.

  // Errors: a file that is gone, as Health() says; UNAVAILABLE when this server was fenced off.
  absl::Status Begin();
  // After an error nothing since Begin() has happened.
  absl::Status Commit();
  void Rollback();
  // Steps within a transaction, each of which can be taken back alone.
  absl::Status BeginStep();
  // Grows with every statement that has changed something, or has failed: a step without one leaves
  // nothing to take back.
  uint64_t traces() const { return traces_; }
  absl::Status KeepStep();
  absl::Status UndoStep();

  // ---- Rows of any kind
  // Of uploads and events: others are inserted by what follows.
  template <typename Row>
  absl::Status Insert(const Row& row) {
    return Put(row, "");
  }
  // Of uploads, volumes and removals. Replaces a row of the same name.
  template <typename Row>
  absl::Status Put(const Row& row);
  // Of uploads, volumes and jobs, which have names.
  template <typename Row>
  absl::StatusOr<std::optional<Row>> Find(const std::string& tenant, const std::string& name);
  // The same. Errors besides: NOT_FOUND with the name, for callers.
  template <typename Row>
  absl::StatusOr<Row> Get(const std::string& tenant, const std::string& name);
  // Of uploads and jobs; of a job with its events, also where it is damaged.
  template <typename Row>
  absl::Status Delete(const std::string& tenant, const std::string& name);
  // Of uploads, volumes, results and removals.
  template <typename Row>
  absl::StatusOr<std::vector<Row>> All();

  // With the finished uploads that it came with.
  absl::Status DeleteVolume(const std::string& tenant, const std::string& name);
  // By blob or volume digest.
  absl::StatusOr<std::vector<VolumeRow>> FindVolumesOf(const std::string& tenant,
                                                       const std::string& digest);

  // Yields its number.
  absl::StatusOr<int64_t> InsertJob(JobRow row);
  // False, and nothing happens, when the stored job has ended already or is gone, or has another
  // sequence than `from`.
  absl::StatusOr<bool> UpdateJob(const JobRow& row, std::optional<uint64_t> from = std::nullopt);
  // With its events.
  absl::Status DeleteJob(int64_t number);
  absl::StatusOr<std::optional<JobRow>> FindJobOfRequest(const std::string& tenant,
                                                         const std::string& request_id);
  // Those that come after `after`, or all, in one of the states (a bit each, by number): newest
  // first, and by name where they are of the same time.
  absl::StatusOr<std::vector<JobRow>> ListJobs(const std::string& tenant,
                                               const std::optional<JobPosition>& after,
                                               uint32_t states, int most);
  absl::StatusOr<std::vector<JobRow>> UnfinishedJobs();  // oldest first
  absl::StatusOr<std::vector<JobRow>> JobsEndedBefore(Time time, int most);
  // The name of an unfinished job that needs the volume.
  absl::StatusOr<std::optional<std::string>> UserOfVolume(const std::string& tenant,
                                                          const std::string& volume);

  absl::StatusOr<std::vector<EventRow>> EventsAfter(int64_t job, uint64_t sequence);

  // Yields what is stored: the row with its number, or the result that already has this key.
  // Takes the place and the number of a damaged one, so that it heals the jobs that have that.
  absl::StatusOr<ResultRow> InsertResult(ResultRow row);
  // Its file is damaged: it is not found by its key any more, but by its number.
  absl::Status DropResult(const ResultRow& row);
  absl::StatusOr<std::optional<ResultRow>> FindResult(int64_t number);
  absl::StatusOr<std::optional<ResultRow>> FindResultOf(const std::string& tenant,
                                                        const std::string& key);
  // Deletes the result when no job has it any more, and then yields it.
  absl::StatusOr<std::optional<ResultRow>> TakeResultIfUnused(int64_t number);

  absl::Status DeleteRemoval(const RemovalRow& row);

  // Bytes of all files that the tables name, by tenant; of unfinished uploads as declared.
  absl::StatusOr<std::map<std::string, uint64_t>> DiskUse();

  // Whether other servers may use the same tables.
  bool shared() const { return database_->shared(); }
  // ---- The fleet. Needs of these: shared().

  // From now on transactions are this server's, and fail once it was fenced off. Needs: a name that
  // no server ever had, of hexadecimal digits.
  absl::Status Join(const std::string& server);
  absl::Status Leave();
  // Whether a transaction has failed since, because this server was fenced off: it has to join
  // anew.
  bool fenced() const { return fenced_; }
  // One more sign of life of this server.
  absl::Status Beat();
  absl::StatusOr<std::vector<Member>> Members();
  // Needs: a transaction. Takes the member away, unless it has given a sign of life since. Yields
  // whether it was there: then it writes nothing any more.
  absl::StatusOr<bool> Fence(const Member& member);
  // What has become of jobs since a change; from -1 on the unfinished ones as they are.
  absl::StatusOr<JobChanges> ChangesAfter(int64_t number);
  // A job with the same options, of the same volume, that another server runs.
  absl::StatusOr<bool> RunsElsewhere(const JobRow& job, const std::string& volume_digest,
                                     const std::string& server);
  // The newest progress of a running job, for the other servers.
  absl::Status PutProgress(int64_t job, const ProgressRow& progress);
  absl::StatusOr<std::optional<ProgressRow>> FindProgress(int64_t job);
  // What was deleted is then nowhere in the store's files any more.
  absl::Status Forget();

 private:
  enum class Damaged { kFails, kLeftOut };

  absl::StatusOr<std::vector<SqlRow>> Execute(const std::string& sql,
                                              const std::vector<SqlValue>& values);
  template <typename... Values>
  absl::StatusOr<std::vector<SqlRow>> Query(const std::string& sql, const Values&... values);
  template <typename... Values>
  absl::Status Run(const std::string& sql, const Values&... values);
  // Where there is a row with the same `key`, its other columns are replaced, but for its number.
  template <typename Row>
  absl::Status Put(const Row& row, const std::string& key);
  // `where` follows the table's name. For who looks after everything, and must not stop at a row
  // that is damaged, those are left out.
  template <typename Row, typename... Values>
  absl::StatusOr<std::vector<Row>> Select(Damaged damaged, const std::string& where,
                                          const Values&... values);
  template <typename Row, typename... Values>
  absl::StatusOr<std::optional<Row>> One(Damaged damaged, const std::string& where,
                                         const Values&... values);

  const std::unique_ptr<SqlDatabase> database_;
  std::string server_;  // empty before it has joined
  bool fenced_ = false;
  uint64_t traces_ = 0;
  std::atomic<int> damaged_rows_ = 0;
};

// A job store in a file of SQLite, which is made where it does not exist.
// Errors: FAILED_PRECONDITION for a file of a newer version; DATA_LOSS for a damaged one.
absl::StatusOr<std::unique_ptr<JobStore>> OpenSqliteJobStore(const std::string& path);

// A job store in a PostgreSQL database, named by a URL or libpq's words. Its tables are made where
// they do not exist, by one server of those that come at the same time.
// Errors: INVALID_ARGUMENT for a name that libpq does not understand, or that has a password in it;
//         FAILED_PRECONDITION for tables of a newer version; UNAVAILABLE; UNIMPLEMENTED in a
//         program that was built without libpq.
absl::StatusOr<std::unique_ptr<JobStore>> OpenPostgresJobStore(const std::string& database);
// Errors: INVALID_ARGUMENT for a URL that cannot be read or holds a password.
absl::Status CheckPostgresName(const std::string& database);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_JOB_STORE_H_
