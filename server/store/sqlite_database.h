#ifndef BCCSKEL_SERVER_STORE_SQLITE_DATABASE_H_
#define BCCSKEL_SERVER_STORE_SQLITE_DATABASE_H_

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/sql_database.h"

struct sqlite3;
struct sqlite3_stmt;

namespace bccskel::server {

// A database file in WAL mode with full synchronization, and its prepared statements. SQL has a
// function checksum(...) more: CRC-32C of its arguments, their types included.
class SqliteDatabase final : public SqlDatabase {
 public:
  // Made where it does not exist.
  static absl::StatusOr<std::unique_ptr<SqliteDatabase>> Open(const std::string& path);
  ~SqliteDatabase() override;
  SqliteDatabase(const SqliteDatabase&) = delete;
  SqliteDatabase& operator=(const SqliteDatabase&) = delete;

  absl::Status Execute(const char* sql) override;
  absl::StatusOr<std::vector<SqlRow>> Run(const char* sql,
                                          const std::vector<SqlValue>& values) override;
  // Errors: as Health(). Who owns the file's folder is the only member.
  absl::Status Begin(const std::string& server) override;
  bool InTransaction() const override;
  // DATA_LOSS when the file that was opened is no longer at its path.
  absl::Status Health() const override;
  absl::Status Forget() override;
  bool shared() const override { return false; }

 private:
  SqliteDatabase() = default;
  absl::Status ErrorOf(int code, const char* doing) const;
  // Prepared once.
  absl::StatusOr<sqlite3_stmt*> Prepared(const char* sql);
  absl::Status Bind(sqlite3_stmt* statement, const std::vector<SqlValue>& values, const char* sql);
  absl::StatusOr<std::vector<SqlRow>> Rows(sqlite3_stmt* statement, const char* sql);

  std::string path_;
  std::pair<uint64_t, uint64_t> identity_;  // of the file
  sqlite3* database_ = nullptr;
  std::map<const char*, sqlite3_stmt*> statements_;  // by the address of their text
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_SQLITE_DATABASE_H_
