#ifndef BCCSKEL_SERVER_METRICS_PROCESS_FIGURES_H_
#define BCCSKEL_SERVER_METRICS_PROCESS_FIGURES_H_

#include <chrono>
#include <cstdint>

namespace bccskel::server {

// This process as the system sees it; 0 for what the system does not tell.
struct ProcessFigures {
  std::chrono::duration<double> processor_time{0};  // user and system
  uint64_t resident_bytes = 0;
  uint64_t open_files = 0;
  uint64_t max_open_files = 0;
  uint64_t threads = 0;
};

// Cost: about 100 us, more with thousands of open files.
ProcessFigures ReadProcessFigures();

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_METRICS_PROCESS_FIGURES_H_
