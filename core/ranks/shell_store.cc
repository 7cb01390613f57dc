#include "core/ranks/shell_store.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace bccskel::ranks {

ShellStore::ShellStore(Exchange& exchange, const RankBricks& bricks, double shell_width,
                       Depths depths)
    : exchange_(exchange),
      bricks_(bricks),
      shell_width_(shell_width),
      depths_(depths),
      shells_(bricks.local.brick_count()),
      deep_(depths == Depths::kWanted ? bricks.local.brick_count() : 0) {}

void ShellStore::Trade(const Volume& volume, exec::Share measured, const DistanceField& field,
                       const exec::Context& context) {
  const Shells shells = BuildShells(volume, field, shell_width_, context);
  std::optional<Shells> deep;
  if (depths_ == Depths::kWanted) deep = BuildDepths(volume, field, context);
  std::vector<Bytes> out(static_cast<size_t>(exchange_.size()));
  for (auto n = static_cast<BrickIndex>(measured.begin); n < measured.end; ++n) {
    const BrickKey key = volume.keys()[n];
    Bytes& to = out[static_cast<size_t>(bricks_.owners.OwnerOf(key))];
    Pack(key, to);
    Pack(shells.planes()[n], to);
    Pack(shells.RangeOf(n), to);
    if (deep.has_value()) Pack(deep->planes()[n], to);
  }
  for (const Bytes& letter : TradeWithAll(exchange_, std::move(out))) {
    for (Unpacker from(letter); !from.done();) Keep(from);
  }
}

void ShellStore::Keep(Unpacker& from) {
  const BrickIndex n = *bricks_.local.Find(from.Take<BrickKey>());
  shells_.planes[n] = from.Take<ShellPlanes>();
  shells_.ranges[n] = from.Take<Shells::Range>();
  if (depths_ == Depths::kWanted) deep_.planes[n] = from.Take<ShellPlanes>();
}

RankShells ShellStore::Finish() && {
  ShareWithGhosts(exchange_, bricks_, std::span(shells_.planes));
  ShareWithGhosts(exchange_, bricks_, std::span(shells_.ranges));
  if (depths_ == Depths::kWanted) ShareWithGhosts(exchange_, bricks_, std::span(deep_.planes));
  uint64_t last = 0;
  for (const Shells::Range& range : shells_.ranges) {
    last = std::max(last, static_cast<uint64_t>(range.last));
  }
  exchange_.Max({&last, 1});
  return {ShellsOf(std::move(shells_), static_cast<int32_t>(last)), ShellsOf(std::move(deep_), 0)};
}

Shells ShellStore::ShellsOf(Planes planes, int32_t last) {
  Shells shells(std::move(planes.planes), std::move(planes.ranges));
  shells.SetLast(last);
  return shells;
}

}  // namespace bccskel::ranks
