#ifndef BCCSKEL_CORE_DIGEST_RANDOM_ID_H_
#define BCCSKEL_CORE_DIGEST_RANDOM_ID_H_

#include <string>

namespace bccskel {

// 32 random hexadecimal digits, for names that nobody can guess.
std::string RandomId();

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DIGEST_RANDOM_ID_H_
