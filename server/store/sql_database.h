#ifndef BCCSKEL_SERVER_STORE_SQL_DATABASE_H_
#define BCCSKEL_SERVER_STORE_SQL_DATABASE_H_

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace bccskel::server {

// A parameter of a statement, or a column of its result.
struct SqlValue {
  enum class Kind { kNumber, kText, kBlob };

  static SqlValue Number(int64_t number) { return {Kind::kNumber, number, {}}; }
  static SqlValue Text(std::string bytes) { return {Kind::kText, 0, std::move(bytes)}; }
  static SqlValue Blob(std::string bytes) { return {Kind::kBlob, 0, std::move(bytes)}; }

  Kind kind = Kind::kNumber;
  int64_t number = 0;
  std::string bytes;
};

// One row, read from left to right.
class SqlRow {
 public:
  explicit SqlRow(std::vector<SqlValue> values) : values_(std::move(values)) {}
  const std::vector<SqlValue>& values() const { return values_; }
  int64_t Number() { return values_[next_++].number; }
  std::string Text() { return std::move(values_[next_++].bytes); }

 private:
  std::vector<SqlValue> values_;
  size_t next_ = 0;
};

// A connection to a database. Statements are written for both SQLite and PostgreSQL: $1, $2, ...
// are the parameters, first used in this order; text is compared as bytes.
// Errors of all: RESOURCE_EXHAUSTED (full disk); DATA_LOSS (damaged); UNAVAILABLE (locked or
// unreachable); INTERNAL.
// Threads: one at a time, except for Health().
class SqlDatabase {
 public:
  virtual ~SqlDatabase() = default;

  // Any number of statements without parameters or result rows.
  virtual absl::Status Execute(const std::string& sql) = 0;
  // One statement. Each distinct one is prepared once and kept, so there must not be many.
  virtual absl::StatusOr<std::vector<SqlRow>> Run(const std::string& sql,
                                                  const std::vector<SqlValue>& values) = 0;

  // Nobody else writes until the end of the transaction. Errors: ABORTED when `server`, if not
  // empty, is not a member of the fleet.
  virtual absl::Status Begin(const std::string& server) = 0;
  virtual bool InTransaction() const = 0;
  // An SQL expression for the number of the table's next row.
  virtual std::string NextNumber(const std::string& table) const = 0;

  // Called once the tables were found to be in order, before the first change and by one thread:
  // notes in the database itself that it has a log, so that the next process misses a lost one.
  virtual void BeginUse() {}
  virtual absl::Status Health() const = 0;
  // Erases deleted data from the files, as far as this program controls them.
  virtual absl::Status Forget() = 0;
  // Whether other servers may use the database.
  virtual bool shared() const = 0;
};

// An SQLite file in WAL mode with full synchronization, created if missing. Health() is DATA_LOSS,
// and no transaction begins, when the file or its log (the WAL) is no longer at its path. SQL has
// an additional function checksum(...): CRC-32C of its arguments and their types.
absl::StatusOr<std::unique_ptr<SqlDatabase>> OpenSqlite(const std::string& path);

// Whether the SQLite file lacks its log: a process that was using it did not end in good order, and
// the log, with the last changes, is gone.
bool LacksItsLog(const std::string& path);

// A PostgreSQL database that the servers of a fleet share, given as a URL or a connection string of
// libpq. One server writes at a time: a transaction begins by taking an advisory lock; PostgreSQL
// ends a transaction that is idle for four seconds. The next transaction restores a lost
// connection; Health() is UNAVAILABLE after a failed attempt.
// Errors: INVALID_ARGUMENT; UNAVAILABLE.
absl::StatusOr<std::unique_ptr<SqlDatabase>> OpenPostgres(const std::string& name);

// The version of the tables of an SQLite file, which it states as user_version; 0 if new.
inline constexpr int kSqliteSchemaVersion = 7;

// Create the tables of a new database in one transaction, in a shared one while no other server
// writes, and check those of others.
// Errors: FAILED_PRECONDITION for another version; DATA_LOSS for a damaged file.
absl::Status PrepareSqlite(SqlDatabase& database);
absl::Status PreparePostgres(SqlDatabase& database);

// Errors: FAILED_PRECONDITION for another version than the one that this program needs.
absl::Status CheckSchemaVersion(int version, int needed);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_SQL_DATABASE_H_
