#include "server/durable/watch_board.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"

namespace bccskel::server {

void WatchBoard::Add(int64_t job, std::shared_ptr<Watch> watch) {
  const auto progress = progress_.find(job);
  if (progress != progress_.end()) watch->Tell(progress->second);
  std::vector<std::shared_ptr<Watch>>& watches = watches_[job];
  std::erase_if(watches, [](const auto& other) { return other->over(); });
  watches.push_back(std::move(watch));
}

void WatchBoard::Tell(int64_t job, const JobEvent& event) {
  if (std::holds_alternative<JobProgress>(event.what)) {
    progress_.insert_or_assign(job, event);
  } else {
    progress_.erase(job);
  }
  const auto found = watches_.find(job);
  if (found == watches_.end()) return;
  std::erase_if(found->second, [](const auto& watch) { return watch->over(); });
  for (const auto& watch : found->second) watch->Tell(event);
  if (event.IsCompleted() || found->second.empty()) watches_.erase(found);
}

std::optional<JobProgress> WatchBoard::ProgressOf(int64_t job) const {
  const auto found = progress_.find(job);
  if (found == progress_.end()) return std::nullopt;
  return std::get<JobProgress>(found->second.what);
}

void WatchBoard::End(int64_t job, const absl::Status& status) {
  const auto found = watches_.find(job);
  if (found == watches_.end()) return;
  for (const auto& watch : found->second) watch->End(status);
  watches_.erase(found);
}

void WatchBoard::EndAll(const absl::Status& status) {
  for (const auto& [job, watches] : watches_) {
    for (const auto& watch : watches) watch->End(status);
  }
  watches_.clear();
}

JobEvent EventOf(const EventRow& row) {
  return {.sequence = row.sequence,
          .time = row.time,
          .what = JobEvent::StateChange{
              .state = row.state, .attempt = row.attempt, .error = row.error}};
}

std::string BytesOf(const JobProgress& progress) {
  const exec::ShellProgress& shell = progress.shell;
  return absl::StrCat(shell.shell, " ", shell.last_shell, " ", shell.points, " ", shell.removed,
                      " ", shell.remaining, " ", progress.elapsed.count());
}

std::optional<JobProgress> ProgressOfBytes(const std::string& bytes) {
  const std::vector<std::string> parts = absl::StrSplit(bytes, ' ');
  JobProgress progress;
  exec::ShellProgress& shell = progress.shell;
  int64_t elapsed = 0;
  if (parts.size() != 6 || !absl::SimpleAtoi(parts[0], &shell.shell) ||
      !absl::SimpleAtoi(parts[1], &shell.last_shell) ||
      !absl::SimpleAtoi(parts[2], &shell.points) || !absl::SimpleAtoi(parts[3], &shell.removed) ||
      !absl::SimpleAtoi(parts[4], &shell.remaining) || !absl::SimpleAtoi(parts[5], &elapsed)) {
    return std::nullopt;
  }
  progress.elapsed = std::chrono::nanoseconds(elapsed);
  return progress;
}

}  // namespace bccskel::server
