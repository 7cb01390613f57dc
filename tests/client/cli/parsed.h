#ifndef BCCSKEL_TESTS_CLIENT_CLI_PARSED_H_
#define BCCSKEL_TESTS_CLIENT_CLI_PARSED_H_

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "absl/strings/str_split.h"
#include "client/cli/arguments.h"

namespace bccskel::cli {

// What the parser made of a command line, and what it printed.
struct Parsed {
  std::variant<Arguments, ExitCode> arguments;
  std::string out;
  std::string err;

  ExitCode code() const { return std::get<ExitCode>(arguments); }
  template <typename Chosen>
  const Chosen& as() const {
    return std::get<Chosen>(std::get<Arguments>(arguments));
  }
};

inline Parsed Parse(std::vector<const char*> words) {
  words.insert(words.begin(), "bccskel");
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Parsed parsed = {ParseArguments(static_cast<int>(words.size()), words.data()), "", ""};
  parsed.out = testing::internal::GetCapturedStdout();
  parsed.err = testing::internal::GetCapturedStderr();
  return parsed;
}

// The words of a line, with single spaces between them.
inline Parsed Parse(const char* line) {
  const std::vector<std::string> words = absl::StrSplit(line, ' ', absl::SkipEmpty());
  std::vector<const char*> pointers;
  for (const std::string& word : words) pointers.push_back(word.c_str());
  return Parse(std::move(pointers));
}

}  // namespace bccskel::cli

#endif  // BCCSKEL_TESTS_CLIENT_CLI_PARSED_H_
