#ifndef BCCSKEL_SERVER_DURABLE_FLEET_MEMBERS_H_
#define BCCSKEL_SERVER_DURABLE_FLEET_MEMBERS_H_

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "server/store/rows.h"

namespace bccskel::server {

// Detects which other servers of the fleet are gone, by this process's clock alone: those from
// which it saw no heartbeat although it looked all the time.
// Threads: one at a time.
class FleetMembers {
 public:
  using Clock = std::chrono::steady_clock;
  explicit FleetMembers(std::chrono::milliseconds lease) : lease_(lease) {}

  // The members without a heartbeat for the length of the lease.
  std::vector<Member> Look(const std::vector<Member>& members, const std::string& self,
                           Clock::time_point now) {
    if (now - last_look_ > kLongestGap) seen_.clear();
    last_look_ = now;
    std::map<std::string, Sign> seen;
    std::vector<Member> gone;
    for (const Member& member : members) {
      if (member.server == self) continue;
      const auto before = seen_.find(member.server);
      const bool silent = before != seen_.end() && before->second.beats == member.beats;
      const Clock::time_point since = silent ? before->second.since : now;
      seen[member.server] = {.beats = member.beats, .since = since};
      if (now - since >= lease_) gone.push_back(member);
    }
    seen_ = std::move(seen);
    return gone;
  }
  // Whether the last look saw this server.
  bool Has(const std::string& server) const { return seen_.contains(server); }
  void Forget() { seen_.clear(); }

 private:
  // After a longer pause, heartbeats may have been missed: start over.
  static constexpr std::chrono::milliseconds kLongestGap{2500};
  struct Sign {
    int64_t beats = 0;        // the last count seen
    Clock::time_point since;  // when it was first seen
  };

  const std::chrono::milliseconds lease_;
  std::map<std::string, Sign> seen_;
  Clock::time_point last_look_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_FLEET_MEMBERS_H_
