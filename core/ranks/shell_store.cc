#include "core/ranks/shell_store.h"

#include <utility>

namespace bccskel::ranks {

ShellStore::ShellStore(Exchange& exchange, const RankBricks& bricks, double shell_width,
                       Depths depths)
    : exchange_(exchange),
      bricks_(bricks),
      shell_width_(shell_width),
      depths_(depths),
      planes_(bricks.local.brick_count() + 1),
      ranges_(bricks.local.brick_count()),
      deep_(depths == Depths::kWanted ? bricks.local.brick_count() + 1 : 0) {
  planes_.back() = {};
  if (!deep_.empty()) deep_.back() = {};
}

void ShellStore::Trade(const Volume& volume, exec::Share measured, const DistanceField& field,
                       const exec::Context& context) {
  const Shells shells = BuildShells(volume, field, shell_width_, context);
  BrickDepths deep;
  if (depths_ == Depths::kWanted) deep = BuildDepths(volume, field, context);
  std::vector<Bytes> out(static_cast<size_t>(exchange_.size()));
  for (auto n = static_cast<BrickIndex>(measured.begin); n < measured.end; ++n) {
    const BrickKey key = volume.keys()[n];
    Bytes& to = out[static_cast<size_t>(bricks_.owners.OwnerOf(key))];
    Pack(key, to);
    Pack(shells.planes()[n], to);
    Pack(shells.RangeOf(n), to);
    if (!deep.empty()) Pack(deep[n], to);
  }
  for (const Bytes& letter : TradeWithAll(exchange_, std::move(out))) {
    for (Unpacker from(letter); !from.done();) Keep(from);
  }
}

void ShellStore::Keep(Unpacker& from) {
  const BrickIndex n = *bricks_.local.Find(from.Take<BrickKey>());
  planes_[n] = from.Take<ShellPlanes>();
  ranges_[n] = from.Take<Shells::Range>();
  if (depths_ == Depths::kWanted) deep_[n] = from.Take<DepthPlanes>();
}

RankShells ShellStore::Finish() && {
  ShareWithGhosts(exchange_, bricks_, std::span(planes_));
  ShareWithGhosts(exchange_, bricks_, std::span(ranges_));
  if (depths_ == Depths::kWanted) ShareWithGhosts(exchange_, bricks_, std::span(deep_));
  Shells shells(std::move(planes_), std::move(ranges_));
  auto last = static_cast<uint64_t>(shells.last());
  exchange_.Max({&last, 1});
  shells.SetLast(static_cast<int32_t>(last));
  return {std::move(shells), std::move(deep_)};
}

}  // namespace bccskel::ranks
