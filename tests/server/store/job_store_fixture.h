#ifndef BCCSKEL_TESTS_SERVER_STORE_JOB_STORE_FIXTURE_H_
#define BCCSKEL_TESTS_SERVER_STORE_JOB_STORE_FIXTURE_H_

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "server/store/job_store.h"
#include "tests/server/store/postgres_server.h"
#include "tests/support/temporary_folder.h"

namespace bccskel::server {

enum class Backend { kSqlite, kPostgres };

class JobStoreTest : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    if (GetParam() == Backend::kPostgres) {
      PostgresServer* const server = PostgresServer::Get();
      if (server == nullptr) GTEST_SKIP() << "PostgreSQL is not installed (or was not built in)";
      database_ = server->NewDatabase();
    }
    Reopen();
  }
  absl::StatusOr<std::unique_ptr<JobStore>> Open() {
    return database_.empty() ? OpenSqliteJobStore(folder_ / "jobs.db")
                             : OpenPostgresJobStore(database_);
  }
  void Reopen() {
    store_.reset();
    auto store = Open();
    ASSERT_TRUE(store.ok()) << store.status();
    store_ = *std::move(store);
  }
  static JobRow Job(const std::string& tenant, const std::string& name) {
    JobRow job;
    job.tenant = tenant;
    job.name = name;
    job.created = Time(std::chrono::seconds(1));
    return job;
  }
  int64_t Insert(const JobRow& job) {
    const auto number = store_->InsertJob(job);
    EXPECT_TRUE(number.ok()) << number.status();
    return *number;
  }

  test::TemporaryFolder folder_;
  std::string database_;  // empty: SQLite's
  std::unique_ptr<JobStore> store_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_TESTS_SERVER_STORE_JOB_STORE_FIXTURE_H_
