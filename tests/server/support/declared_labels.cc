#include "tests/server/support/declared_labels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <span>
#include <stdexcept>
#include <utility>

#include "core/digest/sha256.h"
#include "proto/wire/labels.h"
#include "proto/wire/placement.h"

namespace bccskel::test {
namespace {

template <typename LabelAt>
LabelImage ImageOf(int32_t nx, int32_t ny, int32_t nz, LabelAt label_at) {
  LabelImage image;
  image.grid = {.nx = nx, .ny = ny, .nz = nz};
  for (int32_t z = 0; z < nz; ++z) {
    for (int32_t y = 0; y < ny; ++y) {
      for (int32_t x = 0; x < nx; ++x) image.labels.push_back(label_at(x, y, z));
    }
  }
  return image;
}

bool IsInBox(int32_t x, int32_t y, int32_t z, int32_t low, int32_t high) {
  return std::min({x, y, z}) >= low && std::max({x, y, z}) <= high;
}

uint64_t FiveLabelsAt(int32_t x, int32_t y, int32_t z) {
  const double ring = std::hypot(x - 15.0, y - 15.0) - 10;
  if (std::hypot(ring, z - 5.0) <= 3) return kRing;
  if (y >= 13 && y <= 17 && z >= 3 && z <= 7 && x < 40) return kBar;  // through the ring, touching
  if (IsInBox(x - 30, y - 20, z, 0, 9)) return IsInBox(x - 30, y - 20, z, 3, 6) ? 0 : kHollow;
  if (IsInBox(x - 2, y - 2, z - 11, 0, 3)) return kBlob;
  return x == 44 && y == 0 && z == 15 ? kDot : 0;
}

// The numbers that numpy would find.
void Promise(const LabelImage& image, v1::LabelVolumeDeclaration& volume) {
  std::map<uint64_t, uint64_t> voxels;
  uint64_t runs = 0, last = 0, all = 0, largest = 0;
  for (size_t n = 0; n < image.labels.size(); ++n) {
    const uint64_t label = image.labels[n];
    const bool row_begins = n % static_cast<size_t>(image.grid.nx) == 0;
    if (label != 0 && (row_begins || label != last)) ++runs;
    if (label != 0) largest = std::max(largest, ++voxels[label]), ++all;
    last = label;
  }
  volume.set_max_voxels(all);
  volume.set_max_label_voxels(largest);
  volume.set_max_runs(runs);
  volume.set_max_labels(voxels.size());
}

}  // namespace

const LabelImage& FiveLabels() {
  static const LabelImage image = ImageOf(45, 31, 16, FiveLabelsAt);
  return image;
}

LabelImage ManyNets(int32_t count) {
  return ImageOf(65, 65, count, [](int32_t x, int32_t y, int32_t z) {
    return static_cast<uint64_t>(x % 2 == 0 || y % 2 == 0 ? z + 1 : 0);
  });
}

DeclaredLabels Declare(const LabelImage& image, int label_bytes) {
  DeclaredLabels declared;
  const auto size = static_cast<size_t>(label_bytes);
  declared.bytes.resize(image.labels.size() * size);
  for (size_t n = 0; n < image.labels.size(); ++n) {  // little-endian
    std::memcpy(declared.bytes.data() + n * size, &image.labels[n], size);
  }
  v1::LabelVolumeDeclaration& volume = *declared.config.mutable_volume();
  volume.set_type(wire::LabelTypeOf(label_bytes));
  *volume.mutable_extent() =
      wire::ToMessage(LatticeExtent{.nx = image.grid.nx, .ny = image.grid.ny, .nz = image.grid.nz});
  *volume.mutable_placement() = wire::ToMessage(image.grid.placement);
  volume.set_size_bytes(declared.bytes.size());
  Promise(image, volume);
  return declared;
}

v1::SkeletonizeLabelsRequest LabelsChunk(size_t offset, const std::string& data) {
  v1::SkeletonizeLabelsRequest request;
  request.mutable_chunk()->set_offset(offset);
  request.mutable_chunk()->set_data(data);
  return request;
}

v1::SkeletonizeLabelsRequest LabelsFinish(const DeclaredLabels& labels) {
  const Sha256Digest digest = Sha256Of(labels.bytes);
  v1::SkeletonizeLabelsRequest request;
  request.mutable_finish()->set_size_bytes(labels.bytes.size());
  request.mutable_finish()->set_sha256(digest.bytes.data(), digest.bytes.size());
  return request;
}

std::vector<v1::SkeletonizeLabelsRequest> RequestsFor(const DeclaredLabels& labels,
                                                      size_t chunk_bytes) {
  std::vector<v1::SkeletonizeLabelsRequest> requests(1);
  *requests[0].mutable_config() = labels.config;
  for (size_t offset = 0; offset < labels.bytes.size(); offset += chunk_bytes) {
    requests.push_back(LabelsChunk(offset, labels.bytes.substr(offset, chunk_bytes)));
  }
  requests.push_back(LabelsFinish(labels));
  return requests;
}

std::vector<LabelSkeleton> SkeletonsOf(const LabelImage& image, const LabelFilter& filter,
                                       const LabelsOptions& options) {
  const auto check = [](const absl::Status& status) {
    if (!status.ok()) throw std::runtime_error(status.ToString());
  };
  LabelCollector collector = *LabelCollector::Create(image.grid, filter);
  const size_t slice = image.grid.VoxelsPerSlice();
  for (size_t begin = 0; begin < image.labels.size(); begin += slice) {
    check(collector.AddSlice(std::span(image.labels).subspan(begin, slice), exec::Context()));
  }
  const LabeledObjects objects = *std::move(collector).Finish();
  std::vector<LabelSkeleton> skeletons;
  check(SkeletonizeLabels(
      objects, options,
      [&](LabelSkeleton&& skeleton) {
        skeletons.push_back(std::move(skeleton));
        return absl::OkStatus();
      },
      exec::Context()));
  return skeletons;
}

}  // namespace bccskel::test
