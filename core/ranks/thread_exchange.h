#ifndef BCCSKEL_CORE_RANKS_THREAD_EXCHANGE_H_
#define BCCSKEL_CORE_RANKS_THREAD_EXCHANGE_H_

#include <functional>

#include "core/ranks/exchange.h"

namespace bccskel::ranks {

// Runs `work` as each of `size` ranks, threads of this process, and returns when all are done.
// Needs: size >= 1; `work` throws nothing.
void RunAsThreads(int size, const std::function<void(Exchange&)>& work);

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_THREAD_EXCHANGE_H_
