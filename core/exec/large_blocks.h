#ifndef BCCSKEL_CORE_EXEC_LARGE_BLOCKS_H_
#define BCCSKEL_CORE_EXEC_LARGE_BLOCKS_H_

#include <cstddef>
#include <mutex>
#include <vector>

namespace bccskel::exec {

// Large blocks of memory that jobs hand on to the next job. The system maps such blocks anew each
// time, and then a first touch of their pages costs more than thinning the points there.
// Threads: safe.
class LargeBlocks {
 public:
  static constexpr size_t kSmallest = size_t{1} << 20;

  // Keeps up to `most_idle` bytes that nobody uses.
  explicit LargeBlocks(size_t most_idle);
  ~LargeBlocks();
  LargeBlocks(const LargeBlocks&) = delete;
  LargeBlocks& operator=(const LargeBlocks&) = delete;

  // What is in the block is left from its last use. Throws std::bad_alloc.
  void* Take(size_t bytes);
  // `bytes` as it was taken.
  void Give(void* block, size_t bytes) noexcept;

  // Gives back to the system what nobody has used since the last call. For a program that runs on
  // when there is nothing to do: called now and then, it keeps no memory then.
  void ReleaseUnused() noexcept;

  size_t idle_bytes() const;

 private:
  struct Idle {
    void* block;
    size_t size;
    bool seen;  // by ReleaseUnused()
  };

  // Null where there is none of this size: then as much as that is given back to the system, the
  // longest idle first, so that a job's peak is about what it would be by itself.
  void* TakeIdle(size_t size);
  void MakeRoom(size_t size);

  const size_t most_idle_;
  mutable std::mutex mutex_;
  std::vector<Idle> idle_;  // guarded by mutex_
  size_t idle_bytes_ = 0;   // guarded by mutex_
};

// Those of this process.
LargeBlocks& ProcessLargeBlocks();

}  // namespace bccskel::exec

#endif  // BCCSKEL_CORE_EXEC_LARGE_BLOCKS_H_
