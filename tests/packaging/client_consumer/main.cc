// A program outside the repository: asks a server that is not there, with the installed client.
#include <chrono>
#include <cstdio>
#include <string>

#include "client/skeletonize_client.h"

int main() {
  const auto stub = bccskel::client::MakeGrpcStub("unix:there-is-no-such-socket");
  const auto answer = stub->Describe(std::chrono::system_clock::now() + std::chrono::seconds(10));
  std::printf("%s\n", std::string(absl::StatusCodeToString(answer.status().code())).c_str());
}
