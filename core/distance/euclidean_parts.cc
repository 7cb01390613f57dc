#include "core/distance/euclidean_parts.h"

#include <bit>
#include <numeric>
#include <optional>
#include <utility>

#include "core/distance/border_bricks.h"
#include "core/volume/brick_neighbors.h"

namespace bccskel {
namespace {

// Positions in a BrickNeighborhood.
constexpr size_t kRightBrick = 8, kLeftBrick = 9;

// The direction in which rows are walked.
enum class Side : int8_t { kLeft = -1, kRight = 1 };

BrickCoordinates PlaceBeside(BrickCoordinates brick, Side side) {
  brick.bx += static_cast<int32_t>(side);
  return brick;
}

// The stored brick beside brick n along x. In the order of a Volume at most one other brick lies
// between them.
std::optional<BrickIndex> BrickBeside(const Volume& object, BrickIndex n, Side side) {
  const BrickKey wanted(PlaceBeside(object.keys()[n].coordinates(), side));
  for (int64_t places = 1; places <= 2; ++places) {
    const int64_t at = n + places * static_cast<int64_t>(side);
    if (at < 0 || at >= static_cast<int64_t>(object.brick_count())) break;
    if (object.keys()[static_cast<size_t>(at)] == wanted) return static_cast<BrickIndex>(at);
  }
  return std::nullopt;
}

// Extends the runs of the open rows into a brick. Returns the rows that are still open.
uint32_t Lengthen(const BrickBits& brick, Side side, uint32_t open, RowRuns<uint32_t>& runs) {
  for (uint32_t rest = open; rest != 0; rest &= rest - 1) {
    const auto row = static_cast<size_t>(std::countr_zero(rest));
    const uint16_t bits = RowBits(brick, row);
    const int more = side == Side::kLeft ? std::countl_one(bits) : std::countr_one(bits);
    runs[row] += static_cast<uint32_t>(more);
    if (bits != 0xffff) open &= ~(uint32_t{1} << row);
  }
  return open;
}

// The runs beside a brick's rows. Outside the window no background ends them.
RowRuns<uint32_t> WalkRuns(const Volume& object, BrickIndex n, Side side) {
  constexpr auto kAllRows = ~uint32_t{0};
  RowRuns<uint32_t> runs = {};
  uint32_t open = kAllRows, full = 0;  // of full bricks, all rows
  for (std::optional<BrickIndex> next = BrickBeside(object, n, side); open != 0 && next.has_value();
       next = BrickBeside(object, n, side)) {
    n = *next;
    const BrickBits& brick = object.bricks()[n];
    if (open == kAllRows && IsFull(brick)) {
      full += kBrickX;
    } else {
      open = Lengthen(brick, side, open, runs);
    }
  }
  const bool is_unknown =
      open != 0 && object.IsUnknown(PlaceBeside(object.keys()[n].coordinates(), side));
  for (size_t row = 0; row < runs.size(); ++row) {
    runs[row] = is_unknown && (open >> row & 1) != 0 ? kUnknownRun : runs[row] + full;
  }
  return runs;
}

// The runs beside a part, which consists of these `bricks` of the object.
SideRuns<uint32_t> RunsBesidePart(const Volume& object, std::span<const BrickIndex> bricks,
                                  const Volume& part, const exec::Context& context) {
  SideRuns<uint32_t> runs(bricks.size());
  std::vector<BrickIndex> slabs;  // where those of one bz begin
  const std::span<const BrickKey> keys = part.keys();
  for (BrickIndex n = 0; n < keys.size(); ++n) {
    if (n == 0 || keys[n].coordinates().bz != keys[n - 1].coordinates().bz) slabs.push_back(n);
  }
  slabs.push_back(static_cast<BrickIndex>(keys.size()));
  exec::Portions portions(slabs.size() - 1, 1);
  context.Offer(context.WorkersFor(keys.size()), [&](int) {
    for (exec::Share mine = portions.Take(); mine.begin < mine.end; mine = portions.Take()) {
      const BrickIndex first = slabs[mine.begin], last = slabs[mine.end];
      for (BrickIndex n = first; n < last; ++n) {
        const BrickNeighborhood& beside = part.neighbors()[n];
        if (beside[kLeftBrick] == keys.size())
          runs.left[n] = WalkRuns(object, bricks[n], Side::kLeft);
        if (beside[kRightBrick] == keys.size()) {
          runs.right[n] = WalkRuns(object, bricks[n], Side::kRight);
        }
      }
      FindSideRuns<uint32_t>(part.padded_bricks().data(), part.neighbors().data(), first, last,
                             kUnknownRun, 0, runs);
    }
  });
  return runs;
}

}  // namespace

ObjectPart PartOf(const Volume& object, std::span<const BrickIndex> bricks,
                  const exec::Context& context) {
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bits;
  keys.reserve(bricks.size());
  bits.reserve(bricks.size() + 1);  // Volume adds one
  for (const BrickIndex n : bricks) {
    keys.push_back(object.keys()[n]);
    bits.push_back(object.bricks()[n]);
  }
  Volume part = Volume::FromSortedBricks(object.extent(), object.placement(), std::move(keys),
                                         std::move(bits));
  part.SetWindow(object.window());
  SideRuns<uint32_t> runs = RunsBesidePart(object, bricks, part, context);
  return {std::move(part), std::move(runs)};
}

SideRuns<uint32_t> SideRunsOf(const Volume& object, const exec::Context& context) {
  std::vector<BrickIndex> all(object.brick_count());
  std::iota(all.begin(), all.end(), BrickIndex{0});
  return RunsBesidePart(object, all, object, context);
}

std::vector<uint64_t> BricksAtX(const Volume& object) {
  std::vector<uint64_t> counts(static_cast<size_t>((object.extent().nx + kBrickX - 1) / kBrickX));
  for (const BrickKey key : object.keys()) ++counts[static_cast<size_t>(key.coordinates().bx)];
  return counts;
}

std::vector<std::vector<BrickIndex>> ColumnsOf(const Volume& object,
                                               std::span<const uint64_t> counts, size_t least) {
  std::vector<size_t> group_at;  // by bx
  size_t group = 0;
  uint64_t bricks = 0;
  for (const uint64_t count : counts) {
    group_at.push_back(group);
    bricks += count;
    if (bricks < least) continue;
    ++group;
    bricks = 0;
  }
  std::vector<std::vector<BrickIndex>> groups(bricks == 0 ? group : group + 1);
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    groups[group_at[static_cast<size_t>(object.keys()[n].coordinates().bx)]].push_back(n);
  }
  return groups;
}

}  // namespace bccskel
