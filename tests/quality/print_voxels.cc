#include <cmath>
#include <cstdio>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "tests/quality/known_figure.h"
#include "tests/quality/studies.h"
#include "tests/support/even_points.h"

namespace bccskel::quality {
namespace {

using shapes::RoundCone;
using shapes::Vector;

// In voxels: half as many as lattice units.
std::string InVoxels(const PlacedFigure& placed, const std::vector<RoundCone>& pieces) {
  std::string text;
  for (const RoundCone& piece : pieces) {
    const Vector a = 0.5 * placed.ToLattice(piece.from), b = 0.5 * placed.ToLattice(piece.to);
    absl::StrAppendFormat(&text, "%s[%.4f, %.4f, %.4f, %.4f, %.4f, %.4f, %.4f, %.4f]",
                          text.empty() ? "" : ", ", a.x, a.y, a.z, b.x, b.y, b.z,
                          placed.scale * piece.from_radius / 2, placed.scale * piece.to_radius / 2);
  }
  return text;
}

absl::Status PrintOne(const PlacedFigure& placed, int turn) {
  const test::Voxels voxels = test::EvenPoints(placed.object);
  const LatticeExtent& extent = placed.object.extent();
  absl::PrintF(
      "{\"figure\": \"%s\", \"turn\": %d, \"shape\": [%d, %d, %d], \"voxels\": %d, \"forks\": %d, "
      "\"loops\": %d, \"line\": [%s], \"tips\": [%s]}\n",
      placed.figure.name, turn, extent.nz, extent.ny, extent.nx, voxels.count, placed.figure.forks,
      placed.figure.loops, InVoxels(placed, placed.figure.line),
      InVoxels(placed, placed.figure.tips));
  const size_t written = std::fwrite(voxels.bits.data(), 1, voxels.bits.size(), stdout);
  if (written != voxels.bits.size()) return absl::DataLossError("the voxels could not be written");
  return absl::OkStatus();
}

}  // namespace

absl::Status PrintVoxels(const StudyOptions& size) {
  for (KnownFigure figure : KnownFigures()) {
    // Twice the lattice points, so as many voxels; a bar of its own scale has cells of 1.6 units.
    figure.scale *= std::cbrt(2.0);
    const int turns = figure.turns ? size.turns : 1;
    for (int turn = 0; turn < turns; ++turn) {
      const Frame frame = figure.turns ? RandomFrame(static_cast<uint64_t>(turn)) : Frame();
      BCCSKEL_ASSIGN_OR_RETURN(const PlacedFigure placed,
                               Place(Turned(figure, frame), 2 * size.points.front()));
      BCCSKEL_RETURN_IF_ERROR(PrintOne(placed, turn));
    }
  }
  return absl::OkStatus();
}

}  // namespace bccskel::quality
