#ifndef BCCSKEL_SERVER_DURABLE_NAMES_H_
#define BCCSKEL_SERVER_DURABLE_NAMES_H_

#include <initializer_list>
#include <string>

#include "absl/status/status.h"

namespace bccskel::server {

// Bytes and declaration make the volume, so the same give the same name.
std::string VolumeName(const std::string& declaration, const std::string& blob_digest);

// Errors: INVALID_ARGUMENT unless it is uploads/ and 1 to 64 of a-z, A-Z, 0-9, '-', '_'.
absl::Status CheckUploadName(const std::string& name);

// SHA-256 of several texts, none of which can be taken for part of another, in hexadecimal digits.
std::string KeyOf(std::initializer_list<std::string> parts);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_NAMES_H_
