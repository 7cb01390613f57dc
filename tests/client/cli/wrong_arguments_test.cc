#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>
#include <vector>

#include "tests/client/cli/parsed.h"

namespace bccskel::cli {
namespace {

using testing::HasSubstr;

// A command line that is wrong, and a part of what the user reads.
struct Wrong {
  const char* name;
  std::vector<const char*> words;
  const char* message;
};

void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.name; }

class WrongCommandLineTest : public testing::TestWithParam<Wrong> {};

TEST_P(WrongCommandLineTest, IsExplainedOnStandardErrorWithExitCode2) {
  const Parsed parsed = Parse(GetParam().words);
  EXPECT_EQ(parsed.code(), ExitCode::kUsage);
  EXPECT_THAT(parsed.err, HasSubstr("bccskel: error: "));
  EXPECT_THAT(parsed.err, HasSubstr(GetParam().message));
  EXPECT_EQ(parsed.out, "");
}

INSTANTIATE_TEST_SUITE_P(
    Every, WrongCommandLineTest,
    testing::Values(
        Wrong{"no_command", {}, "a command is required: skeletonize, labels, info, view"},
        Wrong{"unknown_command", {"dance"}, "there is no command dance\n"},
        Wrong{"misspelled_command",
              {"skeletonise", "a.off"},
              "there is no command skeletonise; did you mean skeletonize?"},
        Wrong{"unknown_option", {"info", "a.off", "--loud"}, "info has no option --loud\n"},
        Wrong{"misspelled_option",
              {"skeletonize", "a.off", "--pints", "9"},
              "skeletonize has no option --pints; did you mean --points?"},
        Wrong{"misspelled_option_of_a_group",
              {"labels", "a.tif", "-o", "a.csv", "--sever=x:1"},
              "labels has no option --sever; did you mean --server?"},
        Wrong{"unknown_nested_option",
              {"bench", "core", "--thread", "2"},
              "core has no option --thread; did you mean --threads?"},
        Wrong{"no_input", {"skeletonize", "-o", "a.swc"}, "INPUT is required"},
        Wrong{"no_output", {"skeletonize", "a.off"}, "--output is required"},
        Wrong{"output_without_a_path", {"skeletonize", "a.off", "-o"}, "--output needs a value\n"},
        Wrong{"unknown_ending", {"skeletonize", "a.off", "-o", "a.docx"}, ".graphml"},
        Wrong{"points_and_spacing",
              {"skeletonize", "a.off", "-o", "a.swc", "--points", "9", "--spacing", "1"},
              "--points"},
        Wrong{"local_and_server",
              {"skeletonize", "a.off", "-o", "a.swc", "--local", "--server", "x:1"},
              "--server"},
        Wrong{"unknown_fill", {"skeletonize", "a.off", "-o", "a.swc", "--fill", "sand"}, "sand"},
        Wrong{"thin_shell", {"skeletonize", "a.off", "-o", "a.swc", "--shell-width", "0.1"}, "0.1"},
        Wrong{"thick_shell", {"skeletonize", "a.off", "-o", "a.swc", "--shell-width", "65"}, "64"},
        Wrong{
            "negative_shell", {"skeletonize", "a.off", "-o", "a.swc", "--last-shell", "-1"}, "-1"},
        Wrong{"no_number", {"skeletonize", "a.off", "-o", "a.swc", "--threads", "many"}, "many"},
        Wrong{"too_many_threads",
              {"skeletonize", "a.off", "-o", "a.swc", "--threads", "1025"},
              "1025"},
        Wrong{"no_time", {"skeletonize", "a.off", "-o", "a.swc", "--timeout", "0"}, "--timeout"},
        Wrong{"grid_of_a_volume",
              {"skeletonize", "a.exr", "-o", "a.swc", "--points", "9"},
              "is a volume"},
        Wrong{"voxelize_without_size", {"voxelize", "a.off", "-o", "a.exr"}, "--spacing"},
        Wrong{"voxelize_to_a_skeleton",
              {"voxelize", "a.off", "-o", "a.swc", "--points", "9"},
              ".bccb"},
        Wrong{"too_many_passes", {"skeletonize", "a.off", "-o", "a.swc", "--denoise", "17"}, "16"},
        Wrong{"prepared_voxels",
              {"skeletonize", "a.tif", "-o", "a.swc", "--keep-largest", "--curve-image", "b.nrrd"},
              "as they are"},
        Wrong{"half_a_root", {"skeletonize", "a.off", "-o", "a.swc", "--root", "1,2"}, "node:7"},
        Wrong{
            "root_of_labels", {"labels", "a.tif", "-o", "a.vtp", "--root", "node:1"}, "have many"},
        Wrong{"unknown_distance",
              {"skeletonize", "a.off", "-o", "a.swc", "--distance", "chamfer5"},
              "--distance chamfer5: must be chamfer, chamfer-optimal or euclidean\n"},
        Wrong{"number_of_a_word",
              {"skeletonize", "a.off", "-o", "a.swc", "--tips", "1"},
              "--tips 1: must be ridge or as-thinned"},
        Wrong{"unknown_sampling",
              {"skeletonize", "a.tif", "-o", "a.swc", "--sampling", "cubic"},
              "--sampling cubic: must be exact, nearest or trilinear"},
        Wrong{"negative_component",
              {"skeletonize", "a.off", "-o", "a.swc", "--min-component", "-3"},
              "--min-component -3: must be a whole number from 0 to 18446744073709551615"},
        Wrong{"negative_passes", {"skeletonize", "a.off", "-o", "a.swc", "--denoise", "-1"}, "16"},
        Wrong{"negative_points",
              {"voxelize", "a.off", "-o", "a.exr", "--points", "-9"},
              "--points -9: must be a whole number"},
        Wrong{"no_points",
              {"skeletonize", "a.off", "-o", "a.swc", "--points", "0"},
              "--points 0: must be at least 1"},
        Wrong{"no_spacing",
              {"voxelize", "a.off", "-o", "a.exr", "--spacing", "0"},
              "--spacing: must be finite and positive, not 0"},
        Wrong{"endless_spacing",
              {"voxelize", "a.off", "-o", "a.exr", "--spacing", "inf"},
              "--spacing: must be finite and positive, not inf"},
        Wrong{"label_by_name",
              {"skeletonize", "a.tif", "-o", "a.swc", "--label", "liver"},
              "--label liver: must be a whole number from 1 on or a range, such as 3,7 or 1-85"},
        Wrong{"no_nested_command", {"bench"}, "a command is required: core, server\n"},
        Wrong{"unknown_nested_command", {"bench", "cores"}, "there is no command bench cores"},
        Wrong{"negative_label",
              {"skeletonize", "a.tif", "-o", "a.swc", "--label", "4,-5"},
              "--label -5: must be a whole number"},
        Wrong{"label_of_the_background",
              {"labels", "a.tif", "-o", "a.vtp", "--label", "0-85"},
              "0 is the background; labels are counted from 1, so write 1-85"},
        Wrong{"labels_backwards",
              {"labels", "a.tif", "-o", "a.vtp", "--label", "9-3"},
              "--label 9-3: the first label is above the last"},
        Wrong{"too_many_labels",
              {"skeletonize", "a.tif", "-o", "a.swc", "--label", "1-5000000000"},
              "more than 1000000 labels"},
        Wrong{"negative_swc_step",
              {"skeletonize", "a.off", "-o", "a.swc", "--swc-step", "-1"},
              "--swc-step: must be 0 or more, and finite, not -1"},
        Wrong{"step_that_is_no_number",
              {"skeletonize", "a.off", "-o", "a.swc", "--swc-step", "nan"},
              "--swc-step: must be 0 or more, and finite, not nan"},
        Wrong{"time_that_is_no_number",
              {"skeletonize", "a.off", "-o", "a.swc", "--timeout", "nan"},
              "--timeout: must be 0.001 to 10000000, not nan"},
        Wrong{"turn_that_is_no_number",
              {"render", "a.json", "--object", "a.off", "-o", "a.png", "--turn", "nan"},
              "--turn: must be -360 to 360, not nan"},
        Wrong{"half_a_pass",
              {"skeletonize", "a.off", "-o", "a.swc", "--denoise", "2.5"},
              "--denoise 2.5: must be a whole number"},
        Wrong{"end_of_a_range_that_would_be_rounded",
              {"skeletonize", "a.npy", "-o", "a.swc", "--range", "1,9007199254740993"},
              "--range: cannot tell 9007199254740993 from 9007199254740992: bounds are exact up "
              "to 2^53 = 9007199254740992; --label takes larger values"},
        Wrong{"threshold_that_would_be_rounded",
              {"skeletonize", "a.npy", "-o", "a.swc", "--threshold", "18446744073709551615"},
              "--threshold: cannot tell 18446744073709551615 from 18446744073709551616"},
        Wrong{"below_what_would_be_rounded",
              {"skeletonize", "a.npy", "-o", "a.swc", "--below", "-9223372036854775807"},
              "--below: cannot tell -9223372036854775807 from -9223372036854775808"},
        Wrong{"threshold_in_words",
              {"skeletonize", "a.tif", "-o", "a.swc", "--threshold", "high up"},
              "--threshold high up: must be a number"},
        Wrong{"voxels_of_two_sizes",
              {"skeletonize", "a.tif", "-o", "a.swc", "--voxel-size", "1,2"},
              "--voxel-size: needs 3 numbers with commas between them, not 2"},
        Wrong{"voxels_without_size",
              {"skeletonize", "a.tif", "-o", "a.swc", "--voxel-size", "1,0,1"},
              "--voxel-size: must be finite and positive, not 0"},
        Wrong{"negative_label_of_many",
              {"labels", "a.tif", "-o", "a.vtp", "--labels", "-5"},
              "--label -5: must be a whole number"},
        Wrong{"negative_voxels",
              {"labels", "a.tif", "-o", "a.vtp", "--min-voxels", "-5"},
              "--min-voxels -5: must be a whole number"},
        Wrong{"negative_header",
              {"info", "a.raw", "--raw-size", "9,9,9", "--raw-header", "-5"},
              "--raw-header -5: must be a whole number"},
        Wrong{"too_large_a_number",
              {"generate", "ball", "-o", "a.exr", "--points", "99999999999999999999"},
              "--points 99999999999999999999: must be a whole number"},
        Wrong{"negative_seed",
              {"generate", "ball", "-o", "a.exr", "--seed", "-1"},
              "--seed -1: must be a whole number"},
        Wrong{"negative_bench", {"bench", "core", "--points", "-9"}, "--points"},
        Wrong{"negative_node",
              {"skeletonize", "a.off", "-o", "a.swc", "--root", "node:-3"},
              "--root node -3: must be a whole number"},
        Wrong{"pruning_of_a_surface",
              {"skeletonize", "a.off", "-o", "a.swc", "--kind", "surface", "--pruning", "length",
               "--pruning-threshold", "3"},
              "pruning by length, relative length or persistence: is for curves"},
        Wrong{"pruning_of_shells",
              {"skeletonize", "a.off", "-o", "a.swc", "--last-shell", "5", "--pruning-threshold",
               "3"},
              "and --last-shell stops before there are curves"},
        Wrong{"threshold_of_nothing",
              {"labels", "a.tif", "-o", "a.vtp", "--pruning", "none", "--pruning-threshold", "3"},
              "not for --pruning none"},
        Wrong{"threshold_0",
              {"skeletonize", "a.off", "-o", "a.swc", "--pruning-threshold", "0"},
              "--pruning-threshold: must be finite and positive, not 0"},
        Wrong{"picture_without_object",
              {"render", "a.json", "-o", "a.png"},
              "hint: --object names the mesh"},
        Wrong{"unknown_bench", {"bench", "core", "--shape", "sofa"}, "--shape sofa: must be ball"},
        Wrong{"unknown_shape", {"generate", "teapot", "-o", "a.exr"}, "hollow-ball"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace bccskel::cli
