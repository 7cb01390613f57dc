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

// Opens one shell after the other in some bricks: its points become candidates (Condition 5).
class ShellOpener {
 public:
  // Needs: `shells` outlive this.
  void Begin(const Shells& shells, exec::Share bricks);

  // Returns: how many points the shell has. Needs: shells come in their order, from 1 on.
  uint64_t Open(const OpeningView& view, int32_t shell);

  // From now on the other's bricks are opened here, too.
  void TakeOver(ShellOpener& other);

 private:
  void SortByFirstShell();
  void CutFrom(int32_t first);
  void ClearOtherShells();

  const Shells* shells_ = nullptr;
  std::vector<BrickIndex> by_first_shell_;  // in the order in which shells reach them
  size_t reached_ = 0;                      // how many of them have been reached
  // Shells are cut kShellsAtOnce at a time: the first of those, the bricks with points in them, and
  // the points as CutShells() has them.
  static constexpr int32_t kNone = -1;
  int32_t cut_from_ = kNone;
  std::vector<BrickIndex> opening_;
  exec::UninitializedVector<BrickBits> points_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_SHELL_OPENER_H_
