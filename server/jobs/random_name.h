#ifndef BCCSKEL_SERVER_JOBS_RANDOM_NAME_H_
#define BCCSKEL_SERVER_JOBS_RANDOM_NAME_H_

#include <string>

namespace bccskel::server {

// 32 hexadecimal digits.
std::string RandomId();
// `kind`/ and such digits: jobs/9f86d081.... Nobody can guess it, or tell from it how many others
// there are.
std::string RandomName(const std::string& kind);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_RANDOM_NAME_H_
