#ifndef BCCSKEL_TESTS_SERVER_SUPPORT_RUNNING_SERVER_H_
#define BCCSKEL_TESTS_SERVER_SUPPORT_RUNNING_SERVER_H_

#include <grpcpp/grpcpp.h>

#include <memory>
#include <string>

#include "server/server.h"

namespace bccskel::test {

// Two threads, two jobs, a free port on loopback; the rest as by default.
server::ServerConfig SmallServer();

// Throws when it cannot start, which fails the test.
std::unique_ptr<server::Server> StartServer(const server::ServerConfig& config = SmallServer());

// A connection of its own: gRPC's channels to one address share one otherwise.
std::shared_ptr<grpc::Channel> ConnectTo(const std::string& address);

// Nothing is admitted and no thread is at work: what jobs held is given back. Waits for it; a
// server that leaks is found by the test's time limit.
void WaitUntilIdle(const server::Server& server);

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SERVER_SUPPORT_RUNNING_SERVER_H_
