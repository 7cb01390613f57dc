#include "core/thinning/mark_symmetric.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/exec/instruction_sets.h"
#include "core/thinning/thinning_state.h"
#include "core/topology/neighborhood.h"
#include "tests/support/reference_conditions.h"

// The logic circuits against the definitions: an object that holds every neighborhood once, the
// points so far apart that none sees another's neighbors.

namespace bccskel {
namespace {

constexpr int kApart = 8;  // lattice units

LatticePoint CenterOf(int mask, Sublattice sublattice) {
  const int odd = static_cast<int>(sublattice);
  return {kApart * (mask & 31) + 2 + odd, kApart * (mask >> 5 & 31) + 2 + odd,
          kApart * (mask >> 10) + 2 + odd};
}

Volume AllNeighborhoods(Sublattice sublattice) {
  std::vector<LatticePoint> points;
  for (int mask = 0; mask < 1 << kNeighborCount; ++mask) {
    const LatticePoint center = CenterOf(mask, sublattice);
    points.push_back(center);
    for (int n = 0; n < kNeighborCount; ++n) {
      if ((mask >> n & 1) != 0) points.push_back(center + Direction(n).offset());
    }
  }
  return VolumeOfPoints(points);
}

// Runs a kernel over all bricks of one sublattice; the result has a plane for each brick.
template <typename Kernel>
std::vector<BrickBits> Found(const ThinningState& state, Sublattice sublattice, Kernel kernel) {
  std::vector<BrickIndex> bricks;
  for (BrickIndex n = 0; n < state.brick_count(); ++n) {
    if (state.SublatticeOf(n) == sublattice) bricks.push_back(n);
  }
  std::vector<BrickBits> found(state.object.size());
  kernel(bricks, found);
  return found;
}

class Circuits : public testing::TestWithParam<Sublattice> {
 protected:
  Circuits() : volume_(AllNeighborhoods(GetParam())), state_(volume_, {}) {
    state_.candidates.assign(state_.object.begin(), state_.object.end() - 1);
  }

  std::vector<BrickBits> Simple(EndPoints end_points) const {
    return Found(state_, GetParam(), [&](auto& bricks, auto& found) {
      std::vector<MarkedBrick> ends;
      FindSimple(state_.View(), GetParam(), end_points, bricks, found.data(), ends);
    });
  }
  std::vector<BrickBits> Ends() const {
    return Found(state_, GetParam(), [&](auto& bricks, auto& found) {
      std::vector<MarkedBrick> ends;
      std::vector<BrickBits> simple(found.size());
      FindSimple(state_.View(), GetParam(), EndPoints::kStay, bricks, simple.data(), ends);
      for (const MarkedBrick& m : ends) found[m.brick] = m.marks;
    });
  }
  std::vector<BrickBits> EndsAlone() const {
    return Found(state_, GetParam(), [&](auto& bricks, auto& found) {
      std::vector<MarkedBrick> ends;
      MarkEndPoints(state_.View(), GetParam(), bricks, ends);
      for (const MarkedBrick& m : ends) found[m.brick] = m.marks;
    });
  }
  std::vector<BrickBits> Removable(DiagonalDirection d) const {
    return Found(state_, GetParam(), [&](auto& bricks, auto& found) {
      std::vector<MarkedBrick> ends, marked(bricks.size());
      marked.resize(MarkRemovable(state_.View(), GetParam(), d, bricks, marked.data(), ends));
      for (const MarkedBrick& m : marked) found[m.brick] = m.marks;
    });
  }
  std::vector<BrickBits> EndsAlong(DiagonalDirection d) const {
    return Found(state_, GetParam(), [&](auto& bricks, auto& found) {
      std::vector<MarkedBrick> ends, marked(bricks.size());
      MarkRemovable(state_.View(), GetParam(), d, bricks, marked.data(), ends);
      for (const MarkedBrick& m : ends) found[m.brick] = m.marks;
    });
  }
  std::vector<BrickBits> Isthmuses(SkeletonKind kind) const {
    return Found(state_, GetParam(), [&](auto& bricks, auto& found) {
      std::vector<MarkedBrick> marked(bricks.size());
      marked.resize(MarkIsthmuses(state_.View(), GetParam(), kind, bricks, marked.data()));
      for (const MarkedBrick& m : marked) found[m.brick] = m.marks;
    });
  }

  // Compares on every neighborhood and every instruction set.
  template <typename Find, typename Definition>
  void ExpectEverywhere(Find find, Definition definition) const {
    for (const std::string& name : exec::SupportedInstructionSets()) {
      SCOPED_TRACE(name);
      ASSERT_TRUE(exec::ChooseInstructionSet(name));
      const std::vector<BrickBits> found = find();
      for (int mask = 0; mask < 1 << kNeighborCount; ++mask) {
        const BrickAddress at = AddressOf(CenterOf(mask, GetParam()));
        ASSERT_EQ(found[*volume_.Find(BrickKey(at.brick))].Test(at.bit),
                  definition(static_cast<NeighborMask>(mask)))
            << mask;
      }
    }
    exec::ChooseInstructionSet("");
  }

 private:
  const Volume volume_;
  ThinningState state_;
};

TEST_P(Circuits, FindSimplePointsInEveryNeighborhood) {
  ExpectEverywhere([this] { return Simple(EndPoints::kMayGo); }, IsSimple);
  ExpectEverywhere([this] { return Simple(EndPoints::kStay); }, IsSimpleNonEnd);
}

TEST_P(Circuits, FindRemovablePointsInEveryNeighborhoodAndDirection) {
  for (int bit = 0; bit < 8; ++bit) {
    const DiagonalDirection d(bit);
    SCOPED_TRACE(bit);
    ExpectEverywhere([&] { return Removable(d); },
                     [d](NeighborMask mask) { return test::ReferenceIsRemovable(mask, d); });
  }
}

TEST_P(Circuits, FindEndPointsInEveryNeighborhood) {
  ExpectEverywhere([this] { return Ends(); }, IsEndPoint);
  ExpectEverywhere([this] { return EndsAlone(); }, IsEndPoint);
  for (int d = 0; d < 8; ++d) {
    ExpectEverywhere([&] { return EndsAlong(DiagonalDirection(d)); }, IsEndPoint);
  }
}

TEST_P(Circuits, FindIsthmusesInEveryNeighborhood) {
  ExpectEverywhere([this] { return Isthmuses(SkeletonKind::kSurface); },
                   test::ReferenceIsTwoIsthmus);
  ExpectEverywhere([this] { return Isthmuses(SkeletonKind::kIsthmusCurve); },
                   test::ReferenceIsOneIsthmus);
}

INSTANTIATE_TEST_SUITE_P(Sublattices, Circuits, testing::ValuesIn(kSublattices));

}  // namespace
}  // namespace bccskel
