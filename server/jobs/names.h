#ifndef BCCSKEL_SERVER_JOBS_NAMES_H_
#define BCCSKEL_SERVER_JOBS_NAMES_H_

#include <initializer_list>
#include <string>

#include "absl/status/status.h"

namespace bccskel::server {

// `kind`/ and a RandomId() (core/digest): jobs/9f86d081.... Names cannot be guessed and do not
// reveal how many others exist.
std::string RandomName(const std::string& kind);

// Derived from the declaration and the bytes: equal volumes have equal names.
std::string VolumeName(const std::string& declaration, const std::string& blob_digest);

// Errors: INVALID_ARGUMENT unless the name is uploads/ and 1 to 64 of a-z, A-Z, 0-9, '-', '_'.
absl::Status CheckUploadName(const std::string& name);

// Hexadecimal SHA-256 of a list of texts; different lists give different keys.
std::string KeyOf(std::initializer_list<std::string> parts);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_NAMES_H_
