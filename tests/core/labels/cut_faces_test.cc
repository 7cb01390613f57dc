// Which faces of an image cut limbs off, and what follows.
#include "core/pruning/cut_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "core/exec/memory_budget.h"
#include "core/labels/convert_label.h"
#include "tests/core/labels/voxel_figure.h"

namespace bccskel {
namespace {

using test::ConversionOf, test::SkeletonOf, test::Voxel;

constexpr MaskGrid kCube = {.nx = 60, .ny = 60, .nz = 60};

template <typename IsIn>
ImageFaces FacesOf(const MaskGrid& grid, const MaskOptions& mask, const IsIn& is_in) {
  const Volume object = ConversionOf(grid, mask, is_in);
  const int32_t cells = CellsPerVoxel(ForMask({}, grid, mask).source);
  const LatticeBox image = WindowOf(object.extent(), BorderPoints::kLastCorners, kAllFaces);
  exec::UnlimitedMemory memory;
  const auto faces = FacesThatCutLimbs(object, image, cells, memory, {});
  EXPECT_TRUE(faces.ok()) << faces.status();
  return faces.value_or(kNoFaces);
}

ImageFaces Only(size_t axis, size_t side) {
  ImageFaces faces = kNoFaces;
  faces[axis][side] = true;
  return faces;
}

// The middle of a voxel in a coordinate system that begins at the middle of a face: along the
// normal, into the image, and across.
std::array<double, 3> FromFace(const MaskGrid& grid, size_t axis, size_t side, const Voxel& at) {
  const std::array<int32_t, 3> voxels = {grid.nx, grid.ny, grid.nz};
  const auto& spacing = grid.placement.spacing;
  const auto place = [&](size_t a) { return (at[a] + 0.5) * spacing[a]; };
  const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double in = side == 0 ? place(axis) : voxels[axis] * spacing[axis] - place(axis);
  return {in, place(u) - voxels[u] * spacing[u] / 2, place(v) - voxels[v] * spacing[v] / 2};
}

// With a round end within the image.
bool IsInRod(const std::array<double, 3>& p, double slant, double radius) {
  const double along = p[0] * std::cos(slant) + p[1] * std::sin(slant);
  const double beyond = std::max(along - 22, 0.0);
  return std::hypot(p[1] * std::cos(slant) - p[0] * std::sin(slant), p[2], beyond) <= radius;
}

TEST(CutFaces, AreThoseThatCutALimbOff) {
  for (const double degrees : {0.0, 30.0, 50.0}) {
    for (const double radius : {2.0, 4.0, 9.0}) {
      for (size_t face = 0; face < 6; ++face) {
        const size_t axis = face / 2, side = face % 2;
        const auto is_in = [&](const Voxel& at) {
          const double slant = degrees * std::numbers::pi / 180;
          return IsInRod(FromFace(kCube, axis, side, at), slant, radius);
        };
        EXPECT_EQ(FacesOf(kCube, {}, is_in), Only(axis, side)) << degrees << ' ' << radius;
      }
    }
  }
}

TEST(CutFaces, AreFoundInBothConversionsAndForVoxelsThatAreNoCubes) {
  constexpr MaskOptions kFine = {.points = VoxelPoints::kSixteen};
  for (size_t axis = 0; axis < 3; ++axis) {
    for (size_t face = 0; face < 6; ++face) {
      MaskGrid grid = {.nx = 60, .ny = 64, .nz = 68};
      grid.placement.spacing[axis] = 1.7;
      for (const MaskOptions& mask : {MaskOptions(), kFine}) {
        const auto is_in = [&](const Voxel& at) {
          return IsInRod(FromFace(grid, face / 2, face % 2, at), 0.4, 6);
        };
        EXPECT_EQ(FacesOf(grid, mask, is_in), Only(face / 2, face % 2)) << axis << ' ' << face;
      }
    }
  }
}

// As in an image that was cropped to its object.
TEST(CutFaces, AreNotThoseThatAreOnlyTouched) {
  for (const double radius : {5.0, 8.0, 14.0, 26.0}) {
    for (const double beyond : {0.1, 0.5, 0.9}) {
      for (size_t face = 0; face < 6; ++face) {
        const auto from_face = [&](const Voxel& at) {
          return FromFace(kCube, face / 2, face % 2, at);
        };
        EXPECT_EQ(FacesOf(kCube, {},
                          [&](const Voxel& at) {
                            const auto [in, u, v] = from_face(at);
                            return std::hypot(in + beyond - radius, u, v) <= radius;
                          }),
                  kNoFaces)
            << "ball " << radius << ' ' << beyond;
        EXPECT_EQ(FacesOf(kCube, {},
                          [&](const Voxel& at) {  // a limb along the face
                            const auto [in, u, v] = from_face(at);
                            const double past = std::max(std::abs(u) - 28 + radius, 0.0);
                            return std::hypot(in + beyond - radius, past, v) <= radius;
                          }),
                  kNoFaces)
            << "limb " << radius << ' ' << beyond;
      }
    }
  }
}

TEST(CutFaces, AreNotThoseAlongWallsAndFlatLimbs) {
  const auto faces_of = [](const auto& is_in) {
    return FacesOf(kCube, {}, [&](const Voxel& at) { return is_in(FromFace(kCube, 2, 0, at)); });
  };
  EXPECT_EQ(faces_of([](const auto& p) { return p[0] < 40 && std::abs(p[1]) < 5; }), kNoFaces);
  EXPECT_EQ(faces_of([](const auto& p) {  // half of a limb, cut along its axis
              return std::hypot(p[0], p[2]) < 10 && std::abs(p[1]) < 25;
            }),
            kNoFaces);
  EXPECT_EQ(faces_of([](const auto& p) { return std::hypot(p[0], p[1], p[2]) < 25; }), kNoFaces);
}

// The larger part of what lies on a face decides.
TEST(CutFaces, AreThoseOfMostOfTheirVoxels) {
  for (const double length : {4.0, 25.0}) {  // half that of a limb along the face
    const ImageFaces faces = FacesOf(kCube, {}, [&](const Voxel& at) {
      const auto p = FromFace(kCube, 1, 1, at);
      return (p[0] < 30 && std::hypot(p[1] - 15, p[2] - 15) < 6) ||
             (std::hypot(p[0] - 2, p[2] + 10) < 4 && std::abs(p[1]) < length);
    });
    EXPECT_EQ(faces, length < 20 ? Only(1, 1) : kNoFaces) << length;
  }
}

// Allows so much at once.
class Allowance final : public exec::MemoryBudget {
 public:
  explicit Allowance(uint64_t most) : most_(most) {}
  absl::Status Take(uint64_t bytes, const std::string& what_for) override {
    if (taken_ + bytes > most_) return absl::ResourceExhaustedError(what_for);
    taken_ += bytes;
    return absl::OkStatus();
  }
  void GiveBack(uint64_t bytes) override { taken_ -= bytes; }
  uint64_t taken() const { return taken_; }

