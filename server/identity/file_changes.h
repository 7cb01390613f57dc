#ifndef BCCSKEL_SERVER_IDENTITY_FILE_CHANGES_H_
#define BCCSKEL_SERVER_IDENTITY_FILE_CHANGES_H_

#include <sys/stat.h>

#include <string>
#include <utility>
#include <vector>

namespace bccskel::server {

enum class Reload { kNotNeeded, kDone };

// Notices when files change.
// Threads: one at a time.
class FileChanges {
 public:
  explicit FileChanges(std::vector<std::string> paths)
      : paths_(std::move(paths)), seen_(paths_.size()) {}

  // Whether a file has changed, appeared or gone since the last call. Call it before a read, so
  // that the next call sees a change during the read.
  bool Look() {
    bool changed = false;
    for (size_t n = 0; n < paths_.size(); ++n) {
      struct stat now = {};
      if (stat(paths_[n].c_str(), &now) != 0) now = {};
      changed = changed || !Same(now, seen_[n]);
      seen_[n] = now;
    }
    return changed;
  }

 private:
  static bool Same(const struct stat& a, const struct stat& b) {
    return a.st_dev == b.st_dev && a.st_ino == b.st_ino && a.st_size == b.st_size &&
           a.st_mtim.tv_sec == b.st_mtim.tv_sec && a.st_mtim.tv_nsec == b.st_mtim.tv_nsec;
  }

  const std::vector<std::string> paths_;
  std::vector<struct stat> seen_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_IDENTITY_FILE_CHANGES_H_
