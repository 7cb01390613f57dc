#include "client/cli/option_values.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "client/cli/image_options.h"
#include "client/cli/thinning_options.h"

namespace bccskel::cli {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// Moves the digits at the front of the text to the end of `digits`.
void TakeDigits(std::string_view& text, std::string& digits) {
  const auto end = std::ranges::find_if_not(text, IsDigit);
  const auto count = static_cast<size_t>(end - text.begin());
  digits += text.substr(0, count);
  text.remove_prefix(count);
}

// Parses "k", "M", "G" or "e6" as a number of zeros.
std::optional<int> TakeZeros(std::string_view& text) {
  if (text.empty()) return 0;
  const char letter = text.front();
  text.remove_prefix(1);
  if (letter == 'k' || letter == 'K') return 3;
  if (letter == 'M') return 6;
  if (letter == 'G') return 9;
  if (letter != 'e' && letter != 'E') return std::nullopt;
  if (text.starts_with('+')) text.remove_prefix(1);
  std::string exponent;
  TakeDigits(text, exponent);
  if (exponent.empty() || exponent.size() > 2) return std::nullopt;
  return std::stoi(exponent);
}

}  // namespace

CLI::Validator Within(double low, double high) {
  const auto check = [low, high](const std::string& text) -> std::string {
    double value = 0;
    if (absl::SimpleAtod(text, &value) && value >= low && value <= high) return "";
    const bool open = high == std::numeric_limits<double>::max();
    return absl::StrFormat("must be %.8g ", low) +
           (open ? "or more, and finite" : absl::StrFormat("to %.8g", high)) + ", not " + text;
  };
  return {check, ""};
}

CLI::Validator Positive() {
  const auto check = [](const std::string& text) -> std::string {
    double value = 0;
    if (absl::SimpleAtod(text, &value) && value > 0 && std::isfinite(value)) return "";
    return "must be finite and positive, not " + text;
  };
  return {check, ""};
}

std::string WhyInexact(const std::string& text) {
  const std::string sign = text.starts_with('-') ? "-" : "";
  const char* const end = text.data() + text.size();
  uint64_t whole = 0;
  const auto [at, error] = std::from_chars(text.data() + sign.size(), end, whole);
  if (error != std::errc() || at != end) return "";
  const auto held = static_cast<double>(whole);
  if (held < 0x1p64 && static_cast<uint64_t>(held) == whole) return "";
  return absl::StrFormat(
      "cannot tell %s from %s%.0f: bounds are exact up to 2^53 = 9007199254740992%s", text, sign,
      held, sign.empty() ? "; --label takes larger values" : "");
}

CLI::Validator Exact() { return {WhyInexact, ""}; }

std::string InWords(const std::string& error) {
  const std::vector<std::string> words = absl::StrSplit(error, ' ');
  if (error.starts_with("Could not convert: ") && words.size() >= 5) {
    double value = 0;
    const std::string given = error.substr(error.find(" = ") + 3);
    return absl::StrCat(words[3], " ", given, ": must be a ",
                        absl::SimpleAtod(given, &value) ? "whole number" : "number");
  }
  if (words.size() == 8 && words[1] == "At" && words[3] == "1") {
    return absl::StrCat(words[0], " given ", words[7], " times, but takes one value");
  }
  if (words.size() == 8 && words[1] == "At" && words[4] == "required") {
    return absl::StrCat(words[0], " needs ", words[3], " numbers separated by commas, not ",
                        words[7]);
  }
  if (words.size() == 3 && words[1] == "excludes") {
    return absl::StrCat(words[0], " and ", words[2], " exclude each other");
  }
  if (words.size() == 5 && words[2] == "required" && words[4] == "missing") {
    return words[0].substr(0, words[0].size() - 1) + " needs a value";
  }
  return error;
}

std::optional<uint64_t> ParseCount(std::string_view text) {
  std::string digits, decimals;
  TakeDigits(text, digits);
  if (digits.empty()) return std::nullopt;
  if (text.starts_with('.')) {
    text.remove_prefix(1);
    TakeDigits(text, decimals);
    if (decimals.empty()) return std::nullopt;
  }
  const std::optional<int> zeros = TakeZeros(text);
  if (!zeros.has_value() || !text.empty()) return std::nullopt;
  decimals.resize(std::max(decimals.size(), static_cast<size_t>(*zeros)), '0');
  const auto fraction = std::string_view(decimals).substr(static_cast<size_t>(*zeros));
  if (fraction.find_first_not_of('0') != fraction.npos) return std::nullopt;
  uint64_t count = 0;
  for (const char digit : digits + decimals.substr(0, static_cast<size_t>(*zeros))) {
    const bool fits = !__builtin_mul_overflow(count, uint64_t{10}, &count) &&
                      !__builtin_add_overflow(count, static_cast<uint64_t>(digit - '0'), &count);
    if (!fits) return std::nullopt;
  }
  return count;
}

namespace {

std::string Exchange(std::string text, char from, char to) {
  std::ranges::replace(text, from, to);
  return text;
}

std::string FlagOf(const std::string& name) { return "--" + Exchange(name, '_', '-'); }

absl::Status Wrong(std::string_view message) {
  return absl::InvalidArgumentError(WithOptionNames(message));
}

// An App without --help and the arguments that it fills: it points to them, so neither may move.
template <typename Arguments>
struct Reader {
  CLI::App app;
  Arguments arguments;

  Reader() { app.set_help_flag(); }

