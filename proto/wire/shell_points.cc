#include "proto/wire/shell_points.h"

#include "absl/strings/str_cat.h"

namespace bccskel::wire {
namespace {

bool OnSomeLattice(int64_t coordinate) {
  return coordinate >= 0 && coordinate < 2 * int64_t{kMaxExtentCells};
}

}  // namespace

std::vector<v1::ShellPoints> ShellPointsMessages(int32_t shell, const Volume& points) {
  std::vector<v1::ShellPoints> messages;
  LatticePoint before;
  points.ForEachPoint([&](LatticePoint p) {
    if (messages.empty() || messages.back().dx_size() == int{kMaxShellPointRows}) {
      messages.emplace_back().set_shell(shell);
      before = {};
    }
    v1::ShellPoints& message = messages.back();
    message.add_dx(p.x - before.x);
    message.add_dy(p.y - before.y);
    message.add_dz(p.z - before.z);
    before = p;
  });
  return messages;
}

absl::StatusOr<std::vector<LatticePoint>> PointsOf(const v1::ShellPoints& message) {
  if (message.dy_size() != message.dx_size() || message.dz_size() != message.dx_size()) {
    return absl::DataLossError(absl::StrCat("points of a shell have columns of ", message.dx_size(),
                                            ", ", message.dy_size(), " and ", message.dz_size(),
                                            " rows"));
  }
  std::vector<LatticePoint> points;
  int64_t x = 0, y = 0, z = 0;
  for (int row = 0; row < message.dx_size(); ++row) {
    x += message.dx(row);
    y += message.dy(row);
    z += message.dz(row);
    if (!OnSomeLattice(x) || !OnSomeLattice(y) || !OnSomeLattice(z)) {
      return absl::DataLossError(
          absl::StrCat("a point of a shell at ", x, ", ", y, ", ", z, " lies on no lattice"));
    }
    points.push_back({static_cast<int32_t>(x), static_cast<int32_t>(y), static_cast<int32_t>(z)});
  }
  return points;
}

}  // namespace bccskel::wire
