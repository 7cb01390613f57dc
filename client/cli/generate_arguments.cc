#include "client/cli/generate_arguments.h"

#include <CLI/CLI.hpp>
#include <string>

#include "client/cli/count_option.h"

namespace bccskel::cli {
namespace {

std::string ShapeNames() {
  std::string names;
  for (const Shape shape : kShapes) {
    if (!names.empty()) names += ", ";
    names += ShapeName(shape);
  }
  return names;
}

}  // namespace

void AddGenerate(CLI::App& command, GenerateArguments& arguments) {
  command
      .add_option_function<std::string>(
          "SHAPE",
          [&arguments](const std::string& name) {
            const absl::StatusOr<Shape> shape = ParseShapeName(name);
            if (!shape.ok()) throw CLI::ValidationError(std::string(shape.status().message()));
            arguments.shape = *shape;
          },
          "One of " + ShapeNames())
      ->required()
      ->option_text(" ");
  command.add_option("-o,--output", arguments.output, "Volume to write: .exr or .bccb")
      ->required()
      ->option_text("FILE (required)");
  AddCount(command, "--points", arguments.options.points,
           "Points the object shall have (default 850000)");
  AddCount(command, "--seed", arguments.options.seed, "Chooses the random parts (default 0)");
  command
      .add_option("--noise", arguments.options.noise,
                  "Fraction of boundary points that change sides, 0 to 0.1 (default 0)")
      ->option_text("X");
}

}  // namespace bccskel::cli
