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
  KeepAll(TradeWithAll(exchange_, std::move(out)));
}

void ShellStore::KeepAll(const std::vector<Bytes>& letters) {
  for (const Bytes& letter : letters) {
    for (Unpacker from(letter); !from.done();) Keep(from);
  }
}

void ShellStore::Keep(Unpacker& from) {
  const BrickIndex n = *bricks_.local.Find(from.Take<BrickKey>());
  shells_.planes[n] = from.Take<ShellPlanes>();
  shells_.ranges[n] = from.Take<Shells::Range>();
  if (depths_ == Depths::kWanted) deep_.planes[n] = from.Take<ShellPlanes>();
}

void ShellStore::Expect(const Volume& volume, exec::Share measured) {
  first_measured_ = measured.begin;
  for (auto n = static_cast<BrickIndex>(measured.begin); n < measured.end; ++n) {
    const std::optional<BrickIndex> own = bricks_.local.Find(volume.keys()[n]);
    const bool is_own = own.has_value() && *own >= bricks_.own.begin && *own < bricks_.own.end;
    places_.push_back({is_own, is_own ? *own : static_cast<BrickIndex>(away_.size())});
    if (!is_own) away_.push_back(n);
  }
  away_shells_ = Planes(away_.size());
  away_deep_ = Planes(depths_ == Depths::kWanted ? away_.size() : 0);
}

ShellPlace ShellStore::ShellsOf(BrickIndex brick) {
  const Place& place = places_[brick - first_measured_];
  Planes& planes = place.is_own ? shells_ : away_shells_;
  return {&planes.planes[place.n], &planes.ranges[place.n]};
}

ShellPlace ShellStore::DepthsOf(BrickIndex brick) {
  const Place& place = places_[brick - first_measured_];
  Planes& planes = place.is_own ? deep_ : away_deep_;
  return {&planes.planes[place.n], &planes.ranges[place.n]};
}

void ShellStore::SendAway(const Volume& volume) {
  std::vector<Bytes> out(static_cast<size_t>(exchange_.size()));
  for (size_t n = 0; n < away_.size(); ++n) {
    const BrickKey key = volume.keys()[away_[n]];
    Bytes& to = out[static_cast<size_t>(bricks_.owners.OwnerOf(key))];
    Pack(key, to);
    Pack(away_shells_.planes[n], to);
    Pack(away_shells_.ranges[n], to);
    if (depths_ == Depths::kWanted) Pack(away_deep_.planes[n], to);
  }
  away_shells_ = away_deep_ = Planes(0);
  KeepAll(TradeWithAll(exchange_, std::move(out)));
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
  return {Joined(std::move(shells_), static_cast<int32_t>(last)), Joined(std::move(deep_), 0)};
}

Shells ShellStore::Joined(Planes planes, int32_t last) {
  Shells shells(std::move(planes.planes), std::move(planes.ranges));
  shells.SetLast(last);
  return shells;
}

}  // namespace bccskel::ranks
