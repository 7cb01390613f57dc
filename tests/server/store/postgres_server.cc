#include "tests/server/store/postgres_server.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

namespace bccskel::server {
namespace {

namespace fs = std::filesystem;

// The newest version's; empty where there is none.
std::string Programs() {
  std::string newest;
#ifdef BCCSKEL_WITH_POSTGRESQL
  std::error_code error;
  for (const auto& version : fs::directory_iterator("/usr/lib/postgresql", error)) {
    const std::string programs = version.path().string() + "/bin";
    if (fs::exists(programs + "/initdb") && programs > newest) newest = programs;
  }
#endif
  return newest;
}

}  // namespace

PostgresServer* PostgresServer::Get() {
  static const std::unique_ptr<PostgresServer> server = []() -> std::unique_ptr<PostgresServer> {
    const std::string programs = Programs();
    std::string folder = "/tmp/bccskel-postgres-XXXXXX";  // a socket's path is short
    if (programs.empty() || mkdtemp(folder.data()) == nullptr) return nullptr;
    return std::unique_ptr<PostgresServer>(new PostgresServer(programs, folder));
  }();
  return server.get();
}

PostgresServer::PostgresServer(std::string programs, std::string folder)
    : programs_(std::move(programs)), folder_(std::move(folder)) {
  if (geteuid() == 0) {
    EXPECT_EQ(std::system(("chown nobody " + folder_).c_str()), 0);
  }
  Run(programs_ + "/initdb -D " + folder_ + "/data -A trust -U test -E UTF8 --no-sync");
  Control("start");
}

PostgresServer::~PostgresServer() {
  Control("stop -m immediate");
  fs::remove_all(folder_);
}

std::string PostgresServer::NewDatabase() {
  const std::string name = "test" + std::to_string(++databases_);
  Run(programs_ + "/createdb -h " + folder_ + " -U test " + name);
  return "postgresql://test@/" + name + "?host=" + folder_;
}

void PostgresServer::Control(const std::string& what) const {
  Run(programs_ + "/pg_ctl -w -D " + folder_ + "/data -l " + folder_ + "/log -o \"-F -k " +
      folder_ + " -c listen_addresses=''\" " + what);
}

void PostgresServer::Run(const std::string& command) const {
  const std::string user = geteuid() == 0 ? "runuser -u nobody -- " : "";
  const std::string whole = "cd / && " + user + command + " >" + folder_ + ".log 2>&1 </dev/null";
  EXPECT_EQ(std::system(whole.c_str()), 0) << whole;
  std::error_code error;
  fs::remove(folder_ + ".log", error);
}

}  // namespace bccskel::server
