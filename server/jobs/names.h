#ifndef BCCSKEL_SERVER_JOBS_NAMES_H_
#define BCCSKEL_SERVER_JOBS_NAMES_H_

#include <initializer_list>
#include <string>

#include "absl/status/status.h"

namespace bccskel::server {

// 32 hexadecimal digits.
std::string RandomId();
// `kind`/ and such digits: jobs/9f86d081.... Nobody can guess it, or tell from it how many others
// there are.
std::string RandomName(const std::string& kind);

// Bytes and declaration make the volume, so the same give the same name.
std::string VolumeName(const std::string& declaration, const std::string& blob_digest);

// Errors: INVALID_ARGUMENT unless it is uploads/ and 1 to 64 of a-z, A-Z, 0-9, '-', '_'.
absl::Status CheckUploadName(const std::string& name);

// SHA-256 of several texts, none of which can be taken for part of another, in hexadecimal digits.
std::string KeyOf(std::initializer_list<std::string> parts);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_NAMES_H_
