#include "core/ranks/agreement.h"

#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/ranks/packing.h"

namespace bccskel::ranks {

absl::Status AgreeOn(Exchange& exchange, const absl::Status& own) {
  uint64_t failed = own.ok() ? 0 : 1;
  exchange.Max({&failed, 1});
  if (failed == 0) return own;
  Bytes told;
  Pack(own.code(), told);
  Pack(std::span<const char>(own.message()), told);
  const std::vector<Bytes> all = Gather(exchange, std::move(told));
  for (size_t rank = 0; own.ok() && rank < all.size(); ++rank) {
    Unpacker from(all[rank]);
    const auto code = from.Take<absl::StatusCode>();
    const std::vector<char> text = from.TakeRest<char>();
    if (code == absl::StatusCode::kOk) continue;
    return absl::Status(
        code, absl::StrFormat("rank %d: %s", rank, std::string(text.begin(), text.end())));
  }
  return own.ok() ? absl::CancelledError("another rank cannot continue") : own;
}

}  // namespace bccskel::ranks
