// Euler characteristic: for (26, 6) of the voxels as closed cubes, for (6, 26) of their interiors
// with the faces, edges and corners between them. Let D be a row of voxels, C the previous row in
// y, B the previous one in z, A the previous one in both, and "+" the "or" of rows for (26, 6), the
// "and" for (6, 26). Each cell of the complex is counted at one row D: faces between C and D are
// voxels of C + D, edges along x are voxels of A + B + C + D, and so on, together with the cells
// between neighbors in x. Along x, the cells minus the cells between them are the number of runs of
// the row. So
//
//   chi = sum over rows D of  runs(D) - runs(C + D) - runs(B + D) + runs(A + B + C + D).
#include "core/mask/mask_topology.h"

#include <bit>

namespace bccskel {
namespace {

Contact ObjectContact(MaskAdjacency adjacency) {
  return adjacency == MaskAdjacency::k26 ? Contact::kCorner : Contact::kFace;
}
Contact BackgroundContact(MaskAdjacency adjacency) {
  return adjacency == MaskAdjacency::k26 ? Contact::kFace : Contact::kCorner;
}

struct Union {
  static uint64_t Join(uint64_t a, uint64_t b) { return a | b; }
};
struct Intersection {
  static uint64_t Join(uint64_t a, uint64_t b) { return a & b; }
};

// The runs that begin in this word of a joined row, given this word and the one before.
int RunsBegun(uint64_t word, uint64_t before) {
  return std::popcount(word & ~(word << 1 | before >> 63));
}

template <typename Rule>
int64_t EulerOfRow(const RowTube& tube, int slice, int row) {
  const uint64_t* a = tube.Row(slice - 1, row - 1);
  const uint64_t* b = tube.Row(slice - 1, row);
  const uint64_t* c = tube.Row(slice, row - 1);
  const uint64_t* d = tube.Row(slice, row);
  uint64_t cd_before = 0, bd_before = 0, abcd_before = 0;
  int64_t sum = 0;
  for (int32_t n = 0; n < tube.word_count; ++n) {
    const uint64_t cd = Rule::Join(c[n], d[n]), bd = Rule::Join(b[n], d[n]);
    const uint64_t abcd = Rule::Join(cd, Rule::Join(a[n], b[n]));
    if ((cd | bd | abcd | d[n]) != 0) {
      sum += RunsBegun(d[n], d[n - 1]) - RunsBegun(cd, cd_before);
      sum += RunsBegun(abcd, abcd_before) - RunsBegun(bd, bd_before);
    }
    cd_before = cd;
    bd_before = bd;
    abcd_before = abcd;
  }
  return sum;
}

}  // namespace

MaskTopology::MaskTopology(const MaskGrid& grid, MaskAdjacency adjacency)
    : adjacency_(adjacency),
      object_(Phase::kObject, ObjectContact(adjacency), grid.ny),
      background_(Phase::kBackground, BackgroundContact(adjacency), grid.ny) {}

void MaskTopology::AddSlice(int32_t z, const SliceRows& rows) {
  if (z > last_z_ + 1) EndSlice();  // an empty one
  last_z_ = z;
  for (size_t n = 0; n < rows.size(); ++n) {
    object_.AddRow(rows.y(n));
    background_.AddRow(rows.y(n));
    ForEachRun(rows[n], [this](int32_t begin, int32_t end) {
      object_.AddObjectRun(begin, end);
      background_.AddObjectRun(begin, end);
      voxels_ += static_cast<uint64_t>(end - begin);
    });
    object_.EndRow();
    background_.EndRow();
  }
  EndSlice();
}

void MaskTopology::EndSlice() {
  object_.EndSlice();
  background_.EndSlice();
}

void MaskTopology::AddTube(const RowTube& tube) {
  for (int slice = 1; slice <= kBrickZ; ++slice) {
    for (int row = 1; row <= kBrickY; ++row) {
      euler_ += adjacency_ == MaskAdjacency::k26 ? EulerOfRow<Union>(tube, slice, row)
                                                 : EulerOfRow<Intersection>(tube, slice, row);
    }
  }
}

BettiNumbers MaskTopology::Finish() && {
  EndSlice();
  BettiNumbers betti{.components = object_.count(), .cavities = background_.count()};
  betti.loops = betti.components + betti.cavities - euler_;
  return betti;
}

}  // namespace bccskel
