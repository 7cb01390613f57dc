#include "client/cli/root_argument.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <string>

#include "client/cli/count_option.h"

namespace bccskel::cli {
namespace {

RootChoice ReadRoot(const std::string& text) {
  RootChoice choice;
  if (text == "thickest-end") return choice;
  const auto all_read = [&](int end) { return text.size() == static_cast<size_t>(end); };
  int end = 0;
  if (text.starts_with("node:")) {
    choice.rule = RootChoice::Rule::kNode;
    choice.node = ReadCount<uint32_t>("--root node", text.substr(5));
    return choice;
  }
  WorldPoint& p = choice.point;
  choice.rule = RootChoice::Rule::kNearestNode;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &p[0], &p[1], &p[2], &end) == 3 && all_read(end) &&
      std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) {
    return choice;
  }
  throw CLI::ValidationError("--root " + text +
                             ": must be thickest-end, a point like 1.5,20,3 or a node like node:7");
}

}  // namespace

void AddRoot(CLI::App& command, std::optional<RootChoice>& root) {
  command
      .add_option_function<std::string>(
          "--root", [&root](const std::string& text) { root = ReadRoot(text); },
          "Order the skeleton as trees from here: generation, Strahler order and way to the root; "
          "edges that close loops are left out")
      ->option_text("thickest-end|X,Y,Z|node:N");
}

}  // namespace bccskel::cli
