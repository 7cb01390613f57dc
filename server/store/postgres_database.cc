#include <libpq-fe.h>

#include <chrono>
#include <cstring>
#include <map>
#include <mutex>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/store/job_store.h"
#include "server/store/sql_database.h"

namespace bccskel::server {
namespace {

constexpr Oid kBytes = 17, kInteger8 = 20, kInteger4 = 23;
constexpr int kBinary = 1;
constexpr std::chrono::milliseconds kBetweenAttempts(250);

// An arbitrary number that nobody else in the database uses.
#define BCCSKEL_WRITER_LOCK "SELECT pg_advisory_xact_lock(7113042907101214316);"

// A server that hangs within a transaction, or waits for one that does, must not stop the fleet.
constexpr char kSession[] =
    "SET idle_in_transaction_session_timeout = '4s'; SET lock_timeout = '10s';"
    "SET statement_timeout = '60s'; SET synchronous_commit = on;";

std::string BigEndian(int64_t number) {
  std::string bytes;
  for (int shift = 56; shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<char>(static_cast<uint64_t>(number) >> shift));
  }
  return bytes;
}

// Two's complement of 4 or 8 bytes.
int64_t NumberOf(const char* bytes, int size) {
  uint64_t number = size > 0 && (bytes[0] & 0x80) != 0 ? ~uint64_t{0} : 0;
  for (int n = 0; n < size; ++n) number = number << 8 | static_cast<uint8_t>(bytes[n]);
  return static_cast<int64_t>(number);
}

SqlValue ValueAt(const PGresult* result, int row, int column) {
  const char* const bytes = PQgetvalue(result, row, column);
  const int size = PQgetlength(result, row, column);
  const Oid type = PQftype(result, column);
  if (type == kInteger8 || type == kInteger4) return SqlValue::Number(NumberOf(bytes, size));
  return SqlValue::Blob(std::string(bytes, static_cast<size_t>(size)));
}

// The code for an SQLSTATE; an empty one means a lost connection.
absl::StatusCode CodeOf(const std::string& state) {
  using absl::StartsWith, absl::StatusCode;
  if (state == "53100") return StatusCode::kResourceExhausted;  // disk full
  if (StartsWith(state, "XX")) return StatusCode::kDataLoss;
  // Connection, resources, operator intervention, timeouts and locks, a standby.
  for (const char* soon : {"08", "53", "57", "40", "55P03", "25006", "25P03"}) {
    if (StartsWith(state, soon)) return StatusCode::kUnavailable;
  }
  return state.empty() ? StatusCode::kUnavailable : StatusCode::kInternal;
}

class PostgresDatabase final : public SqlDatabase {
 public:
  static absl::StatusOr<std::unique_ptr<SqlDatabase>> Open(const std::string& name) {
    BCCSKEL_RETURN_IF_ERROR(CheckPostgresName(name));
    std::unique_ptr<PostgresDatabase> database(new PostgresDatabase(name));
    BCCSKEL_RETURN_IF_ERROR(database->Connect());
    return database;
  }
  ~PostgresDatabase() override { PQfinish(connection_); }
  PostgresDatabase(const PostgresDatabase&) = delete;
  PostgresDatabase& operator=(const PostgresDatabase&) = delete;

  absl::Status Execute(const std::string& sql) override {
    const Result result(PQexec(connection_, sql.c_str()), PQclear);
    const ExecStatusType status = PQresultStatus(result.get());
    if (status == PGRES_COMMAND_OK || status == PGRES_TUPLES_OK) return absl::OkStatus();
    return ErrorOf(result.get(), sql);
  }

  absl::StatusOr<std::vector<SqlRow>> Run(const std::string& sql,
                                          const std::vector<SqlValue>& values) override {
    if (PQstatus(connection_) != CONNECTION_OK && !InTransaction()) {
      BCCSKEL_RETURN_IF_ERROR(BeConnected());
    }
    BCCSKEL_ASSIGN_OR_RETURN(const std::string name, Prepared(sql, values));
    std::vector<std::string> numbers;
    numbers.reserve(values.size());
    std::vector<const char*> bytes;
    std::vector<int> sizes;
    for (const SqlValue& value : values) {
      const bool number = value.kind == SqlValue::Kind::kNumber;
      if (number) numbers.push_back(BigEndian(value.number));
      const std::string& content = number ? numbers.back() : value.bytes;
      bytes.push_back(content.data());
      sizes.push_back(static_cast<int>(content.size()));
    }
    const std::vector<int> formats(values.size(), kBinary);
    const Result result(PQexecPrepared(connection_, name.c_str(), static_cast<int>(values.size()),
                                       bytes.data(), sizes.data(), formats.data(), kBinary),
                        PQclear);
    const ExecStatusType status = PQresultStatus(result.get());
    if (status != PGRES_COMMAND_OK && status != PGRES_TUPLES_OK) return ErrorOf(result.get(), sql);
    if (sql == "COMMIT" && std::strcmp(PQcmdStatus(result.get()), "COMMIT") != 0) {
      return absl::InternalError("PostgreSQL has taken a transaction back that had failed");
    }
    std::vector<SqlRow> rows;
    for (int row = 0; row < PQntuples(result.get()); ++row) {
      std::vector<SqlValue> columns;
      for (int column = 0; column < PQnfields(result.get()); ++column) {
        columns.push_back(ValueAt(result.get(), row, column));
      }
      rows.emplace_back(std::move(columns));
    }
    return rows;
  }

