#ifndef BCCSKEL_CORE_THINNING_SHELL_OPENER_H_
#define BCCSKEL_CORE_THINNING_SHELL_OPENER_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/exec/uninitialized.h"
#include "core/exec/worker_team.h"
#include "core/shells/shells.h"
#include "core/thinning/open_shell.h"
#include "core/volume/brick.h"

namespace bccskel {

// Opens shells one after the other in some bricks: the points of a shell become candidates
// (Condition 5).
class ShellOpener {
 public:
  // `from` is the first shell to open, the first one of all or a multiple of kShellsAtOnce.
  // Needs: `shells` outlive this.
  void Begin(const Shells& shells, exec::Share bricks, int32_t from = 1);

  // Returns: the number of points of the shell. Needs: shells are opened in order.
  uint64_t Open(const OpeningView& view, int32_t shell);

  // Takes over the bricks of another opener.
  void TakeOver(ShellOpener& other);

 private:
  void SortByFirstShell();
  void CutFrom(int32_t first);
  void ClearOtherShells();

  const Shells* shells_ = nullptr;
  std::vector<BrickIndex> by_first_shell_;  // in the order in which shells reach them
  size_t reached_ = 0;                      // number of those reached so far
  // Shells are extracted kShellsAtOnce at a time: the first of the current group, the bricks with
  // points in the group, and the points in the layout of CutShells().
  static constexpr int32_t kNone = -1;
  int32_t cut_from_ = kNone;
  std::vector<BrickIndex> opening_;
  exec::UninitializedVector<BrickBits> points_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_SHELL_OPENER_H_
