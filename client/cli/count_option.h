#ifndef BCCSKEL_CLIENT_CLI_COUNT_OPTION_H_
#define BCCSKEL_CLIENT_CLI_COUNT_OPTION_H_

#include <CLI/CLI.hpp>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace bccskel::cli {

// A whole number from 0 on: 850000, 850k, 1.5M, 2G, 1e6; nothing for another text.
std::optional<uint64_t> ParseCount(std::string_view text);

// CLI11 would take -3 for a huge one, and 010 for 8.
template <std::unsigned_integral Number>
Number ReadCount(const std::string& name, const std::string& given) {
  const std::optional<uint64_t> number = ParseCount(given);
  if (number.has_value() && *number <= std::numeric_limits<Number>::max()) {
    return static_cast<Number>(*number);
  }
  throw CLI::ValidationError(name + " " + given + ": must be a whole number from 0 to " +
                             std::to_string(std::numeric_limits<Number>::max()) +
                             ", such as 850000, 850k, 4M or 1e6");
}

template <std::unsigned_integral Number>
CLI::Option* AddCount(CLI::App& command, const std::string& name, std::function<void(Number)> use,
                      const char* description) {
  const auto read = [name, use](const std::string& given) { use(ReadCount<Number>(name, given)); };
  return command.add_option_function<std::string>(name, read, description)->option_text("N");
}

template <std::unsigned_integral Number>
CLI::Option* AddCount(CLI::App& command, const std::string& name, Number& value,
                      const char* description) {
  return AddCount<Number>(
      command, name, [&value](Number count) { value = count; }, description);
}

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_COUNT_OPTION_H_
