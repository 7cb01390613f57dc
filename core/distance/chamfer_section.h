#ifndef BCCSKEL_CORE_DISTANCE_CHAMFER_SECTION_H_
#define BCCSKEL_CORE_DISTANCE_CHAMFER_SECTION_H_

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/distance/chamfer_rows.h"
#include "core/exec/uninitialized.h"
#include "core/volume/volume.h"

namespace bccskel {

// The bricks of one bz.
struct BrickSlab {
  BrickIndex first = 0;
  BrickIndex last = 0;
  std::array<std::vector<BrickIndex>, 2> bricks;  // by sublattice
  std::vector<BrickIndex> lines;                  // where the bricks of each `by` begin

  size_t size() const { return last - first; }
};

// Consecutive slabs whose bricks are numbered from 0, with room for their distances. Of the slabs
// before and after, the section holds the adjacent layer.
template <typename T>
class ChamferSection {
 public:
  // One layer of a slab's bricks.
  static constexpr size_t kLayer = kBrickX * kBrickY;
  using Layer = exec::UninitializedVector<T>;

  // Covers the whole object.
  ChamferSection(const Volume& object, std::span<const BrickSlab> slabs)
      : ChamferSection(object, slabs, 0, slabs.size()) {}

  // Covers the slabs [first, last) of `all`.
  ChamferSection(const Volume& object, std::span<const BrickSlab> all, size_t first, size_t last)
      : below_(first > 0 ? all[first - 1].size() : 0),
        above_(last < all.size() ? all[last].size() : 0),
        start_(first < last ? all[first].first - static_cast<BrickIndex>(below_) : 0) {
    const BrickIndex end = first < last ? all[last - 1].last + static_cast<BrickIndex>(above_) : 0;
    padding_ = end - start_;
    for (const BrickSlab& slab : all.subspan(first, last - first)) slabs_.push_back(Moved(slab));
    bricks_ = object.bricks().data() + start_;
    neighbors_ = object.neighbors();
    if (padding_ != object.brick_count()) Renumber();
    values_.resize((size_t{padding_} + 1) * kBrickPoints);
    std::fill(values_.end() - kBrickPoints, values_.end(), T{0});
    if (object.window().has_value()) AddUnknown(object);
  }

  std::span<const BrickSlab> slabs() const { return slabs_; }
  // Add this to a brick's number to get its number in the volume.
  BrickIndex start() const { return start_; }
  DistanceView<T> View(const ChamferWeights& weights, const RunTables* runs) {
    return {bricks_, neighbors_.data(), values_.data(), weights, runs, unknown_};
  }
  const T* Of(BrickIndex brick) const { return values_.data() + size_t{brick} * kBrickPoints; }
  exec::UninitializedVector<T> TakeValues() && {
    values_.resize((size_t{padding_} + 1) * kBrickPoints);
    return std::move(values_);
  }

  // The first and last layer of the section, and the adjacent layers of the slabs beside it: what
  // consecutive sections exchange.
  Layer TopLayer() const { return LayerOf(slabs_.back().first, slabs_.back().size(), kBrickZ - 1); }
  Layer BottomLayer() const { return LayerOf(slabs_.front().first, slabs_.front().size(), 0); }
  void SetLayerBelow(const Layer& layer) { SetLayer(0, layer, kBrickZ - 1); }
  void SetLayerAbove(const Layer& layer) {
    SetLayer(padding_ - static_cast<BrickIndex>(above_), layer, 0);
  }

 private:
  BrickSlab Moved(BrickSlab slab) const {
    slab.first -= start_;
    slab.last -= start_;
    for (std::vector<BrickIndex>& bricks : slab.bricks) {
      for (BrickIndex& n : bricks) n -= start_;
    }
    for (BrickIndex& n : slab.lines) n -= start_;
    return slab;
  }

  void Renumber() {
    own_neighbors_.assign(neighbors_.begin() + start_, neighbors_.begin() + start_ + padding_);
    for (BrickNeighborhood& near : own_neighbors_) {
      for (BrickIndex& n : near) n = n >= start_ && n - start_ < padding_ ? n - start_ : padding_;
    }
    neighbors_ = own_neighbors_;
  }