  // One round trip.
  absl::Status Begin(const std::string& server) override {
    BCCSKEL_RETURN_IF_ERROR(BeConnected());
    std::string sql = "BEGIN; " BCCSKEL_WRITER_LOCK;
    if (!server.empty()) {
      absl::StrAppend(&sql, "SELECT 1 FROM servers WHERE server = '", server, "'");
    }
    const Result result(PQexec(connection_, sql.c_str()), PQclear);
    if (PQresultStatus(result.get()) != PGRES_TUPLES_OK) return ErrorOf(result.get(), "begin");
    if (!server.empty() && PQntuples(result.get()) == 0) {
      return absl::AbortedError("this server has lost its lease: others have taken over");
    }
    return absl::OkStatus();
  }
  bool InTransaction() const override {
    const PGTransactionStatusType status = PQtransactionStatus(connection_);
    return status == PQTRANS_INTRANS || status == PQTRANS_INERROR || status == PQTRANS_ACTIVE;
  }
  std::string NextNumber(const std::string& table) const override {
    return absl::StrCat("nextval('", table, "_number_seq')");
  }
  absl::Status Health() const override {
    std::lock_guard lock(health_mutex_);
    return health_;
  }
  // PostgreSQL itself vacuums, which erases deleted rows.
  absl::Status Forget() override {
    if (PQstatus(connection_) != CONNECTION_OK || InTransaction()) return absl::OkStatus();
    return Execute("DELETE FROM deleted_jobs WHERE at < now() - interval '1 hour'");
  }
  bool shared() const override { return true; }

 private:
  using Clock = std::chrono::steady_clock;
  using Result = std::unique_ptr<pg_result, void (*)(pg_result*)>;

  explicit PostgresDatabase(std::string name) : name_(std::move(name)) {}

  // Settings in the name take precedence over these.
  absl::Status Connect() {
    PQfinish(connection_);
    statements_.clear();
    const char* const words[] = {"connect_timeout",
                                 "application_name",
                                 "tcp_user_timeout",
                                 "keepalives_idle",
                                 "keepalives_interval",
                                 "dbname",
                                 nullptr};
    const char* const values[] = {"2", "bccskel-server", "10000", "5", "2", name_.c_str(), nullptr};
    connection_ = PQconnectdbParams(words, values, 1);
    if (PQstatus(connection_) != CONNECTION_OK) {
      return absl::UnavailableError(
          absl::StrCat("the database cannot be reached: ", PQerrorMessage(connection_)));
    }
    PQsetNoticeProcessor(
        connection_, [](void*, const char*) {}, nullptr);
    return Execute(kSession);
  }

  absl::Status BeConnected() {
    if (PQstatus(connection_) == CONNECTION_OK) return absl::OkStatus();
    if (Clock::now() < next_attempt_) {
      return absl::UnavailableError("the database cannot be reached just now");
    }
    absl::Status connected = Connect();
    next_attempt_ = Clock::now() + kBetweenAttempts;
    NoteHealth(connected);
    return connected;
  }

  // Yields the name of the statement.
  absl::StatusOr<std::string> Prepared(const std::string& sql,
                                       const std::vector<SqlValue>& values) {
    const auto found = statements_.find(sql);
    if (found != statements_.end()) return found->second;
    const std::string name = absl::StrCat("s", statements_.size());
    std::vector<Oid> types;
    for (const SqlValue& value : values) {
      types.push_back(value.kind == SqlValue::Kind::kNumber ? kInteger8 : kBytes);
    }
    const Result result(PQprepare(connection_, name.c_str(), sql.c_str(),
                                  static_cast<int>(types.size()), types.data()),
                        PQclear);
    if (PQresultStatus(result.get()) != PGRES_COMMAND_OK) return ErrorOf(result.get(), sql);
    statements_[sql] = name;
    return name;
  }
  absl::Status ErrorOf(const PGresult* result, const std::string& doing) const {
    const char* const state = PQresultErrorField(result, PG_DIAG_SQLSTATE);
    return absl::Status(
        CodeOf(state == nullptr ? "" : state),
        absl::StrCat("PostgreSQL: ", PQerrorMessage(connection_), " (at: ", doing, ")"));
  }
  void NoteHealth(const absl::Status& status) {
    std::lock_guard lock(health_mutex_);
    health_ = status;
  }

  const std::string name_;
  pg_conn* connection_ = nullptr;
  Clock::time_point next_attempt_;
  std::map<std::string, std::string> statements_;  // names by SQL text
  mutable std::mutex health_mutex_;
  absl::Status health_;  // guarded by health_mutex_
};

}  // namespace

absl::Status CheckPostgresName(const std::string& name) {
  char* message = nullptr;
  PQconninfoOption* const options = PQconninfoParse(name.c_str(), &message);
  if (options == nullptr) {
    const std::string why = message == nullptr ? "out of memory" : message;
    PQfreemem(message);
    return absl::InvalidArgumentError(absl::StrCat("the URL of the database: ", why));
  }
  bool password = false;
  for (const PQconninfoOption* option = options; option->keyword != nullptr; ++option) {
    password =
        password || (std::strcmp(option->keyword, "password") == 0 && option->val != nullptr);
  }
  PQconninfoFree(options);
  if (!password) return absl::OkStatus();
  return absl::InvalidArgumentError(
      "everybody on this machine can read a password in the URL: use PGPASSFILE or PGPASSWORD");
}

absl::StatusOr<std::unique_ptr<SqlDatabase>> OpenPostgres(const std::string& name) {
  return PostgresDatabase::Open(name);
}

}  // namespace bccskel::server
