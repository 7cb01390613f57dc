#include "server/decoding/descriptor.h"

#include <unistd.h>

#include <system_error>

#include "server/errors/call_error.h"

namespace bccskel::server {

void Descriptor::Close() {
  if (number_ >= 0) close(number_);
  number_ = -1;
}

absl::Status NoDecoder(const std::string& what, int error) {
  return CallError(Reason::kDecoderBusy, what + ": " + std::generic_category().message(error));
}

}  // namespace bccskel::server