  // Needs: the section covers the whole object.
  void AddUnknown(const Volume& object) {
    unknown_ = padding_ + 1;
    values_.insert(values_.end(), kBrickPoints, std::numeric_limits<T>::max());
    own_neighbors_.assign(neighbors_.begin(), neighbors_.end());
    for (BrickIndex n = 0; n < padding_; ++n) {
      const BrickCoordinates brick = object.keys()[n].coordinates();
      for (size_t side = 0; side < own_neighbors_[n].size(); ++side) {
        BrickIndex& near = own_neighbors_[n][side];
        const bool is_stored = near != padding_;
        if (!is_stored && object.IsUnknown(NeighborBrick(brick, static_cast<int>(side)))) {
          near = *unknown_;
        }
      }
    }
    neighbors_ = own_neighbors_;
  }

  T* LayerAt(BrickIndex brick, int k) {
    return values_.data() + size_t{brick} * kBrickPoints + kLayer * static_cast<size_t>(k);
  }
  Layer LayerOf(BrickIndex first, size_t bricks, int k) const {
    Layer layer(bricks * kLayer);
    for (size_t n = 0; n < bricks; ++n) {
      const T* from = Of(first + static_cast<BrickIndex>(n)) + kLayer * static_cast<size_t>(k);
      std::copy_n(from, kLayer, layer.data() + n * kLayer);
    }
    return layer;
  }
  void SetLayer(BrickIndex first, const Layer& layer, int k) {
    for (size_t n = 0; n < layer.size() / kLayer; ++n) {
      std::copy_n(layer.data() + n * kLayer, kLayer,
                  LayerAt(first + static_cast<BrickIndex>(n), k));
    }
  }

  size_t below_;  // number of bricks in the slab below; likewise above
  size_t above_;
  BrickIndex start_;
  BrickIndex padding_ = 0;
  std::optional<BrickIndex> unknown_;
  std::vector<BrickSlab> slabs_;
  const BrickBits* bricks_ = nullptr;
  std::span<const BrickNeighborhood> neighbors_;
  std::vector<BrickNeighborhood> own_neighbors_;
  exec::UninitializedVector<T> values_;
};

// Updates the distances of a row from the adjacent row along y: a pair of D8 steps, one up and one
// down, leads to the columns on either side.
template <typename T>
void TakeInPairs(const DistanceView<T>& view, BrickIndex brick, int row, int way) {
  const auto row_of = [&](BrickIndex at, int n) {
    return view.values + size_t{at} * kBrickPoints + static_cast<size_t>(kBrickX * n);
  };
  const int beside_row = row % kBrickY + way;
  const bool is_same = beside_row >= 0 && beside_row < kBrickY;
  const BrickIndex beside = is_same ? brick : view.neighbors[brick][way < 0 ? 11 : 10];
  const int n = is_same ? row + way : row - way * (kBrickY - 1);
  const T* from = row_of(beside, n);
  std::array<T, kBrickX + 2> nearest;
  std::copy_n(from, kBrickX, nearest.begin() + 1);
  const bool is_stored = beside + 1 < *view.unknown;
  nearest.front() = is_stored ? row_of(view.neighbors[beside][9], n)[kBrickX - 1] : from[0];
  nearest.back() = is_stored ? row_of(view.neighbors[beside][8], n)[0] : from[kBrickX - 1];
  T* to = row_of(brick, row);
  for (size_t i = 0; i < kBrickX; ++i) {
    const uint64_t pair =
        uint64_t{std::min(nearest[i], nearest[i + 2])} + 2 * view.weights.diagonal;
    to[i] = static_cast<T>(std::min(uint64_t{to[i]}, pair));
  }
}

template <typename T>
void SpreadInPairs(const DistanceView<T>& view, const BrickSlab& slab) {
  constexpr int kRows = kBrickPoints / kBrickX;
  const auto take = [&](size_t line, int row, int way) {
    const BrickIndex end = line + 1 < slab.lines.size() ? slab.lines[line + 1] : slab.last;
    for (BrickIndex n = slab.lines[line]; n < end; ++n) TakeInPairs(view, n, row, way);
  };
  for (size_t line = 0; line < slab.lines.size(); ++line) {
    for (int row = 0; row < kRows; ++row) take(line, row, -1);
  }
  for (size_t line = slab.lines.size(); line-- > 0;) {
    for (int row = kRows; row-- > 0;) take(line, row, 1);
  }
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_CHAMFER_SECTION_H_
