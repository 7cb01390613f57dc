#include "server/store/sqlite_database.h"

#include <sqlite3.h>

#include <cerrno>

#include "absl/strings/str_cat.h"
#include "core/digest/crc32c.h"
#include "core/exec/status_macros.h"
#include "server/store/file_io.h"
#include "server/store/little_endian.h"

namespace bccskel::server {
namespace {

// For somebody who looks into the file, or copies it, while the server runs.
constexpr int kBusyMs = 10'000;

// What was deleted is overwritten: it may be somebody's medical data.
constexpr char kPragmas[] =
    "PRAGMA journal_mode = WAL;"
    "PRAGMA synchronous = FULL;"
    "PRAGMA foreign_keys = ON;"
    "PRAGMA secure_delete = ON;";

absl::StatusCode CodeOf(int sqlite_code, int system_error) {
  switch (sqlite_code & 0xFF) {
    case SQLITE_FULL:
      return absl::StatusCode::kResourceExhausted;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return absl::StatusCode::kDataLoss;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return absl::StatusCode::kUnavailable;
    case SQLITE_IOERR:
      return system_error == ENOSPC || system_error == EDQUOT || system_error == EFBIG
                 ? absl::StatusCode::kResourceExhausted
                 : absl::StatusCode::kInternal;
    default:
      return absl::StatusCode::kInternal;
  }
}

void AddValue(sqlite3_value* value, std::string& bytes) {
  const int type = sqlite3_value_type(value);
  bytes.push_back(static_cast<char>(type));
  if (type == SQLITE_INTEGER) {
    return AppendNumber(static_cast<uint64_t>(sqlite3_value_int64(value)), bytes);
  }
  const void* const content = sqlite3_value_blob(value);
  const auto size = static_cast<size_t>(sqlite3_value_bytes(value));
  AppendNumber(uint64_t{size}, bytes);
  if (size > 0) bytes.append(static_cast<const char*>(content), size);
}

void Checksum(sqlite3_context* context, int count, sqlite3_value** values) {
  std::string bytes;
  for (int n = 0; n < count; ++n) AddValue(values[n], bytes);
  sqlite3_result_int64(context, Crc32c(bytes));
}

}  // namespace

absl::StatusOr<std::unique_ptr<SqliteDatabase>> SqliteDatabase::Open(const std::string& path) {
  std::unique_ptr<SqliteDatabase> database(new SqliteDatabase);
  database->path_ = path;
  const int code =
      sqlite3_open_v2(path.c_str(), &database->database_,
                      SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, nullptr);
  if (code != SQLITE_OK) return database->ErrorOf(code, "open");
  sqlite3_extended_result_codes(database->database_, 1);
  sqlite3_busy_timeout(database->database_, kBusyMs);
  sqlite3_create_function_v2(database->database_, "checksum", -1,
                             SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_INNOCUOUS, nullptr,
                             Checksum, nullptr, nullptr, nullptr);
  BCCSKEL_RETURN_IF_ERROR(database->Execute(kPragmas));
  BCCSKEL_ASSIGN_OR_RETURN(const FileFacts facts, FactsOf(path));
  database->identity_ = facts.identity;
  return database;
}

SqliteDatabase::~SqliteDatabase() {
  for (const auto& [sql, statement] : statements_) sqlite3_finalize(statement);
  sqlite3_close(database_);
}

absl::Status SqliteDatabase::Execute(const char* sql) {
  errno = 0;
  const int code = sqlite3_exec(database_, sql, nullptr, nullptr, nullptr);
  return code == SQLITE_OK ? absl::OkStatus() : ErrorOf(code, sql);
}

bool SqliteDatabase::InTransaction() const { return sqlite3_get_autocommit(database_) == 0; }
absl::Status SqliteDatabase::CheckFile() const {
  const absl::StatusOr<FileFacts> now = FactsOf(path_);
  if (now.ok() && now->identity == identity_) return absl::OkStatus();
  return absl::DataLossError(
      "the file of the tables is gone, or another one has its name: what is written now is lost");
}

int64_t SqliteDatabase::LastRow() const { return sqlite3_last_insert_rowid(database_); }
int SqliteDatabase::Changes() const { return sqlite3_changes(database_); }

absl::Status SqliteDatabase::ErrorOf(int code, const char* doing) const {
  // SQLite forgets the system's error where a COMMIT fails; errno has it still.
  int system_error = database_ == nullptr ? 0 : sqlite3_system_errno(database_);
  if (system_error == 0) system_error = errno;
  return absl::Status(
      CodeOf(code, system_error),
      absl::StrCat(path_, ": ", database_ == nullptr ? "out of memory" : sqlite3_errmsg(database_),
                   " (SQLite code ", code, ", errno ", system_error, " at: ", doing, ")"));
}

absl::StatusOr<sqlite3_stmt*> SqliteDatabase::Prepared(const char* sql) {
  const auto found = statements_.find(sql);
  if (found != statements_.end()) return found->second;
  sqlite3_stmt* statement = nullptr;
  const int code =
      sqlite3_prepare_v3(database_, sql, -1, SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
  if (code != SQLITE_OK) return ErrorOf(code, sql);
  statements_[sql] = statement;
  return statement;
}

SqliteQuery::SqliteQuery(SqliteDatabase& database, const char* sql, Unbound)
    : database_(database), sql_(sql) {
  auto statement = database_.Prepared(sql);
  if (statement.ok()) {
    statement_ = *statement;
  } else {
    status_ = statement.status();
  }
}

SqliteQuery::~SqliteQuery() {
  if (statement_ == nullptr) return;
  sqlite3_reset(statement_);
  sqlite3_clear_bindings(statement_);
}

// Binding fails for wrong indexes and without memory only; Next() would then see a wrong statement,
// so the first error is kept.
void SqliteQuery::Bind(int index, int64_t value) {
  if (!status_.ok()) return;
  const int code = sqlite3_bind_int64(statement_, index, value);
  if (code != SQLITE_OK) status_ = database_.ErrorOf(code, sql_);
}

void SqliteQuery::Bind(int index, const std::string& value) {
  if (!status_.ok()) return;
  const int code = sqlite3_bind_text64(statement_, index, value.data(), value.size(), SQLITE_STATIC,
                                       SQLITE_UTF8);
  if (code != SQLITE_OK) status_ = database_.ErrorOf(code, sql_);
}

void SqliteQuery::Bind(int index, const Blob& value) {
  if (!status_.ok()) return;
  const int code =
      sqlite3_bind_blob64(statement_, index, value.bytes.data(), value.bytes.size(), SQLITE_STATIC);
  if (code != SQLITE_OK) status_ = database_.ErrorOf(code, sql_);
}

absl::StatusOr<bool> SqliteQuery::Next() {
  BCCSKEL_RETURN_IF_ERROR(status_);
  column_ = 0;
  errno = 0;
  const int code = sqlite3_step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  return database_.ErrorOf(code, sql_);
}

absl::Status SqliteQuery::Run() { return Next().status(); }

int64_t SqliteQuery::Number() { return sqlite3_column_int64(statement_, column_++); }

std::string SqliteQuery::Text() {
  const int column = column_++;
  const void* const bytes = sqlite3_column_blob(statement_, column);
  const auto size = static_cast<size_t>(sqlite3_column_bytes(statement_, column));
  return bytes == nullptr ? std::string() : std::string(static_cast<const char*>(bytes), size);
}

}  // namespace bccskel::server
