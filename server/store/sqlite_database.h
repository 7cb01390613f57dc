#ifndef BCCSKEL_SERVER_STORE_SQLITE_DATABASE_H_
#define BCCSKEL_SERVER_STORE_SQLITE_DATABASE_H_

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

struct sqlite3;
struct sqlite3_stmt;

namespace bccskel::server {

// A database file in WAL mode with full synchronization, and its prepared statements. SQL has a
// function checksum(...) more: CRC-32C of its arguments, their types included.
// Errors of all: RESOURCE_EXHAUSTED (full disk), DATA_LOSS (damaged file), UNAVAILABLE (locked by
//         another program), INTERNAL.
// Threads: one at a time.
class SqliteDatabase {
 public:
  // Made where it does not exist.
  static absl::StatusOr<std::unique_ptr<SqliteDatabase>> Open(const std::string& path);
  ~SqliteDatabase();
  SqliteDatabase(const SqliteDatabase&) = delete;
  SqliteDatabase& operator=(const SqliteDatabase&) = delete;

  // Any number of statements without values and rows.
  absl::Status Execute(const char* sql);
  bool InTransaction() const;
  // DATA_LOSS when the file that was opened is no longer at its path.
  absl::Status CheckFile() const;
  int64_t LastRow() const;
  int Changes() const;

 private:
  friend class SqliteQuery;
  SqliteDatabase() = default;
  absl::Status ErrorOf(int code, const char* doing) const;
  // Prepared once.
  absl::StatusOr<sqlite3_stmt*> Prepared(const char* sql);

  std::string path_;
  std::pair<uint64_t, uint64_t> identity_;  // of the file
  sqlite3* database_ = nullptr;
  std::map<const char*, sqlite3_stmt*> statements_;  // by the address of their text
};

// Bytes that are no text.
struct Blob {
  const std::string& bytes;
};

// A statement at work. Needs: `sql` is a literal; at most one query of it at a time; the database
// outlives it.
class SqliteQuery {
 public:
  template <typename... Values>
  SqliteQuery(SqliteDatabase& database, const char* sql, const Values&... values)
      : SqliteQuery(database, sql, Unbound()) {
    int index = 0;
    (Bind(++index, values), ...);
  }
  ~SqliteQuery();
  SqliteQuery(const SqliteQuery&) = delete;
  SqliteQuery& operator=(const SqliteQuery&) = delete;

  // True while there is a row.
  absl::StatusOr<bool> Next();
  // For statements without rows.
  absl::Status Run();

  // The columns of the row, from left to right.
  int64_t Number();
  std::string Text();

 private:
  struct Unbound {};
  SqliteQuery(SqliteDatabase& database, const char* sql, Unbound);
  void Bind(int index, int64_t value);
  void Bind(int index, const std::string& value);
  void Bind(int index, const Blob& value);

  SqliteDatabase& database_;
  const char* const sql_;
  sqlite3_stmt* statement_ = nullptr;
  absl::Status status_;
  int column_ = 0;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_SQLITE_DATABASE_H_
