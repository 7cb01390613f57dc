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

// A parameter of a statement, or a column of what it yields.
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

// A connection to a database. Statements are written so that SQLite and PostgreSQL understand them:
// $1, $2, ... are the parameters, first named in this order; all text is compared as bytes.
// Errors of all: RESOURCE_EXHAUSTED (full disk); DATA_LOSS (damaged); UNAVAILABLE (locked or not
//         reachable just now); INTERNAL.
// Threads: one at a time, but for Health().
class SqlDatabase {
 public:
  virtual ~SqlDatabase() = default;

  // Any number of statements without parameters and rows.
  virtual absl::Status Execute(const std::string& sql) = 0;
  // One statement, which is prepared once: there must not be many.
  virtual absl::StatusOr<std::vector<SqlRow>> Run(const std::string& sql,
                                                  const std::vector<SqlValue>& values) = 0;

  // Nobody else writes until the end of the transaction. Errors: ABORTED when `server`, unless it
  // is empty, is no (longer) a member of the fleet.
  virtual absl::Status Begin(const std::string& server) = 0;
  virtual bool InTransaction() const = 0;
  // An expression for the number of the next row of a table that numbers its rows.
  virtual std::string NextNumber(const std::string& table) const = 0;

  virtual absl::Status Health() const = 0;
  // What was deleted is then nowhere in the files any more, as far as that is ours to say.
  virtual absl::Status Forget() = 0;
  // Whether other servers may use it, too.
  virtual bool shared() const = 0;
};

// A file of SQLite in WAL mode with full synchronization, which is made where it does not exist.
// Health() is DATA_LOSS, and no transaction begins, when the file is no longer at its path. SQL has
// a function checksum(...) more: CRC-32C of its arguments, their types included.
absl::StatusOr<std::unique_ptr<SqlDatabase>> OpenSqlite(const std::string& path);

// A PostgreSQL database that the servers of a fleet share, by a URL or libpq's words. One of them
// writes at a time: a transaction begins when it has an advisory lock, which PostgreSQL takes from
// who does nothing in it for four seconds. A connection that is lost is made anew by the next
// transaction; Health() is UNAVAILABLE after an attempt has failed.
// Errors: INVALID_ARGUMENT; UNAVAILABLE.
absl::StatusOr<std::unique_ptr<SqlDatabase>> OpenPostgres(const std::string& name);

// The version of the tables that this program writes. A file of SQLite states its own as
// user_version, 0 when it is new.
int SqliteSchemaVersion();

// Bring the tables to the version that this program writes: a file one version after the other,
// each in a transaction; a shared database in one, while no other server writes. Errors:
// FAILED_PRECONDITION for a newer version; DATA_LOSS for a damaged file.
absl::Status MigrateSqlite(SqlDatabase& database);
absl::Status MigratePostgres(SqlDatabase& database);

// Errors: FAILED_PRECONDITION for tables of a version that this program, which knows those up to
//         `known`, does not.
absl::Status CheckSchemaVersion(int version, int known);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_SQL_DATABASE_H_
