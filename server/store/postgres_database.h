#ifndef BCCSKEL_SERVER_STORE_POSTGRES_DATABASE_H_
#define BCCSKEL_SERVER_STORE_POSTGRES_DATABASE_H_

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "server/store/sql_database.h"

struct pg_conn;
struct pg_result;

namespace bccskel::server {

// A PostgreSQL database that the servers of a fleet share. One of them writes at a time: a
// transaction begins when it has an advisory lock, which PostgreSQL takes from who does nothing in
// it for four seconds.
// A connection that is lost is made anew by the next transaction.
class PostgresDatabase final : public SqlDatabase {
 public:
  // `name`: a URL, or libpq's words. Errors: INVALID_ARGUMENT; UNAVAILABLE.
  static absl::StatusOr<std::unique_ptr<PostgresDatabase>> Open(const std::string& name);
  ~PostgresDatabase() override;
  PostgresDatabase(const PostgresDatabase&) = delete;
  PostgresDatabase& operator=(const PostgresDatabase&) = delete;

  absl::Status Execute(const char* sql) override;
  absl::StatusOr<std::vector<SqlRow>> Run(const char* sql,
                                          const std::vector<SqlValue>& values) override;
  absl::Status Begin(const std::string& server) override;
  bool InTransaction() const override;
  // UNAVAILABLE after an attempt to reach it has failed.
  absl::Status Health() const override;
  absl::Status Forget() override;
  bool shared() const override { return true; }

 private:
  using Clock = std::chrono::steady_clock;
  using Result = std::unique_ptr<pg_result, void (*)(pg_result*)>;

  explicit PostgresDatabase(std::string name) : name_(std::move(name)) {}
  absl::Status Connect();
  absl::Status BeConnected();
  absl::Status Prepare(const char* sql, const std::vector<SqlValue>& values, std::string& name);
  absl::Status ErrorOf(const pg_result* result, const char* doing) const;
  void NoteHealth(const absl::Status& status);

  const std::string name_;
  pg_conn* connection_ = nullptr;
  Clock::time_point next_attempt_;
  std::map<const char*, std::string> statements_;  // names, by the address of their text
  mutable std::mutex health_mutex_;
  absl::Status health_;  // guarded by health_mutex_
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_POSTGRES_DATABASE_H_
