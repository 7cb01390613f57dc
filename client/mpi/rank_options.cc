#include "client/mpi/rank_options.h"

#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

namespace bccskel::cli {
namespace {

class Words {
 public:
  explicit Words(std::vector<char*>& words) : words_(words) {}

  bool TakeFlag(std::string_view name) {
    return std::erase_if(words_, [&](const char* word) { return word == name; }) > 0;
  }

  // `--name VALUE` and `--name=VALUE`; none where it is not there.
  absl::StatusOr<std::optional<std::string>> TakeValue(std::string_view name) {
    for (auto word = words_.begin(); word != words_.end(); ++word) {
      std::string_view text = *word;
      if (!text.starts_with(name)) continue;
      text.remove_prefix(name.size());
      if (text.starts_with('=')) {
        words_.erase(word);
        return std::string(text.substr(1));
      }
      if (!text.empty()) continue;
      if (word + 1 == words_.end()) {
        return absl::InvalidArgumentError(std::string(name) + ": needs a value");
      }
      std::string value = *(word + 1);
      words_.erase(word, word + 2);
      return value;
    }
    return std::nullopt;
  }

 private:
  std::vector<char*>& words_;
};

absl::StatusOr<std::chrono::milliseconds> IntervalOf(const std::string& text) {
  constexpr double kMost = 1e6;
  double seconds = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error == std::errc() && end == text.data() + text.size() && seconds >= 0 &&
      seconds <= kMost) {
    return std::chrono::milliseconds(static_cast<int64_t>(seconds * 1000));
  }
  return absl::InvalidArgumentError("--checkpoint-every " + text +
                                    ": must be 0 to 1000000 seconds");
}

}  // namespace

absl::StatusOr<RankOptions> TakeRankOptions(std::vector<char*>& given) {
  Words words(given);
  RankOptions options;
  if (words.TakeFlag("--report-exchange")) options.report = ExchangeReport::kYes;
  if (words.TakeFlag("--resume")) options.resuming = ranks::Resuming::kWhereDone;
  auto every = words.TakeValue("--checkpoint-every");
  if (!every.ok()) return every.status();
  if (every->has_value()) {
    const auto interval = IntervalOf(**every);
    if (!interval.ok()) return interval.status();
    options.checkpoint_interval = *interval;
  }
  auto folder = words.TakeValue("--checkpoint");
  if (!folder.ok()) return folder.status();
  options.checkpoint_folder = std::move(*folder).value_or("");
  const bool alone = every->has_value() || options.resuming == ranks::Resuming::kWhereDone;
  if (alone && options.checkpoint_folder.empty()) {
    return absl::InvalidArgumentError("--resume and --checkpoint-every: need --checkpoint FOLDER");
  }
  return options;
}

}  // namespace bccskel::cli
