#include "server/settings/setting.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <ratio>
#include <string_view>
#include <utility>

#include "absl/status/statusor.h"
#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "core/exec/status_macros.h"
#include "proto/address/address.h"

namespace bccskel::server {
namespace {

using Hours = std::chrono::duration<double, std::ratio<3600>>;

// As a string of TOML: in single quotes if it has something to escape, which CLI11 does not
// unescape.
std::string Shown(const std::string& text) {
  const char* const quote = text.find_first_of("\"\\") == std::string::npos ? "\"" : "'";
  return absl::StrCat(quote, text, quote);
}
std::string Shown(int number) { return absl::StrCat(number); }
std::string Shown(uint64_t number) { return absl::StrCat(number); }
std::string Shown(std::chrono::milliseconds time) { return absl::StrCat(time.count()); }
std::string Shown(std::chrono::seconds time) { return absl::StrCat(Hours(time).count()); }

// A setting with one value, parsed by `parse`.
template <typename Value, typename Parse>
Setting Single(std::string name, std::string value, Value& target, std::string description,
               Parse parse) {
  const auto set = [&target, parse](const std::vector<std::string>& values) -> absl::Status {
    if (values.size() != 1) {
      return absl::InvalidArgumentError(
          absl::StrCat("is given ", values.size(), " values, takes one"));
    }
    BCCSKEL_ASSIGN_OR_RETURN(target, parse(values.front()));
    return absl::OkStatus();
  };
  return {std::move(name), std::move(value), std::move(description), set,
          [&target] { return Shown(target); }};
}

absl::Status Wrong(const std::string& text, const std::string& must) {
  return absl::InvalidArgumentError(absl::StrCat(text, ": must be ", must));
}

// The power of 1024 of a unit; -1 for an unknown unit.
int PowerOf(std::string unit) {
  absl::AsciiStrToLower(&unit);
  if (unit.empty() || unit == "b") return 0;
  constexpr std::string_view kLetters = "kmgt";
  const size_t power = kLetters.find(unit[0]);
  const std::string rest = unit.substr(1);
  const bool known =
      power != std::string_view::npos && (rest.empty() || rest == "b" || rest == "ib");
  return known ? static_cast<int>(power) + 1 : -1;
}

}  // namespace

absl::StatusOr<int> ParseNumber(const std::string& text, int low, int high) {
  int number = 0;
  if (absl::SimpleAtoi(text, &number) && number >= low && number <= high) return number;
  return Wrong(text, absl::StrCat("a number from ", low, " to ", high));
}

absl::StatusOr<uint64_t> ParseSize(const std::string& text, uint64_t low) {
  const size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  std::string unit = text.substr(digits);
  absl::StripAsciiWhitespace(&unit);
  uint64_t bytes = 0;
  const int power = PowerOf(unit);
  const bool number = absl::SimpleAtoi(text.substr(0, digits), &bytes) && power >= 0;
  if (number && bytes <= std::numeric_limits<uint64_t>::max() >> (10 * power)) {
    bytes <<= 10 * power;
    if (bytes >= low) return bytes;
  }
  return Wrong(text, absl::StrCat("a size of at least ", low,
                                  " bytes, with or without a unit, such as 256MB or 8GB"));
}

Setting NumberSetting(std::string name, int& target, int low, int high, std::string description) {
  return Single(std::move(name), "N", target, std::move(description),
                [low, high](const std::string& text) { return ParseNumber(text, low, high); });
}

Setting CountSetting(std::string name, uint64_t& target, std::string description) {
  const auto parse = [](const std::string& text) -> absl::StatusOr<uint64_t> {
    uint64_t count = 0;
    if (absl::SimpleAtoi(text, &count) && count > 0) return count;
    return Wrong(text, absl::StrCat("a number from 1 to ", std::numeric_limits<uint64_t>::max()));
  };
  return Single(std::move(name), "N", target, std::move(description), parse);
}

Setting SizeSetting(std::string name, uint64_t& target, std::string description) {
  return Single(std::move(name), "SIZE", target, std::move(description),
                [](const std::string& text) { return ParseSize(text, 0); });
}

Setting MillisecondsSetting(std::string name, std::chrono::milliseconds& target,
                            std::string description) {
  constexpr int kDay = 86'400'000;
  const auto parse = [](const std::string& text) -> absl::StatusOr<std::chrono::milliseconds> {
    BCCSKEL_ASSIGN_OR_RETURN(const int time, ParseNumber(text, 0, kDay));
    return std::chrono::milliseconds(time);
  };
  return Single(std::move(name), "MS", target, std::move(description), parse);
}

Setting HoursSetting(std::string name, std::chrono::seconds& target, std::string description) {
  const auto parse = [](const std::string& text) -> absl::StatusOr<std::chrono::seconds> {
    constexpr double kYear = 24 * 366, kLeast = 0.01;
    double hours = 0;
    const bool decimal = text.find_first_of("xX") == std::string::npos;
    if (decimal && absl::SimpleAtod(text, &hours) && hours >= kLeast && hours <= kYear) {
      return std::chrono::round<std::chrono::seconds>(Hours(hours));
    }
    return Wrong(text, absl::StrCat("a decimal number from ", kLeast, " to ", kYear));
  };
  return Single(std::move(name), "HOURS", target, std::move(description), parse);
}

Setting ChoiceSetting(std::string name, std::string& target, std::vector<std::string> choices,
                      std::string description) {
  const std::string words = absl::StrJoin(choices, "|");
  const auto parse =
      [choices = std::move(choices)](const std::string& text) -> absl::StatusOr<std::string> {
    if (std::ranges::find(choices, text) != choices.end()) return text;
    return Wrong(text, absl::StrCat("one of ", absl::StrJoin(choices, ", ")));
  };
  return Single(std::move(name), words, target, std::move(description), parse);
}

Setting TextSetting(std::string name, std::string value, std::string& target,
                    std::string description) {
  return Single(std::move(name), std::move(value), target, std::move(description),
                [](const std::string& text) { return absl::StatusOr<std::string>(text); });
}

Setting PathSetting(std::string name, std::string& target, std::string description) {
  return TextSetting(std::move(name), "PATH", target, std::move(description));
}

Setting AddressSetting(std::string name, std::string& target, std::string description) {
  const auto parse = [](const std::string& text) -> absl::StatusOr<std::string> {
    if (!text.empty()) BCCSKEL_RETURN_IF_ERROR(CheckAddress(text));
    return text;
  };
  return Single(std::move(name), "ADDRESS", target, std::move(description), parse);
}

Setting AddressesSetting(std::string name, std::vector<std::string>& target,
                         std::string description) {
  const auto set = [&target](const std::vector<std::string>& values) -> absl::Status {
    if (values.empty()) return absl::InvalidArgumentError("names no address");
    for (const std::string& address : values) BCCSKEL_RETURN_IF_ERROR(CheckAddress(address));
    target = values;
    return absl::OkStatus();
  };
  const auto show = [&target] {
    const auto quote = [](std::string* out, const std::string& text) { out->append(Shown(text)); };
    return absl::StrCat("[", absl::StrJoin(target, ", ", quote), "]");
  };
  return {std::move(name), "ADDRESS", std::move(description), set, show, Setting::Values::kList};
}

}  // namespace bccskel::server
