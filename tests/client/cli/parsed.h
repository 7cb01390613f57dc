#ifndef BCCSKEL_TESTS_CLIENT_CLI_PARSED_H_
#define BCCSKEL_TESTS_CLIENT_CLI_PARSED_H_

#include <gtest/gtest.h>

#include <string>
#include <variant>
#include <vector>

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

}  // namespace bccskel::cli

#endif  // BCCSKEL_TESTS_CLIENT_CLI_PARSED_H_
