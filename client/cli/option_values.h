#ifndef BCCSKEL_CLIENT_CLI_OPTION_VALUES_H_
#define BCCSKEL_CLIENT_CLI_OPTION_VALUES_H_

#include <CLI/CLI.hpp>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_join.h"
#include "client/cli/arguments.h"

namespace bccskel::cli {

// "a", "a or b", "a, b or c".
inline std::string OneOf(const std::vector<std::string>& words) {
  std::string text;
  for (size_t n = 0; n < words.size(); ++n) {
    text += (n == 0 ? "" : n + 1 < words.size() ? ", " : " or ") + words[n];
  }
  return text;
}

// An option whose value is one of a few words. CLI11's own error for another word shows the numbers
// of the enumeration.
template <typename Enum>
CLI::Option* AddChoice(CLI::App& command, const std::string& name, std::function<void(Enum)> use,
                       const char* description,
                       const std::vector<std::pair<std::string, Enum>>& choices) {
  std::vector<std::string> words;
  for (const auto& [word, meaning] : choices) words.push_back(word);
  const auto read = [name, use, choices, words](const std::string& given) {
    for (const auto& [word, meaning] : choices) {
      if (word == given) return use(meaning);
    }
    throw CLI::ValidationError(name + " " + given + ": must be " + OneOf(words));
  };
  return command.add_option_function<std::string>(name, read, description)
      ->option_text(absl::StrJoin(words, "|"));
}

template <typename Enum>
CLI::Option* AddChoice(CLI::App& command, const std::string& name, Enum& value,
                       const char* description,
                       const std::vector<std::pair<std::string, Enum>>& choices) {
  return AddChoice<Enum>(
      command, name, [&value](Enum chosen) { value = chosen; }, description, choices);
}

// The words of a table of core/pipeline/option_words.h as choices.
template <typename Table>
auto Choices(const Table& table) {
  using Enum = decltype(table.front().second);
  return std::vector<std::pair<std::string, Enum>>(table.begin(), table.end());
}

// Checks for a number from `low` to `high`. CLI::Range() accepts NaN.
CLI::Validator Within(double low, double high);

// Checks for a finite number above 0.
CLI::Validator Positive();

// The error of a bound that is a whole number which no double represents exactly: rounding would
// change which values it admits. Empty: no such error; the parser checks other texts.
std::string WhyInexact(const std::string& text);
// Checks that WhyInexact() is empty.
CLI::Validator Exact();

// Rewords CLI11's error for a wrong value: the value and what is allowed.
std::string InWords(const std::string& error);

// A nonnegative whole number: 850000, 850k, 1.5M, 2G, 1e6; nullopt for other texts.
std::optional<uint64_t> ParseCount(std::string_view text);

// The same, from `low` to `high`. CLI11 would read -3 as a huge number and 010 as 8.
template <std::unsigned_integral Number>
Number ReadCount(const std::string& name, const std::string& given, Number low = 0,
                 Number high = std::numeric_limits<Number>::max()) {
  const std::optional<uint64_t> number = ParseCount(given);
  if (number.has_value() && *number >= low && *number <= high) return static_cast<Number>(*number);
  throw CLI::ValidationError(name + " " + given + ": must be a whole number from " +
                             std::to_string(low) + " to " + std::to_string(high) +
                             ", such as 850000, 850k, 4M or 1e6");
}

template <std::unsigned_integral Number>
CLI::Option* AddCount(CLI::App& command, const std::string& name, std::function<void(Number)> use,
                      const char* description, Number low = 0,
                      Number high = std::numeric_limits<Number>::max()) {
  const auto read = [=](const std::string& given) { use(ReadCount(name, given, low, high)); };
  return command.add_option_function<std::string>(name, read, description)->option_text("N");
}

template <std::unsigned_integral Number>
CLI::Option* AddCount(CLI::App& command, const std::string& name, Number& value,
                      const char* description, Number low = 0,
                      Number high = std::numeric_limits<Number>::max()) {
  return AddCount<Number>(
      command, name, [&value](Number count) { value = count; }, description, low, high);
}

// An option of the command line as another language names it: {"pruning_threshold", "1"}.
struct NamedOption {
  std::string name;
  std::optional<std::string> value;  // nullopt: a flag that is set
};

enum class OptionSet { kMask, kMesh, kLabels, kFile };

// A message with the options named as here: "--fill-cavities helps" becomes "fill_cavities helps",
// "--cut-loops 2" becomes "cut_loops=2", and "the command labels" becomes "skeletonize_labels()".
std::string WithOptionNames(std::string_view message);

// The names of the set's options, in the order of --help.
std::vector<std::string> OptionNames(OptionSet set);
// Whether an option is a flag. Needs: a name in the set.
bool IsFlag(OptionSet set, const std::string& name);

// The arguments of `skeletonize` for a mask, a mesh or a file with these options, without input and
// outputs.
// Errors: INVALID_ARGUMENT for values that are wrong or contradict each other; messages use the
//         names given here. NOT_FOUND for a name that is not in the set.
absl::StatusOr<SkeletonizeArguments> ReadNamedOptions(OptionSet set,
                                                      const std::vector<NamedOption>& options);
// The same for `labels`.
absl::StatusOr<LabelsArguments> ReadLabelsOptions(const std::vector<NamedOption>& options);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_OPTION_VALUES_H_
