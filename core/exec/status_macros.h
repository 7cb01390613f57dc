#ifndef BCCSKEL_CORE_EXEC_STATUS_MACROS_H_
#define BCCSKEL_CORE_EXEC_STATUS_MACROS_H_

#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

// Returns from the calling function when `expression` is an error status.
#define BCCSKEL_RETURN_IF_ERROR(expression)                                                      \
  do {                                                                                           \
    if (absl::Status bccskel_status = (expression); !bccskel_status.ok()) return bccskel_status; \
  } while (false)

#define BCCSKEL_STATUS_CONCAT_INNER(a, b) a##b
#define BCCSKEL_STATUS_CONCAT(a, b) BCCSKEL_STATUS_CONCAT_INNER(a, b)

// Evaluates a StatusOr expression; binds its value to `target` or returns its status.
#define BCCSKEL_ASSIGN_OR_RETURN(target, expression) \
  BCCSKEL_ASSIGN_OR_RETURN_IMPL(BCCSKEL_STATUS_CONCAT(bccskel_or_, __LINE__), target, expression)
#define BCCSKEL_ASSIGN_OR_RETURN_IMPL(result, target, expression) \
  auto result = (expression);                                     \
  if (!result.ok()) return std::move(result).status();            \
  target = *std::move(result)

#endif  // BCCSKEL_CORE_EXEC_STATUS_MACROS_H_