  absl::Status Read(const std::vector<NamedOption>& options) {
    std::vector<std::string> words;
    for (const auto& [name, value] : options) {
      if (app.get_option_no_throw(FlagOf(name)) == nullptr) return absl::NotFoundError(name);
      words.push_back(value.has_value() ? FlagOf(name) + "=" + *value : FlagOf(name));
    }
    std::ranges::reverse(words);  // CLI11 takes the words of a vector in reverse order
    try {
      app.parse(std::move(words));
    } catch (const CLI::ParseError& error) {
      return Wrong(InWords(error.what()));
    }
    const absl::Status fit = ValidateOptions(arguments.skeletonize);
    return fit.ok() ? fit : Wrong(std::string(fit.message()));
  }
};

struct ObjectReader : Reader<SkeletonizeArguments> {
  explicit ObjectReader(OptionSet set) {
    if (set == OptionSet::kFile) {
      AddImageLayout(app, arguments.image);
      return;
    }
    if (set == OptionSet::kMesh) AddGrid(app, arguments.grid);
    if (set == OptionSet::kMask) AddMaskOptions(app, arguments.image);
    AddSkeletonOptions(app, arguments.skeletonize, arguments.root);
  }
};

struct LabelsReader : Reader<LabelsArguments> {
  LabelsReader() {
    AddLabelOptions(app, arguments.image);
    AddMinVoxels(app, arguments.min_voxels);
    AddSkeletonOptions(app, arguments.skeletonize, arguments.root);
  }
};

template <typename Use>
auto WithApp(OptionSet set, Use use) {
  if (set == OptionSet::kLabels) return use(LabelsReader().app);
  return use(ObjectReader(set).app);
}

// Whether the option has this word among its values.
bool IsChoice(const std::string& flag, const std::string& word) {
  const auto takes = [&](const CLI::App& app) {
    const CLI::Option* option = app.get_option_no_throw(flag);
    if (option == nullptr) return false;
    const std::vector<std::string> values = absl::StrSplit(option->get_option_text(), '|');
    return std::ranges::count(values, word) > 0;
  };
  constexpr std::array kSets = {OptionSet::kMask, OptionSet::kMesh, OptionSet::kFile};
  return std::ranges::any_of(kSets, [&](OptionSet set) { return WithApp(set, takes); });
}

// A range of labels, such as 1-85.
bool IsRange(const std::string& word) {
  return word.find_first_not_of("0123456789-") == word.npos && word.find('-', 1) != word.npos;
}

// What stays as it is in Python: numbers and lists of them, a placeholder such as X, or a name that
// is quoted already.
bool IsPlainValue(const std::string& word) {
  if (IsRange(word)) return false;
  return word.find_first_not_of("0123456789.,e+-") == word.npos ||
         std::ranges::all_of(word, absl::ascii_isupper) || word.front() == '\'';
}

// The value that follows the name of an option in a message; empty: other words do.
std::string ValueBehind(const std::string& flag, std::string_view message) {
  if (!message.starts_with(' ')) return "";
  std::string word(message.substr(1, message.find(' ', 1) - 1));
  while (!word.empty() && std::string_view(",.;:)").find(word.back()) != std::string_view::npos) {
    word.pop_back();
  }
  return !word.empty() && (IsPlainValue(word) || IsRange(word) || IsChoice(flag, word)) ? word : "";
}

std::string Quoted(const std::string& value) {
  if (!IsPlainValue(value)) return "\"" + value + "\"";
  if (value.find(',') == value.npos) return value;
  return "(" + absl::StrReplaceAll(value, {{",", ", "}}) + ")";
}

}  // namespace

std::string WithOptionNames(std::string_view message) {
  std::string functions(message);
  absl::StrReplaceAll({{"bccskel skeletonize --", "skeletonize() with --"},
                       {"skeletonize --", "skeletonize() with --"},
                       {"the command labels", "skeletonize_labels()"}},
                      &functions);
  std::string text;
  for (std::string_view rest = functions; !rest.empty();) {
    const bool begins = text.empty() || text.back() == ' ' || text.back() == '(';
    if (!begins || !rest.starts_with("--")) {
      text += rest.front();
      rest.remove_prefix(1);
      continue;
    }
    const auto end = std::ranges::find_if_not(rest, [](char c) {
      return absl::ascii_islower(static_cast<unsigned char>(c)) || c == '-';
    });
    const std::string flag(rest.begin(), end);
    rest.remove_prefix(flag.size());
    text += Exchange(flag.substr(2), '-', '_');
    const std::string value = ValueBehind(flag, rest);
    if (value.empty()) continue;
    text += "=" + Quoted(value);
    rest.remove_prefix(value.size() + 1);
    if (rest.starts_with(" --")) text += ',';
  }
  return text;
}

std::vector<std::string> OptionNames(OptionSet set) {
  return WithApp(set, [](const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
      for (const std::string& name : option->get_lnames()) {
        names.push_back(Exchange(name, '-', '_'));
      }
    }
    return names;
  });
}

bool IsFlag(OptionSet set, const std::string& name) {
  return WithApp(set, [&](const CLI::App& app) {
    return app.get_option(FlagOf(name))->get_items_expected_max() == 0;
  });
}

absl::StatusOr<SkeletonizeArguments> ReadNamedOptions(OptionSet set,
                                                      const std::vector<NamedOption>& options) {
  ObjectReader reader(set);
  const absl::Status status = reader.Read(options);
  if (!status.ok()) return status;
  const absl::Status rule = ForegroundOf(reader.arguments.image).status();
  if (!rule.ok()) return Wrong(std::string(rule.message()));
  return std::move(reader.arguments);
}

absl::StatusOr<LabelsArguments> ReadLabelsOptions(const std::vector<NamedOption>& options) {
  LabelsReader reader;
  const absl::Status status = reader.Read(options);
  if (!status.ok()) return status;
  const absl::Status fit = ValidateRootOfLabels(reader.arguments.root);
  if (!fit.ok()) return Wrong(std::string(fit.message()));
  return std::move(reader.arguments);
}

}  // namespace bccskel::cli
