#ifndef BCCSKEL_CLIENT_CLI_CHOICE_OPTION_H_
#define BCCSKEL_CLIENT_CLI_CHOICE_OPTION_H_

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

namespace bccskel::cli {

// An option with a few words as its values.
template <typename Enum>
CLI::Option* AddChoice(CLI::App& command, const char* name, Enum& value, const char* description,
                       const std::vector<std::pair<std::string, Enum>>& choices) {
  std::string words;
  for (const auto& [word, meaning] : choices) words += (words.empty() ? "" : "|") + word;
  return command.add_option(name, value, description)
      ->transform(CLI::CheckedTransformer(choices))
      ->option_text(words);
}

// The words of a table of core/pipeline/option_words.h as choices.
template <typename Table>
auto Choices(const Table& table) {
  using Enum = decltype(table.front().second);
  return std::vector<std::pair<std::string, Enum>>(table.begin(), table.end());
}

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_CHOICE_OPTION_H_
