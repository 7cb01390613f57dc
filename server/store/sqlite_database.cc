#include <sqlite3.h>

#include <cerrno>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/digest/crc32c.h"
#include "core/exec/status_macros.h"
#include "server/store/file_io.h"
#include "server/store/sql_database.h"
#include "server/store/stored_bytes.h"

namespace bccskel::server {
namespace {

// Waits for a program that reads or copies the file while the server runs.
constexpr int kBusyMs = 10'000;

// Deleted data is overwritten: it may be medical.
constexpr char kPragmas[] =
    "PRAGMA journal_mode = WAL;"
    "PRAGMA synchronous = FULL;"
    "PRAGMA foreign_keys = ON;"
    "PRAGMA secure_delete = ON;";

// In the field of the file's header that is free for programs, at this offset, while a log may hold
// changes.
#define BCCSKEL_IN_USE "1"
constexpr uint64_t kUseOffset = 68;

std::string LogOf(const std::string& path) { return path + "-wal"; }

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

SqlValue ValueOf(sqlite3_value* value) {
  const int type = sqlite3_value_type(value);
  if (type == SQLITE_INTEGER) return SqlValue::Number(sqlite3_value_int64(value));
  const void* const content = sqlite3_value_blob(value);
  const auto size = static_cast<size_t>(sqlite3_value_bytes(value));
  std::string bytes;
  if (size > 0) bytes.assign(static_cast<const char*>(content), size);
  return type == SQLITE_TEXT ? SqlValue::Text(std::move(bytes)) : SqlValue::Blob(std::move(bytes));
}

void Checksum(sqlite3_context* context, int count, sqlite3_value** values) {
  std::string bytes;
  for (int n = 0; n < count; ++n) AppendChecked(ValueOf(values[n]), bytes);
  sqlite3_result_int64(context, Crc32c(bytes));
}

class SqliteDatabase final : public SqlDatabase {
 public:
  static absl::StatusOr<std::unique_ptr<SqlDatabase>> Open(const std::string& path) {
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
    database->files_ = {{path, facts.identity}};
    return database;
  }
  ~SqliteDatabase() override {
    for (const auto& [sql, statement] : statements_) sqlite3_finalize(statement);
    // SQLite removes the log when it closes the file. Where the note may stay, so must the log.
    const bool noted_end = in_use_ && Execute("PRAGMA application_id = 0").ok();
    if (!noted_end && database_ != nullptr) {
      sqlite3_db_config(database_, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
    }
    sqlite3_close(database_);
  }
  SqliteDatabase(const SqliteDatabase&) = delete;
  SqliteDatabase& operator=(const SqliteDatabase&) = delete;

  absl::Status Execute(const std::string& sql) override {
    errno = 0;
    const int code = sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, nullptr);
    return code == SQLITE_OK ? absl::OkStatus() : ErrorOf(code, sql);
  }

  absl::StatusOr<std::vector<SqlRow>> Run(const std::string& sql,
                                          const std::vector<SqlValue>& values) override {
    BCCSKEL_ASSIGN_OR_RETURN(sqlite3_stmt * statement, Prepared(sql));
    const absl::Status bound = Bind(statement, values, sql);
    auto rows = bound.ok() ? Rows(statement, sql) : bound;
    sqlite3_reset(statement);
    sqlite3_clear_bindings(statement);
    return rows;
  }
  absl::Status Begin(const std::string&) override {
    BCCSKEL_RETURN_IF_ERROR(Health());
    return Execute("BEGIN IMMEDIATE");
  }
  bool InTransaction() const override { return sqlite3_get_autocommit(database_) == 0; }
  std::string NextNumber(const std::string& table) const override {
    return absl::StrCat("1 + coalesce((SELECT seq FROM sqlite_sequence WHERE name = '", table,
                        "'), 0)");
  }
  // Best effort: a full disk prevents it. Forget() brings the note from the log to the file itself.
  void BeginUse() override {
    in_use_ = true;
    Execute("PRAGMA application_id = " BCCSKEL_IN_USE).IgnoreError();
    Forget().IgnoreError();
    const absl::StatusOr<FileFacts> log = FactsOf(LogOf(path_));
    if (log.ok()) files_.emplace_back(LogOf(path_), log->identity);
  }
  absl::Status Health() const override {
    for (const auto& [path, identity] : files_) {
      const absl::StatusOr<FileFacts> now = FactsOf(path);
      if (now.ok() && now->identity == identity) continue;
      return absl::DataLossError(
          "the file of the tables or its log is gone or replaced: what is written now would be "
          "lost");
    }
    return absl::OkStatus();
  }
  absl::Status Forget() override { return Execute("PRAGMA wal_checkpoint(TRUNCATE)"); }
  bool shared() const override { return false; }

