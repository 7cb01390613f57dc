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

void ShellStore::KeepAll(const std::vector<Bytes>& letters) {
  for (const Bytes& letter : letters) {
    for (Unpacker from(letter); !from.done();) Keep(from);
  }
}

void ShellStore::Keep(Unpacker& from) {
  const BrickIndex n = *bricks_.local.Find(from.Take<BrickKey>());
  planes_[n] = from.Take<ShellPlanes>();
  ranges_[n] = from.Take<Shells::Range>();
  if (depths_ == Depths::kWanted) deep_[n] = from.Take<DepthPlanes>();
}

void ShellStore::Expect(const Volume& volume, exec::Share measured) {
  first_measured_ = measured.begin;
  places_.clear();
  away_.clear();
  for (auto n = static_cast<BrickIndex>(measured.begin); n < measured.end; ++n) {
    const std::optional<BrickIndex> own = bricks_.local.Find(volume.keys()[n]);
    const bool is_own = own.has_value() && *own >= bricks_.own.begin && *own < bricks_.own.end;
    places_.push_back({is_own, is_own ? *own : static_cast<BrickIndex>(away_.size())});
    if (!is_own) away_.push_back(n);
  }
  away_planes_.resize(away_.size());
  away_ranges_.resize(away_.size());
  if (depths_ == Depths::kWanted) away_deep_.resize(away_.size());
}

ShellPlaces ShellStore::Places() {
  ShellPlaces places = {[this](BrickIndex brick) { return ShellsOf(brick); }};
  if (depths_ == Depths::kWanted) {
    places.depths = [this](BrickIndex brick) -> DepthPlanes& { return DepthsOf(brick); };
  }
  return places;
}
SquareSlicer ShellStore::Slicer() {
  return {AxisScaleOf(bricks_.local.placement()), shell_width_, Places()};
}

ShellPlace ShellStore::ShellsOf(BrickIndex brick) {
  const auto [is_own, n] = places_[brick - first_measured_];
  if (is_own) return {&planes_[n], &ranges_[n]};
  return {&away_planes_[n], &away_ranges_[n]};
}

DepthPlanes& ShellStore::DepthsOf(BrickIndex brick) {
  const auto [is_own, n] = places_[brick - first_measured_];
  return is_own ? deep_[n] : away_deep_[n];
}

void ShellStore::SendAway(const Volume& volume) {
  constexpr size_t kBytes =
      sizeof(BrickKey) + sizeof(ShellPlanes) + sizeof(Shells::Range) + sizeof(DepthPlanes);
  const auto owner_of = [&](BrickIndex n) {
    return static_cast<size_t>(bricks_.owners.OwnerOf(volume.keys()[n]));
  };
  std::vector<size_t> counts(static_cast<size_t>(exchange_.size()));
  for (const BrickIndex n : away_) ++counts[owner_of(n)];
  std::vector<Bytes> out(counts.size());
  for (size_t n = 0; n < away_.size(); ++n) {
    const BrickKey key = volume.keys()[away_[n]];
    Bytes& to = out[owner_of(away_[n])];
    if (to.empty()) to.reserve(counts[owner_of(away_[n])] * kBytes);
    Pack(key, to);
    Pack(away_planes_[n], to);
    Pack(away_ranges_[n], to);
    if (!away_deep_.empty()) Pack(away_deep_[n], to);
  }
  away_planes_ = {};
  away_deep_ = {};
  KeepAll(TradeWithAll(exchange_, std::move(out)));
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
