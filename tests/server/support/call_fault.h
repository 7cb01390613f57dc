#ifndef BCCSKEL_TESTS_SERVER_SUPPORT_CALL_FAULT_H_
#define BCCSKEL_TESTS_SERVER_SUPPORT_CALL_FAULT_H_

#include <gtest/gtest.h>

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "proto/wire/error_details.h"
#include "server/server.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/running_server.h"

namespace bccskel::test {

// What a caller does wrong and what it must hear.
template <typename Request>
struct CallFault {
  std::string name;
  std::function<void(std::vector<Request>&)> spoil;  // the requests of a good call
  std::string field = "";  // of BadRequest; QuotaFailure's subject for RESOURCE_EXHAUSTED
  std::string reason = "FIELD_INVALID";
  absl::StatusCode code = absl::StatusCode::kInvalidArgument;

  friend std::ostream& operator<<(std::ostream& out, const CallFault& fault) {
    return out << fault.name;
  }
};

// A change to the config of the requests; to the volume that it declares.
template <typename Change>
auto InConfig(Change change) {
  return [change](auto& requests) { change(*requests[0].mutable_config()); };
}
template <typename Change>
auto InVolume(Change change) {
  return InConfig([change](auto& config) { change(*config.mutable_volume()); });
}

// Of the order of requests and of the bytes in them. Needs: good requests with several chunks.
template <typename Request>
std::vector<CallFault<Request>> StreamFaults() {
  using Requests = std::vector<Request>;
  const std::string order = "REQUEST_ORDER", size = "VOLUME_SIZE", offset = "CHUNK_OFFSET";
  const auto range = absl::StatusCode::kOutOfRange;
  return {
      {"NoRequest", [](Requests& r) { r.clear(); }, "", order},
      {"EmptyRequest", [](Requests& r) { r.assign(1, {}); }, "request"},
      {"ChunkBeforeConfig", [](Requests& r) { r.erase(r.begin()); }, "", order},
      {"FinishBeforeConfig", [](Requests& r) { r.erase(r.begin(), r.end() - 1); }, "", order},
      {"SecondConfig", [](Requests& r) { r[1] = r[0]; }, "", order},
      {"HalfClosedBeforeFinish", [](Requests& r) { r.pop_back(); }, "", "VOLUME_TRUNCATED"},
      {"HalfClosedInTheMiddle", [](Requests& r) { r.resize(2); }, "", "VOLUME_TRUNCATED"},
      {"MissingChunk", [](Requests& r) { r.erase(r.end() - 2); }, "finish.size_bytes", size},
      {"FinishWithAnotherSize", [](Requests& r) { r.back().mutable_finish()->set_size_bytes(7); },
       "finish.size_bytes", size},
      {"ChunkOverOneMebibyte",
       [](Requests& r) { r[1].mutable_chunk()->set_data(std::string((1 << 20) + 1, 'x')); },
       "chunk.data"},
      {"Gap", [](Requests& r) { r[1].mutable_chunk()->set_offset(1); }, "", offset, range},
      {"Overlap", [](Requests& r) { r[2].mutable_chunk()->set_offset(0); }, "", offset, range},
      {"WrongDigest",
       [](Requests& r) { r.back().mutable_finish()->mutable_sha256()->front() ^= 1; }, "chunk.data",
       "VOLUME_INVALID"},
      {"ShortDigest", [](Requests& r) { r.back().mutable_finish()->mutable_sha256()->pop_back(); },
       "finish.sha256"},
  };
}

// Makes the call and expects the error. Nothing of the call may be left afterwards.
template <typename Request>
void ExpectFault(const CallFault<Request>& fault, std::vector<Request> requests,
                 const server::Server& server) {
  fault.spoil(requests);
  const absl::Status status = Converse(server, requests).status;
  EXPECT_EQ(status.code(), fault.code) << status;
  EXPECT_FALSE(status.message().empty());
  const auto info = wire::ErrorInfoOf(status);
  ASSERT_TRUE(info.has_value()) << status;
  EXPECT_EQ(info->reason(), fault.reason) << status;
  EXPECT_EQ(info->domain(), "bccskel");
  if (const auto bad = wire::BadRequestOf(status); bad.has_value()) {
    EXPECT_EQ(bad->field_violations(0).field(), fault.field) << status;
  } else if (const auto quota = wire::QuotaFailureOf(status); quota.has_value()) {
    EXPECT_EQ(quota->violations(0).subject(), fault.field) << status;
  } else {
    EXPECT_EQ(fault.field, "") << status;
  }
  WaitUntilIdle(server);
}

// Names the tests of INSTANTIATE_TEST_SUITE_P().
inline constexpr auto kFaultName = [](const auto& test) { return test.param.name; };

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SERVER_SUPPORT_CALL_FAULT_H_
