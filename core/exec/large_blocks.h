#ifndef BCCSKEL_CORE_EXEC_LARGE_BLOCKS_H_
#define BCCSKEL_CORE_EXEC_LARGE_BLOCKS_H_

#include <cstddef>
#include <mutex>
#include <vector>

namespace bccskel::exec {

// Large blocks of memory that successive jobs reuse. The system would map them anew for each job,
// and the first touch of their pages costs more than thinning the points there.
// Threads: safe.
class LargeBlocks {
 public:
  static constexpr size_t kSmallest = size_t{1} << 20;

  // Keeps at most `most_idle` unused bytes.
  explicit LargeBlocks(size_t most_idle);
  ~LargeBlocks();
  LargeBlocks(const LargeBlocks&) = delete;
  LargeBlocks& operator=(const LargeBlocks&) = delete;

  // The block's contents are those of its last use. Throws std::bad_alloc.
  void* Take(size_t bytes);
  // Returns a block to the pool. `bytes` as given to Take().
  void Give(void* block, size_t bytes) noexcept;

  // Frees the blocks that have not been used since the last call. A program that calls it from time
  // to time holds no memory while it is idle.
  void ReleaseUnused() noexcept;

  size_t idle_bytes() const;

 private:
  struct Idle {
    void* block;
    size_t size;
    bool seen;  // by ReleaseUnused()
  };

  // Null if no block has this size. In that case frees as many bytes, the longest idle blocks
  // first, so that a job's peak is about what it would be without the pool.
  void* TakeIdle(size_t size);
  void MakeRoom(size_t size);

  const size_t most_idle_;
  mutable std::mutex mutex_;
  std::vector<Idle> idle_;  // guarded by mutex_
  size_t idle_bytes_ = 0;   // guarded by mutex_
};

// The pool of this process.
LargeBlocks& ProcessLargeBlocks();

}  // namespace bccskel::exec

#endif  // BCCSKEL_CORE_EXEC_LARGE_BLOCKS_H_
