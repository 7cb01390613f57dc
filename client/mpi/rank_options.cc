#include "client/mpi/rank_options.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "core/exec/status_macros.h"

namespace bccskel::cli {
namespace {

class Words {
 public:
  explicit Words(std::vector<char*>& words) : words_(words) {}

  bool TakeFlag(std::string_view name) {
    return std::erase_if(words_, [&](const char* word) { return word == name; }) > 0;
  }

  // `--name VALUE` and `--name=VALUE`; nullopt if it is absent.
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

template <typename Number>
absl::Status TakeNumber(Words& words, std::string_view name, Number& number) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::optional<std::string> text, words.TakeValue(name));
  if (!text.has_value()) return absl::OkStatus();
  const char* const end = text->data() + text->size();
  const auto [at, error] = std::from_chars(text->data(), end, number);
  if (error == std::errc() && at == end) return absl::OkStatus();
  return absl::InvalidArgumentError(std::string(name) + " " + *text + ": not a number");
}

// The name of the shape takes the place of the input.
absl::Status TakeShape(Words& words, std::vector<char*>& given, RankOptions& options) {
  const auto is_option = [](std::string_view word) { return word == "--generate"; };
  const auto option = std::ranges::find_if(given, is_option);
  if (option == given.end()) return absl::OkStatus();
  if (option + 1 == given.end()) return absl::InvalidArgumentError("--generate: needs a shape");
  BCCSKEL_ASSIGN_OR_RETURN(options.shape, ParseShapeName(*(option + 1)));
  if (const std::string_view first = given.size() > 2 ? given[2] : "-"; !first.starts_with('-')) {
    return absl::InvalidArgumentError("--generate SHAPE takes the place of INPUT: omit " +
                                      std::string(first));
  }
  given.erase(option);
  BCCSKEL_RETURN_IF_ERROR(TakeNumber(words, "--seed", options.shape_options.seed));
  return TakeNumber(words, "--noise", options.shape_options.noise);
}

}  // namespace

absl::StatusOr<RankOptions> TakeRankOptions(std::vector<char*>& given) {
  Words words(given);
  RankOptions options;
  if (words.TakeFlag("--report-exchange")) options.report = ExchangeReport::kYes;
  if (words.TakeFlag("--resume")) options.resuming = ranks::Resuming::kWhereDone;
  BCCSKEL_RETURN_IF_ERROR(TakeShape(words, given, options));
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