 private:
  SqliteDatabase() = default;

  absl::Status ErrorOf(int code, const std::string& doing) const {
    // SQLite loses the system's error when a COMMIT fails, but errno still has it.
    int system_error = database_ == nullptr ? 0 : sqlite3_system_errno(database_);
    if (system_error == 0) system_error = errno;
    return absl::Status(
        CodeOf(code, system_error),
        absl::StrCat(path_, ": ",
                     database_ == nullptr ? "out of memory" : sqlite3_errmsg(database_),
                     " (SQLite code ", code, ", errno ", system_error, " at: ", doing, ")"));
  }

  // Prepared once.
  absl::StatusOr<sqlite3_stmt*> Prepared(const std::string& sql) {
    const auto found = statements_.find(sql);
    if (found != statements_.end()) return found->second;
    sqlite3_stmt* statement = nullptr;
    const int code = sqlite3_prepare_v3(database_, sql.c_str(), -1, SQLITE_PREPARE_PERSISTENT,
                                        &statement, nullptr);
    if (code != SQLITE_OK) return ErrorOf(code, sql);
    statements_[sql] = statement;
    return statement;
  }

  absl::Status Bind(sqlite3_stmt* statement, const std::vector<SqlValue>& values,
                    const std::string& sql) {
    int index = 0;
    for (const SqlValue& value : values) {
      ++index;
      const std::string& bytes = value.bytes;
      int code = SQLITE_OK;
      if (value.kind == SqlValue::Kind::kNumber) {
        code = sqlite3_bind_int64(statement, index, value.number);
      } else if (value.kind == SqlValue::Kind::kText) {
        code = sqlite3_bind_text64(statement, index, bytes.data(), bytes.size(), SQLITE_STATIC,
                                   SQLITE_UTF8);
      } else {
        code = sqlite3_bind_blob64(statement, index, bytes.data(), bytes.size(), SQLITE_STATIC);
      }
      if (code != SQLITE_OK) return ErrorOf(code, sql);
    }
    return absl::OkStatus();
  }

  absl::StatusOr<std::vector<SqlRow>> Rows(sqlite3_stmt* statement, const std::string& sql) {
    std::vector<SqlRow> rows;
    errno = 0;
    while (true) {
      const int code = sqlite3_step(statement);
      if (code == SQLITE_DONE) return rows;
      if (code != SQLITE_ROW) return ErrorOf(code, sql);
      std::vector<SqlValue> values;
      for (int column = 0; column < sqlite3_column_count(statement); ++column) {
        // Works for any type: in a damaged file a column may have another one.
        const int64_t number = sqlite3_column_int64(statement, column);
        const void* const bytes = sqlite3_column_blob(statement, column);
        const auto size = static_cast<size_t>(sqlite3_column_bytes(statement, column));
        SqlValue& value = values.emplace_back(SqlValue::Number(number));
        if (bytes != nullptr) value.bytes.assign(static_cast<const char*>(bytes), size);
      }
      rows.emplace_back(std::move(values));
    }
  }

  std::string path_;
  // The files by path, and their identities.
  std::vector<std::pair<std::string, std::pair<uint64_t, uint64_t>>> files_;
  bool in_use_ = false;
  sqlite3* database_ = nullptr;
  std::map<std::string, sqlite3_stmt*> statements_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<SqlDatabase>> OpenSqlite(const std::string& path) {
  return SqliteDatabase::Open(path);
}

bool LacksItsLog(const std::string& path) {
  const absl::StatusOr<File> file = File::OpenToRead(path);
  if (!file.ok() || FactsOf(LogOf(path)).ok()) return false;
  const absl::StatusOr<std::string> note = file->ReadAt(kUseOffset, sizeof(uint32_t));
  return note.ok() && *note == std::string("\0\0\0\1", sizeof(uint32_t));
}

}  // namespace bccskel::server