 private:
  const uint64_t most_;
  uint64_t taken_ = 0;
};

// A pixel of the grid, and a voxel in two lists, of the largest face.
TEST(CutFaces, TakeTheirMemoryFromTheBudgetAndGiveItBack) {
  constexpr uint64_t kVoxels = 60 * 60, kPixels = 62 * 62;
  const Volume object = ConversionOf(kCube, {}, [](const Voxel& at) { return at[0] != 30; });
  const LatticeBox image = WindowOf(object.extent(), BorderPoints::kLastCorners, kAllFaces);
  Allowance enough(16 * kVoxels + kPixels), small(16 * kVoxels - 1), smaller(kPixels);
  EXPECT_TRUE(FacesThatCutLimbs(object, image, 1, enough, {}).ok());
  EXPECT_EQ(enough.taken(), 0u);
  for (Allowance* memory : {&small, &smaller}) {
    const auto faces = FacesThatCutLimbs(object, image, 1, *memory, {});
    EXPECT_EQ(faces.status().code(), absl::StatusCode::kResourceExhausted);
    EXPECT_EQ(memory->taken(), 0u);
  }
}

// A limb with others across it, just before the border.
SkeletonizeResult CrossNearTheBorder(Border border) {
  const SkeletonizeOptions options = {.border = border};
  return SkeletonOf({.nx = 80, .ny = 80, .nz = 40}, options, {}, [](const Voxel& at) {
    const double x = at[0] + 0.5, y = at[1] + 0.5, z = at[2] + 0.5 - 20;
    const auto nearest = [](double v) { return std::min({std::abs(v - 12), std::abs(v - 68)}); };
    return std::hypot(nearest(y), z) <= 6 || std::hypot(nearest(x), z) <= 6;
  });
}

TEST(CutFaces, LeadCurvesToTheBorderWhereLittleOfALimbIsInTheImage) {
  const SkeletonizeResult result = CrossNearTheBorder(Border::kAuto);
  EXPECT_TRUE(result.certificate.TopologyKept());
  EXPECT_EQ(result.options.border, Border::kAuto);
  std::vector<WorldPoint> ends;
  for (const SkeletonNode& node : result.graph.nodes) {
    if (node.kind == NodeKind::kEnd) ends.push_back(result.graph.PositionOf(node.at));
  }
  ASSERT_EQ(ends.size(), 8u);
  for (const WorldPoint& end : ends) {
    const double out = std::max(std::abs(end[0] - 39.5), std::abs(end[1] - 39.5));
    const double beside = std::min(std::abs(end[0] - 39.5), std::abs(end[1] - 39.5));
    EXPECT_GE(out, 39);
    EXPECT_NEAR(beside, 28, 1.5);
    EXPECT_NEAR(end[2], 19.5, 1.5);
  }
  EXPECT_EQ(result.sha256, CrossNearTheBorder(Border::kContinues).sha256);
}

TEST(CutFaces, ChangeNothingIfThereAreNone) {
  const auto ball = [](Border border) {
    return SkeletonOf(kCube, {.border = border}, {}, [](const Voxel& at) {
      const std::array<double, 3> p = FromFace(kCube, 0, 0, at);
      return std::hypot(p[0] - 8, p[1], p[2]) <= 8.4 ||
             (p[0] > 8 && IsInRod({p[0] - 8, p[1], p[2]}, 0.9, 3));
    });
  };
  const SkeletonizeResult result = ball(Border::kAuto);
  EXPECT_EQ(result.options.border, Border::kEnds);
  EXPECT_EQ(result.sha256, ball(Border::kEnds).sha256);
}

}  // namespace
}  // namespace bccskel
