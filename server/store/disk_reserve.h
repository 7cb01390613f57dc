#ifndef BCCSKEL_SERVER_STORE_DISK_RESERVE_H_
#define BCCSKEL_SERVER_STORE_DISK_RESERVE_H_

#include <string>
#include <utility>

namespace bccskel::server {

// Space that is held back on a disk, so that what makes room there, or ends a job, can be written
// when nothing else can.
// Threads: one at a time.
class DiskReserve {
 public:
  // Holds nothing yet, and gives free what a process before this one held.
  explicit DiskReserve(std::string path) : path_(std::move(path)) { Release(); }

  // Takes the space; later, where there is too little now.
  void Hold();
  // Gives it to whoever writes next.
  void Release();
  bool held() const { return held_; }

 private:
  const std::string path_;
  bool held_ = false;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_DISK_RESERVE_H_
