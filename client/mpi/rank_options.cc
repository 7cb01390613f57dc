#include "client/mpi/rank_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>
#include <utility>

#include "client/cli/option_values.h"

namespace bccskel::cli {
namespace {

// Seeds and noise are for shapes; without one they are left to the other options.
void AddShape(CLI::App& app, RankOptions& options) {
  app.add_option_function<std::string>("--generate", [&options](const std::string& name) {
    const absl::StatusOr<Shape> shape = ParseShapeName(name);
    if (!shape.ok()) throw CLI::ValidationError(std::string(shape.status().message()));
    options.shape = *shape;
  });
  app.add_option("--seed", options.shape_options.seed);
  app.add_option("--noise", options.shape_options.noise);
}

// The name of the shape takes the place of the input.
absl::Status NameShape(std::vector<std::string>& words, Shape shape) {
  if (words.empty()) {
    return absl::InvalidArgumentError(
        "the command is missing: bccskel-mpi skeletonize --generate SHAPE -o OUTPUT");
  }
  if (words.size() > 1 && !words[1].starts_with('-')) {
    return absl::InvalidArgumentError("--generate SHAPE takes the place of INPUT: omit " +
                                      words[1]);
  }
  words.insert(words.begin() + 1, std::string(ShapeName(shape)));
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<RankOptions> TakeRankOptions(std::vector<std::string>& words) {
  RankOptions options;
  CLI::App app;
  app.set_help_flag();
  app.allow_extras();
  app.add_flag_callback("--report-exchange", [&] { options.report = ExchangeReport::kYes; });
  app.add_flag_callback("--resume", [&] { options.resuming = ranks::Resuming::kWhereDone; });
  app.add_option("--checkpoint", options.checkpoint_folder);
  app.add_option_function<double>("--checkpoint-every",
                                  [&](double seconds) {
                                    options.checkpoint_interval = std::chrono::milliseconds(
                                        static_cast<int64_t>(seconds * 1000));
                                  })
      ->check(Within(0, 1e6));
  const auto makes_shape = [](std::string_view word) { return word.starts_with("--generate"); };
  if (std::ranges::any_of(words, makes_shape)) AddShape(app, options);
  try {
    std::ranges::reverse(words);  // CLI11 takes the words of a vector in reverse order
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    return absl::InvalidArgumentError(InWords(error.what()));
  }
  words = app.remaining();
  const bool alone =
      app.count("--checkpoint-every") > 0 || options.resuming == ranks::Resuming::kWhereDone;
  if (alone && options.checkpoint_folder.empty()) {
    return absl::InvalidArgumentError("--resume and --checkpoint-every: need --checkpoint FOLDER");
  }
  const absl::Status named =
      options.shape.has_value() ? NameShape(words, *options.shape) : absl::OkStatus();
  if (!named.ok()) return named;
  return options;
}

}  // namespace bccskel::cli
