#ifndef BCCSKEL_CORE_EXEC_READ_AHEAD_H_
#define BCCSKEL_CORE_EXEC_READ_AHEAD_H_

#include <algorithm>
#include <array>
#include <cstddef>

#include "absl/status/status.h"
#include "core/exec/context.h"
#include "core/exec/status_macros.h"

namespace bccskel::exec {

// For input that is read and used in order: calls `read(n, room)` and then `use(n, room)` for n =
// 0..count-1. Part n + 1 is read while n is used if a second thread is free. A part should take at
// least 0.1 ms, since threads meet after each. Memory: two rooms.
// Threads: neither function runs twice at once; both may run on any worker.
// Errors: the first error of `read` or `use`, both `absl::Status`; no part after that is used.
template <typename Room, typename Read, typename Use>
absl::Status ReadAhead(const Context& context, size_t count, Read read, Use use) {
  std::array<Room, 2> rooms;
  for (size_t n = 0; n <= count; ++n) {
    absl::Status was_used, was_read;
    Portions tasks(2, 1);
    context.Offer(std::min(context.usable_threads(), 2), [&](int /*worker*/) {
      for (Share task = tasks.Take(); task.begin < task.end; task = tasks.Take()) {
        if (task.begin == 0 && n < count) was_read = read(n, rooms[n % 2]);
        if (task.begin == 1 && n > 0) was_used = use(n - 1, rooms[(n - 1) % 2]);
      }
    });
    BCCSKEL_RETURN_IF_ERROR(was_used);
    BCCSKEL_RETURN_IF_ERROR(was_read);
  }
  return absl::OkStatus();
}

}  // namespace bccskel::exec

#endif  // BCCSKEL_CORE_EXEC_READ_AHEAD_H_
