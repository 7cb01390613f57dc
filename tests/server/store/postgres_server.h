#ifndef BCCSKEL_TESTS_SERVER_STORE_POSTGRES_SERVER_H_
#define BCCSKEL_TESTS_SERVER_STORE_POSTGRES_SERVER_H_

#include <memory>
#include <string>

namespace bccskel::server {

// Debian's PostgreSQL in a folder of its own below /tmp, on a Unix socket there. It runs as nobody
// where this process is root, which it refuses to be. Without flushes: it survives no crash of the
// machine.
class PostgresServer {
 public:
  // The one of this process, until its end; null where it is not installed.
  static PostgresServer* Get();

  ~PostgresServer();
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;

  // The name of a database that is new and empty.
  std::string NewDatabase();
  void Restart() { Control("restart -m immediate"); }

 private:
  PostgresServer(std::string programs, std::string folder);
  void Control(const std::string& what) const;
  void Run(const std::string& command) const;

  const std::string programs_;
  const std::string folder_;
  int databases_ = 0;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_TESTS_SERVER_STORE_POSTGRES_SERVER_H_
