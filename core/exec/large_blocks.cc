#include "core/exec/large_blocks.h"

#include <algorithm>
#include <new>

#include "core/exec/huge_pages.h"

namespace bccskel::exec {
namespace {

// Huge pages are aligned to their size.
constexpr std::align_val_t kAlignment{size_t{2} << 20};

// A job of 8 million points has 30 MB in such blocks. The admission of jobs does not account for
// idle blocks, so few are kept.
constexpr size_t kMostIdle = size_t{64} << 20;
constexpr size_t kMostIdleBlocks = 256;

// Rounds up in steps of an eighth, so that jobs of about the same size can use each other's blocks.
size_t SizeFor(size_t bytes) {
  size_t step = LargeBlocks::kSmallest / 8;
  while (step * 16 < bytes) step *= 2;
  return (bytes + step - 1) / step * step;
}

void Free(void* block) { ::operator delete(block, kAlignment); }

}  // namespace

LargeBlocks::LargeBlocks(size_t most_idle) : most_idle_(most_idle) {
  idle_.reserve(kMostIdleBlocks);
}

LargeBlocks::~LargeBlocks() {
  for (const Idle& idle : idle_) Free(idle.block);
}

void* LargeBlocks::Take(size_t bytes) {
  const size_t size = SizeFor(bytes);
  if (void* idle = TakeIdle(size); idle != nullptr) return idle;
  void* block = ::operator new(size, kAlignment, std::nothrow);
  if (block == nullptr) {  // idle blocks of other sizes may hold the memory
    ReleaseUnused();
    ReleaseUnused();
    block = ::operator new(size, kAlignment);
  }
  PreferHugePages(block, bytes);  // the rest takes no memory until it is used
  return block;
}

void* LargeBlocks::TakeIdle(size_t size) {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(idle_, size, &Idle::size);
  if (found == idle_.end()) {
    MakeRoom(size);
    return nullptr;
  }
  void* block = found->block;
  idle_bytes_ -= size;
  idle_.erase(found);
  return block;
}

void LargeBlocks::MakeRoom(size_t size) {
  size_t freed = 0;
  auto first_kept = idle_.begin();
  for (; first_kept != idle_.end() && freed < size; ++first_kept) {
    Free(first_kept->block);
    freed += first_kept->size;
  }
  idle_.erase(idle_.begin(), first_kept);
  idle_bytes_ -= freed;
}

void LargeBlocks::Give(void* block, size_t bytes) noexcept {
  const size_t size = SizeFor(bytes);
  {
    const std::lock_guard lock(mutex_);
    if (idle_bytes_ + size <= most_idle_ && idle_.size() < kMostIdleBlocks) {
      idle_.push_back({block, size, false});
      idle_bytes_ += size;
      return;
    }
  }
  Free(block);
}

void LargeBlocks::ReleaseUnused() noexcept {
  const std::lock_guard lock(mutex_);
  std::erase_if(idle_, [this](const Idle& idle) {
    if (!idle.seen) return false;
    Free(idle.block);
    idle_bytes_ -= idle.size;
    return true;
  });
  for (Idle& idle : idle_) idle.seen = true;
}

size_t LargeBlocks::idle_bytes() const {
  const std::lock_guard lock(mutex_);
  return idle_bytes_;
}

LargeBlocks& ProcessLargeBlocks() {
  // Never destroyed: blocks are given back until the process ends.
  static LargeBlocks& blocks = *new LargeBlocks(kMostIdle);
  return blocks;
}

}  // namespace bccskel::exec
