#ifndef BCCSKEL_CLIENT_CLI_CHOICE_OPTION_H_
#define BCCSKEL_CLIENT_CLI_CHOICE_OPTION_H_

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace bccskel::cli {

// "a", "a or b", "a, b or c".
inline std::string OneOf(const std::vector<std::string>& words) {
  std::string text;
  for (size_t n = 0; n < words.size(); ++n) {
    text += (n == 0 ? "" : n + 1 < words.size() ? ", " : " or ") + words[n];
  }
  return text;
}

// An option with a few words as its values. CLI11's own complaint about another word shows the
// numbers of the enumeration.
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
      ->option_text(CLI::detail::join(words, "|"));
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

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_CHOICE_OPTION_H_
