#ifndef BCCSKEL_SERVER_SETTINGS_MEMORY_LIMIT_H_
#define BCCSKEL_SERVER_SETTINGS_MEMORY_LIMIT_H_

#include <cstdint>
#include <string>

namespace bccskel::server {

// Memory that this process may use, in bytes: that of the machine, or the least limit of its
// control groups and of those around them, v1 and v2. 4 GiB where nothing can be read. `root` is
// where proc and sys are found.
uint64_t AvailableMemoryBytes(const std::string& root = "");

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SETTINGS_MEMORY_LIMIT_H_
