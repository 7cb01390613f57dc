#include "server/settings/setting.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <ratio>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "core/exec/status_macros.h"
#include "server/settings/values.h"

namespace bccskel::server {
namespace {

std::string Quoted(const std::string& text) { return absl::StrCat("\"", text, "\""); }

// A setting with one value.
template <typename Parse, typename Show>
Setting Single(std::string name, std::string value, std::string description, Parse parse,
               Show show) {
  const auto set = [parse](const std::vector<std::string>& values) -> absl::Status {
    if (values.size() == 1) return parse(values.front());
    return absl::InvalidArgumentError(
        absl::StrCat("is given ", values.size(), " values, takes one"));
  };
  return {std::move(name), std::move(value), std::move(description), set, show};
}

}  // namespace

Setting NumberSetting(std::string name, int& target, int low, int high, std::string description) {
  const auto parse = [&target, low, high](const std::string& text) -> absl::Status {
    BCCSKEL_ASSIGN_OR_RETURN(target, ParseNumber(text, low, high));
    return absl::OkStatus();
  };
  return Single(std::move(name), "N", std::move(description), parse,
                [&target] { return absl::StrCat(target); });
}

Setting CountSetting(std::string name, uint64_t& target, std::string description) {
  const auto parse = [&target](const std::string& text) -> absl::Status {
    uint64_t count = 0;
    if (!absl::SimpleAtoi(text, &count) || count == 0) {
      return absl::InvalidArgumentError(absl::StrCat(text, ": must be a number from 1 to ",
                                                     std::numeric_limits<uint64_t>::max()));
    }
    target = count;
    return absl::OkStatus();
  };
  return Single(std::move(name), "N", std::move(description), parse,
                [&target] { return absl::StrCat(target); });
}

Setting SizeSetting(std::string name, uint64_t& target, uint64_t low, std::string description) {
  const auto parse = [&target, low](const std::string& text) -> absl::Status {
    BCCSKEL_ASSIGN_OR_RETURN(target, ParseSize(text, low));
    return absl::OkStatus();
  };
  return Single(std::move(name), "SIZE", std::move(description), parse,
                [&target] { return absl::StrCat(target); });
}

Setting MillisecondsSetting(std::string name, std::chrono::milliseconds& target,
                            std::string description) {
  constexpr int kDay = 86'400'000;
  const auto parse = [&target](const std::string& text) -> absl::Status {
    BCCSKEL_ASSIGN_OR_RETURN(const int time, ParseNumber(text, 0, kDay));
    target = std::chrono::milliseconds(time);
    return absl::OkStatus();
  };
  return Single(std::move(name), "MS", std::move(description), parse,
                [&target] { return absl::StrCat(target.count()); });
}

Setting HoursSetting(std::string name, std::chrono::seconds& target, std::string description) {
  using Hours = std::chrono::duration<double, std::ratio<3600>>;
  const auto parse = [&target](const std::string& text) -> absl::Status {
    constexpr double kYear = 24 * 366, kLeast = 0.01;
    double hours = 0;
    if (!absl::SimpleAtod(text, &hours) || !(hours >= kLeast && hours <= kYear)) {
      return absl::InvalidArgumentError(
          absl::StrCat(text, ": must be a number from ", kLeast, " to ", kYear));
    }
    target = std::chrono::round<std::chrono::seconds>(Hours(hours));
    return absl::OkStatus();
  };
  return Single(std::move(name), "HOURS", std::move(description), parse,
                [&target] { return absl::StrCat(Hours(target).count()); });
}

Setting ChoiceSetting(std::string name, std::string& target, std::vector<std::string> choices,
                      std::string description) {
  const std::string words = absl::StrJoin(choices, "|");
  const auto parse = [&target, choices = std::move(choices)](const std::string& text) {
    if (std::ranges::find(choices, text) == choices.end()) {
      return absl::InvalidArgumentError(
          absl::StrCat(text, ": must be one of ", absl::StrJoin(choices, ", ")));
    }
    target = text;
    return absl::OkStatus();
  };
  return Single(std::move(name), words, std::move(description), parse,
                [&target] { return Quoted(target); });
}

Setting TextSetting(std::string name, std::string value, std::string& target,
                    std::string description) {
  const auto parse = [&target](const std::string& text) {
    target = text;
    return absl::OkStatus();
  };
  return Single(std::move(name), std::move(value), std::move(description), parse,
                [&target] { return Quoted(target); });
}

Setting PathSetting(std::string name, std::string& target, std::string description) {
  return TextSetting(std::move(name), "PATH", target, std::move(description));
}

Setting AddressSetting(std::string name, std::string& target, std::string description) {
  const auto parse = [&target](const std::string& text) -> absl::Status {
    if (!text.empty()) BCCSKEL_RETURN_IF_ERROR(CheckAddress(text));
    target = text;
    return absl::OkStatus();
  };
  return Single(std::move(name), "ADDRESS", std::move(description), parse,
                [&target] { return Quoted(target); });
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
    const auto quote = [](std::string* out, const std::string& text) { out->append(Quoted(text)); };
    return absl::StrCat("[", absl::StrJoin(target, ", ", quote), "]");
  };
  return {std::move(name), "ADDRESS", std::move(description), set, show};
}

}  // namespace bccskel::server
