#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>

#include "tests/client/cli/parsed.h"

namespace bccskel::cli {
namespace {

using testing::HasSubstr;

// A command line that is wrong, and a part of what the user reads.
struct Wrong {
  const char* name;
  const char* line;
  const char* message;
};

void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.name; }

class WrongCommandLineTest : public testing::TestWithParam<Wrong> {};

TEST_P(WrongCommandLineTest, IsExplainedOnStandardErrorWithExitCode2) {
  const Parsed parsed = Parse(GetParam().line);
  EXPECT_EQ(parsed.code(), ExitCode::kUsage);
  EXPECT_THAT(parsed.err, HasSubstr("bccskel: error: "));
  EXPECT_THAT(parsed.err, HasSubstr(GetParam().message));
  EXPECT_EQ(parsed.out, "");
}

const Wrong kWrong[] = {
    {"no_command", "", "a command is required: skeletonize, labels, info, view"},
    {"unknown_command", "dance", "there is no command dance\n"},
    {"misspelled_command", "skeletonise a.off",
     "there is no command skeletonise; did you mean skeletonize?"},
    {"unknown_option", "info a.off --loud", "info has no option --loud\n"},
    {"misspelled_option", "skeletonize a.off --pints 9",
     "skeletonize has no option --pints; did you mean --points?"},
    {"misspelled_option_of_a_group", "labels a.tif -o a.csv --sever=x:1",
     "labels has no option --sever; did you mean --server?"},
    {"unknown_nested_option", "bench core --thread 2",
     "core has no option --thread; did you mean --threads?"},
    {"no_input", "skeletonize -o a.swc", "INPUT is required"},
    {"no_output", "skeletonize a.off", "--output is required"},
    {"output_without_a_path", "skeletonize a.off -o", "--output needs a value\n"},
    {"unknown_ending", "skeletonize a.off -o a.docx", ".graphml"},
    {"points_and_spacing", "skeletonize a.off -o a.swc --points 9 --spacing 1", "--points"},
    {"local_and_server", "skeletonize a.off -o a.swc --local --server x:1", "--server"},
    {"server_without_a_host", "skeletonize a.off -o a.swc --server http://",
     "--server: 'http://' is neither HOST:PORT, with a port of 0 to 65535, nor unix:PATH"},
    {"server_without_a_port", "probe --server a", "--server: 'a' is neither HOST:PORT"},
    {"channel_of_an_image_that_has_none", "skeletonize a.nii.gz -o a.swc --channel 0",
     "--channel and --time choose in TIFF and OME-Zarr only"},
    {"array_of_an_image_that_has_none", "skeletonize a.npy -o a.swc --array mask",
     "--array chooses in .npz files only"},
    {"level_of_an_image_that_has_none", "labels a.tif -o a.vtp --level 1",
     "--level chooses in OME-Zarr and precomputed folders only"},
    {"tunnels_wider_than_anything", "skeletonize a.exr -o a.swc --cut-loops 1e300",
     "--cut-loops: must be 0 to 1e+09, not 1e300"},
    {"tunnels_narrower_than_nothing", "skeletonize a.exr -o a.swc --cut-loops -1",
     "--cut-loops: must be 0 to 1e+09, not -1"},
    {"negative_volume", "skeletonize a.exr -o a.swc --min-component-volume -1",
     "--min-component-volume: must be 0 or more, and finite, not -1"},
    {"reach_of_junctions", "skeletonize a.exr -o a.swc --merge-junctions 5",
     "--merge-junctions: must be 0 to 4, not 5"},
    {"passes_by_name", "skeletonize a.exr -o a.swc --denoise 17", "--denoise: must be 0 to 16"},
    {"shell_width_by_name", "skeletonize a.exr -o a.swc --shell-width 65",
     "--shell-width: must be 0.75 to 64, not 65"},
    {"last_shell_by_name", "skeletonize a.exr -o a.swc --last-shell -1",
     "--last-shell: must be 0 or more, and finite, not -1"},
    {"threshold_beyond_any", "skeletonize a.exr -o a.swc --pruning-threshold 1e10",
     "--pruning-threshold: must be above 0, up to 1e9, not 1e10"},
    {"length_without_a_threshold", "skeletonize a.exr -o a.swc --pruning length",
     "--pruning length needs --pruning-threshold, the length in world units"},
    {"border_of_a_mesh", "skeletonize a.off -o a.swc --border continues",
     "--border is for images and volumes; a.off is a mesh"},
    {"step_of_no_swc", "skeletonize a.off -o a.csv --swc-step 1",
     "--swc-step is for .swc and .precomputed outputs"},
    {"step_of_no_converted_swc", "convert a.json -o a.csv --swc-step 1",
     "--swc-step is for .swc and .precomputed outputs"},
    {"step_of_no_swc_of_labels", "labels a.tif -o a.csv --swc-step 1",
     "--swc-step is for .swc and .precomputed outputs"},
    {"unknown_fill", "skeletonize a.off -o a.swc --fill sand", "sand"},
    {"thin_shell", "skeletonize a.off -o a.swc --shell-width 0.1", "0.1"},
    {"thick_shell", "skeletonize a.off -o a.swc --shell-width 65", "64"},
    {"negative_shell", "skeletonize a.off -o a.swc --last-shell -1", "-1"},
    {"no_number", "skeletonize a.off -o a.swc --threads many", "many"},
    {"too_many_threads", "skeletonize a.off -o a.swc --threads 1025", "1025"},
    {"no_time", "skeletonize a.off -o a.swc --timeout 0", "--timeout"},
    {"grid_of_a_volume", "skeletonize a.exr -o a.swc --points 9", "is a volume"},
    {"voxelize_without_size", "voxelize a.off -o a.exr", "--spacing"},
    {"voxelize_to_a_skeleton", "voxelize a.off -o a.swc --points 9", ".bccb"},
    {"too_many_passes", "skeletonize a.off -o a.swc --denoise 17", "16"},
    {"prepared_voxels", "skeletonize a.tif -o a.swc --keep-largest --curve-image b.nrrd",
     "original voxels"},
    {"half_a_root", "skeletonize a.off -o a.swc --root 1,2", "node:7"},
    {"root_of_labels", "labels a.tif -o a.vtp --root node:1", "have many"},
    {"unknown_distance", "skeletonize a.off -o a.swc --distance chamfer5",
     "--distance chamfer5: must be chamfer, chamfer-optimal or euclidean\n"},
    {"number_of_a_word", "skeletonize a.off -o a.swc --tips 1",
     "--tips 1: must be ridge or as-thinned"},
    {"unknown_sampling", "skeletonize a.tif -o a.swc --sampling cubic",
     "--sampling cubic: must be exact, nearest or trilinear"},
    {"negative_component", "skeletonize a.off -o a.swc --min-component -3",
     "--min-component -3: must be a whole number from 0 to 18446744073709551615"},
    {"negative_passes", "skeletonize a.off -o a.swc --denoise -1", "16"},
    {"negative_points", "voxelize a.off -o a.exr --points -9",
     "--points -9: must be a whole number from 1 to 8589934592, such as 850000, 850k"},
    {"no_points", "skeletonize a.off -o a.swc --points 0",
     "--points 0: must be a whole number from 1 to 8589934592, such as"},
    {"points_beyond_memory", "skeletonize a.off -o a.swc --points 1e12",
     "--points 1e12: must be a whole number from 1 to 8589934592, such as"},
    {"outputs_of_one_name", "skeletonize a.off -o a.png -o a.svg -o a.png",
     "a.png: is an output already; each needs a file of its own"},
    {"outputs_of_one_file", "labels a.tif -o a.vtp -o ./b/../a.vtp",
     "./b/../a.vtp: is an output already"},
    {"images_of_one_file",
     "skeletonize a.tif -o a.swc --branch-image L.nrrd --curve-image ./L.nrrd",
     "./L.nrrd: is an output already"},
    {"place_of_a_label_without_labels", "skeletonize a.tif -o x{label}.swc",
     "x{label}.swc: only `bccskel labels` puts the number of a label in place of {label}"},
    {"standard_input", "skeletonize - -o a.swc",
     "-: standard input is not read; save it to a file first"},
    {"standard_input_as_a_result", "convert - -o a.swc", "-: standard input is not read"},
    {"standard_input_as_an_object", "view a.json --object - -o a.html",
     "-: standard input is not read"},
    {"no_spacing", "voxelize a.off -o a.exr --spacing 0",
     "--spacing: must be finite and positive, not 0"},
    {"endless_spacing", "voxelize a.off -o a.exr --spacing inf",
     "--spacing: must be finite and positive, not inf"},
    {"label_by_name", "skeletonize a.tif -o a.swc --label liver",
     "--label liver: must be a whole number from 0 on or a range, such as 3,7 or 1-85\n"},
    {"no_nested_command", "bench", "a command is required: core, server\n"},
    {"unknown_nested_command", "bench cores", "there is no command bench cores"},
    {"negative_label", "skeletonize a.tif -o a.swc --label 4,-5",
     "--label -5: must be a whole number from 0 on or a range, such as 3,7 or 1-85; skeletonize "
     "takes negative values with --range"},
    {"label_of_the_background", "labels a.tif -o a.vtp --label 0-85",
     "0 is the background; labels are counted from 1, so write 1-85"},
    {"labels_backwards", "labels a.tif -o a.vtp --label 9-3",
     "--label 9-3: the first label is above the last"},
    {"too_many_labels", "skeletonize a.tif -o a.swc --label 1-5000000000",
     "more than 1000000 labels"},
    {"negative_swc_step", "skeletonize a.off -o a.swc --swc-step -1",
     "--swc-step: must be 0 or more, and finite, not -1"},
    {"step_that_is_no_number", "skeletonize a.off -o a.swc --swc-step nan",
     "--swc-step: must be 0 or more, and finite, not nan"},
    {"time_that_is_no_number", "skeletonize a.off -o a.swc --timeout nan",
     "--timeout: must be 0.001 to 10000000, not nan"},
    {"turn_that_is_no_number", "render a.json --object a.off -o a.png --turn nan",
     "--turn: must be -360 to 360, not nan"},
    {"half_a_pass", "skeletonize a.off -o a.swc --denoise 2.5",
     "--denoise 2.5: must be a whole number"},
    {"end_of_a_range_that_would_be_rounded",
     "skeletonize a.npy -o a.swc --range 1,9007199254740993",
     "--range: cannot tell 9007199254740993 from 9007199254740992: bounds are exact up "
     "to 2^53 = 9007199254740992; --label takes larger values"},
    {"threshold_that_would_be_rounded",
     "skeletonize a.npy -o a.swc --threshold 18446744073709551615",
     "--threshold: cannot tell 18446744073709551615 from 18446744073709551616"},
    {"below_what_would_be_rounded", "skeletonize a.npy -o a.swc --below -9223372036854775807",
     "--below: cannot tell -9223372036854775807 from -9223372036854775808"},
    {"threshold_in_words", "skeletonize a.tif -o a.swc --threshold high",
     "--threshold high: must be a number"},
    {"voxels_of_two_sizes", "skeletonize a.tif -o a.swc --voxel-size 1,2",
     "--voxel-size: needs 3 numbers separated by commas, not 2"},
    {"points_given_twice", "skeletonize a.stl -o a.swc --points 1000 --points 2000",
     "--points: given 2 times, but takes one value"},
    {"voxels_without_size", "skeletonize a.tif -o a.swc --voxel-size 1,0,1",
     "--voxel-size: must be finite and positive, not 0"},
    {"negative_label_of_many", "labels a.tif -o a.vtp --labels -5",
     "--label -5: must be a whole number"},
    {"negative_voxels", "labels a.tif -o a.vtp --min-voxels -5",
     "--min-voxels -5: must be a whole number"},
    {"negative_header", "info a.raw --raw-size 9,9,9 --raw-header -5",
     "--raw-header -5: must be a whole number"},
    {"too_large_a_number", "generate ball -o a.exr --points 99999999999999999999",
     "--points 99999999999999999999: must be a whole number"},
    {"negative_seed", "generate ball -o a.exr --seed -1", "--seed -1: must be a whole number"},
    {"negative_bench", "bench core --points -9", "--points"},
    {"negative_node", "skeletonize a.off -o a.swc --root node:-3",
     "--root node -3: must be a whole number"},
    {"pruning_of_a_surface",
     "skeletonize a.off -o a.swc --kind surface --pruning length --pruning-threshold 3",
     "pruning by length, relative length or persistence: applies to curves"},
    {"pruning_of_shells", "skeletonize a.off -o a.swc --last-shell 5 --pruning-threshold 3",
     "and --last-shell stops before there are curves"},
    {"threshold_of_nothing", "labels a.tif -o a.vtp --pruning none --pruning-threshold 3",
     "not for --pruning none"},
    {"threshold_0", "skeletonize a.off -o a.swc --pruning-threshold 0",
     "--pruning-threshold: must be above 0, up to 1e9, not 0; --pruning none keeps every branch"},
    {"picture_without_object", "render a.json -o a.png", "hint: --object names the mesh"},
    {"unknown_bench", "bench core --shape sofa", "--shape sofa: must be ball"},
    {"unknown_shape", "generate teapot -o a.exr", "hollow-ball"},
};

INSTANTIATE_TEST_SUITE_P(Every, WrongCommandLineTest, testing::ValuesIn(kWrong),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace bccskel::cli
