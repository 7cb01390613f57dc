#include "tests/quality/voxel_mask.h"

#include <algorithm>
#include <bit>
#include <random>

#include "core/exec/status_macros.h"
#include "core/labels/convert_label.h"
#include "core/mask/mask_converter.h"

namespace bccskel::quality {
namespace {

// Places of the 3 x 3 x 3 box around a voxel as bits, itself in the middle.
constexpr int kPlaces = 27;
constexpr int kMiddle = 13;

constexpr Voxel OffsetOf(int place) { return {place % 3 - 1, place / 3 % 3 - 1, place / 9 - 1}; }
constexpr int StepsOf(int place) {
  const Voxel o = OffsetOf(place);
  return o[0] * o[0] + o[1] * o[1] + o[2] * o[2];
}

// Of each place: those that share a corner with it (3) or a face (1).
constexpr std::array<uint32_t, kPlaces> Touching(int most_steps) {
  std::array<uint32_t, kPlaces> touching = {};
  for (int a = 0; a < kPlaces; ++a) {
    for (int b = 0; b < kPlaces; ++b) {
      const Voxel p = OffsetOf(a), q = OffsetOf(b);
      int steps = 0;
      bool near = a != b;
      for (size_t n = 0; n < 3; ++n) {
        const int way = p[n] - q[n];
        steps += way * way;
        near = near && way * way <= 1;
      }
      if (near && steps <= most_steps) touching[static_cast<size_t>(a)] |= 1u << b;
    }
  }
  return touching;
}
constexpr std::array<uint32_t, kPlaces> kByCorner = Touching(3);
constexpr std::array<uint32_t, kPlaces> kByFace = Touching(1);

constexpr uint32_t PlacesWithin(int most_steps) {
  uint32_t places = 0;
  for (int place = 0; place < kPlaces; ++place) {
    if (place != kMiddle && StepsOf(place) <= most_steps) places |= 1u << place;
  }
  return places;
}

// Components of `places` that hold one of `seeds`.
int CountComponents(uint32_t places, uint32_t seeds,
                    const std::array<uint32_t, kPlaces>& touching) {
  int count = 0;
  for (uint32_t left = places; (left & seeds) != 0; ++count) {
    uint32_t front = 1u << std::countr_zero(left & seeds);
    left &= ~front;
    while (front != 0) {
      const auto place = static_cast<size_t>(std::countr_zero(front));
      front &= front - 1;
      front |= touching[place] & left;
      left &= ~touching[place];
    }
  }
  return count;
}

bool IsSimple(const VoxelMask& mask, Voxel v) {
  uint32_t object = 0;
  for (int place = 0; place < kPlaces; ++place) {
    const Voxel o = OffsetOf(place);
    if (place != kMiddle && mask.Holds({v[0] + o[0], v[1] + o[1], v[2] + o[2]})) {
      object |= 1u << place;
    }
  }
  constexpr uint32_t kAll = PlacesWithin(3), kNear = PlacesWithin(2), kFaces = PlacesWithin(1);
  return CountComponents(object, kAll, kByCorner) == 1 &&
         CountComponents(kNear & ~object, kFaces, kByFace) == 1;
}

std::vector<Voxel> BoundaryOf(const VoxelMask& mask) {
  std::vector<Voxel> boundary;
  mask.ForEachVoxel([&](Voxel v) {
    const size_t before = boundary.size();
    for (size_t axis = 0; axis < 3; ++axis) {
      for (const int way : {-1, 1}) {
        Voxel w = v;
        w[axis] += way;
        if (mask.IsInside(w) && !mask.Holds(w)) boundary.push_back(w);
      }
    }
    if (boundary.size() > before) boundary.push_back(v);
  });
  std::ranges::sort(boundary);
  boundary.erase(std::unique(boundary.begin(), boundary.end()), boundary.end());
  return boundary;
}

}  // namespace

uint64_t VoxelMask::Count() const {
  uint64_t count = 0;
  for (const uint64_t word : words_) count += static_cast<uint64_t>(std::popcount(word));
  return count;
}

absl::StatusOr<MaskObject> Convert(VoxelMask& mask, const SkeletonizeOptions& options) {
  const MaskOptions conversion;
  BCCSKEL_ASSIGN_OR_RETURN(MaskConverter converter, MaskConverter::Create(mask.grid(), conversion));
  for (int32_t z = 0; z < mask.grid().nz; ++z) {
    BCCSKEL_RETURN_IF_ERROR(converter.AddSlice(mask.Slice(z), exec::Context()));
  }
  BCCSKEL_ASSIGN_OR_RETURN(ConvertedMask converted, std::move(converter).Finish());
  return MaskObject{std::move(converted.volume), ForMask(options, mask.grid(), conversion)};
}

VoxelMask WithTopologyKeepingNoise(VoxelMask mask, double fraction, uint64_t seed) {
  std::vector<Voxel> boundary = BoundaryOf(mask);
  std::mt19937_64 random(seed);
  std::ranges::shuffle(boundary, random);
  boundary.resize(static_cast<size_t>(fraction * static_cast<double>(boundary.size())));
  for (const Voxel& v : boundary) {
    if (IsSimple(mask, v)) mask.Flip(v);
  }
  return mask;
}

}  // namespace bccskel::quality
