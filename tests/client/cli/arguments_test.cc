#include "client/cli/arguments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "core/pipeline/presets.h"
#include "tests/client/cli/parsed.h"
#include "tests/support/temporary_folder.h"

namespace bccskel::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(ArgumentsTest, SkeletonizeTakesEveryKindOfDistance) {
  const auto distance = [](const char* word) {
    return Parse({"skeletonize", "a.off", "-o", "a.swc", "--distance", word})
        .as<SkeletonizeArguments>()
        .skeletonize.distance;
  };
  EXPECT_EQ(distance("chamfer"), DistanceKind::kChamfer);
  EXPECT_EQ(distance("chamfer-optimal"), DistanceKind::kChamferOptimal);
  EXPECT_EQ(distance("euclidean"), DistanceKind::kEuclidean);
}

TEST(ArgumentsTest, SkeletonizeTakesMethodsAndKinds) {
  const auto thinning = [](std::vector<const char*> words) {
    words.insert(words.begin(), {"skeletonize", "a.off", "-o", "a.swc"});
    return Parse(words).as<SkeletonizeArguments>().skeletonize.thinning;
  };
  EXPECT_EQ(thinning({}).method, ThinningMethod::kSymmetric);
  EXPECT_EQ(thinning({"--method", "directional"}).method, ThinningMethod::kDirectional);
  EXPECT_EQ(thinning({"--method", "directional-alternating"}).method,
            ThinningMethod::kDirectionalAlternating);
  const ThinningOptions surface = thinning({"--method", "symmetric", "--kind", "surface"});
  EXPECT_EQ(surface.method, ThinningMethod::kSymmetric);
  EXPECT_EQ(surface.kind, SkeletonKind::kSurface);
  EXPECT_EQ(thinning({"--method", "symmetric", "--kind", "kernel"}).kind, SkeletonKind::kKernel);
  EXPECT_EQ(thinning({"--method", "symmetric", "--kind", "isthmus-curve"}).kind,
            SkeletonKind::kIsthmusCurve);
}

TEST(ArgumentsTest, RefusesAKindThatTheMethodDoesNotGive) {
  const Parsed parsed = Parse("skeletonize a.off -o a.swc --method directional --kind surface");
  EXPECT_EQ(parsed.code(), ExitCode::kUsage);
  EXPECT_THAT(parsed.err, HasSubstr("symmetric"));
}

TEST(ArgumentsTest, SkeletonizeAndLabelsTakePreparing) {
  const PreparingOptions expected = {.denoise_passes = 2,
                                     .cavities = CavityFilling::kOn,
                                     .join_gaps = 0.5,
                                     .min_component_points = 30,
                                     .min_component_volume = 1.5,
                                     .components = KeptComponents::kLargest,
                                     .tunnel_width = 2.5};
  const std::vector<const char*> options = {
      "--denoise",       "2",  "--fill-cavities",        "--cut-loops", "2.5",
      "--min-component", "30", "--min-component-volume", "1.5",         "--keep-largest",
      "--join-gaps",     "0.5"};
  const auto with = [&](std::vector<const char*> words) {
    words.insert(words.end(), options.begin(), options.end());
    return Parse(words);
  };
  EXPECT_EQ(with({"skeletonize", "a.off", "-o", "a.swc"})
                .as<SkeletonizeArguments>()
                .skeletonize.preparing,
            expected);
  EXPECT_EQ(with({"labels", "a.tif", "-o", "a.vtp"}).as<LabelsArguments>().skeletonize.preparing,
            expected);
}

TEST(ArgumentsTest, OptionsOverruleTheirPresetWhereverTheyStand) {
  const auto skeletonize = [](std::vector<const char*> words) {
    words.insert(words.begin(), {"skeletonize", "a.off", "-o", "a.swc"});
    return Parse(words).as<SkeletonizeArguments>().skeletonize;
  };
  SkeletonizeOptions neuron;
  ASSERT_TRUE(ApplyPreset("neuron", neuron).ok());
  EXPECT_EQ(skeletonize({"--preset", "neuron"}).preparing, neuron.preparing);
  neuron.preparing.min_component_points = 7;
  neuron.preparing.component_size = ComponentSize::kPoints;
  EXPECT_EQ(skeletonize({"--preset", "neuron", "--min-component", "7"}).preparing,
            neuron.preparing);
  EXPECT_EQ(skeletonize({"--min-component", "7", "--preset", "neuron"}).preparing,
            neuron.preparing);
  for (const char* width : {"0", "2.5"}) {
    const PreparingOptions cut =
        skeletonize({"--cut-loops", width, "--preset", "neuron"}).preparing;
    EXPECT_EQ(cut.tunnel_width, std::stod(width));
    EXPECT_EQ(cut.tunnel_cells, 0);
  }
  const PreparingOptions without =
      skeletonize({"--preset", "airway", "--fill-cavities=false", "--keep-largest=false"})
          .preparing;
  EXPECT_EQ(without.cavities, CavityFilling::kOff);
  EXPECT_EQ(without.components, KeptComponents::kAll);
  EXPECT_GT(without.tunnel_cells, 0);
  EXPECT_EQ(skeletonize({"--preset", "cad", "--pruning-threshold", "3"}).pruning.threshold, 3);
  const Parsed unknown = Parse("skeletonize a.off -o a.swc --preset cat");
  for (const char* other : {"--pruning=relative-length", "--kind=surface"}) {
    EXPECT_EQ(skeletonize({"--preset", "cad", other}).pruning.threshold, 0) << "not a significance";
    EXPECT_EQ(skeletonize({other, "--pruning-threshold", "3", "--preset", "cad"}).pruning.threshold,
              3);
  }
  EXPECT_EQ(unknown.code(), ExitCode::kUsage);
  EXPECT_THAT(unknown.err, HasSubstr("--preset cat: must be one of neuron, vessels"));
}

TEST(ArgumentsTest, TakesARoot) {
  const auto root = [](const char* text) {
    return Parse({"skeletonize", "a.off", "-o", "a.swc", "--root", text})
        .as<SkeletonizeArguments>()
        .root;
  };
  EXPECT_EQ(root("thickest-end"), RootChoice());
  EXPECT_EQ(root("thickest-node"), RootChoice{RootChoice::Rule::kDeepestNode});
  EXPECT_EQ(root("-1.5,2e1,3"),
            (RootChoice{.rule = RootChoice::Rule::kNearestNode, .point = {-1.5, 20, 3}}));
  EXPECT_EQ(root("node:12"), (RootChoice{.rule = RootChoice::Rule::kNodes, .nodes = {12}}));
  EXPECT_EQ(Parse("skeletonize a.off -o a.swc").as<SkeletonizeArguments>().root, std::nullopt);
}

TEST(ArgumentsTest, SkeletonizeTakesPruning) {
  const Parsed parsed = Parse(
      "skeletonize a.off -o a.swc --pruning relative-length --pruning-threshold 1.5 --tips "
      "as-thinned");
  const PruningOptions expected = {PruningRule::kRelativeLength, 1.5, TipPlacement::kAsThinned};
  EXPECT_EQ(parsed.as<SkeletonizeArguments>().skeletonize.pruning, expected);
  const Parsed no_length = Parse("skeletonize a.off -o a.swc --pruning length");
  EXPECT_THAT(no_length.err, HasSubstr("needs --pruning-threshold"));
}

TEST(ArgumentsTest, SkeletonizeTakesTheReachOfJunctions) {
  const auto parsed = [](const char* kind, const char* reach) {
    return Parse({"skeletonize", "a", "-o", "a.vtp", "--kind", kind, "--merge-junctions", reach});
  };
  EXPECT_EQ(parsed("curve", "0").as<SkeletonizeArguments>().skeletonize.junction_reach, 0);
  EXPECT_THAT(parsed("curve", "5").err, HasSubstr("--merge-junctions: must be 0 to 4, not 5"));
  EXPECT_THAT(parsed("surface", "1").err, HasSubstr("--merge-junctions is for graphs of curves"));
}

TEST(ArgumentsTest, SkeletonizeTakesPersistenceWithIsthmusesAlone) {
  const Parsed parsed =
      Parse("skeletonize a.off -o a.swc --kind isthmus-curve --pruning persistence");
  EXPECT_EQ(parsed.as<SkeletonizeArguments>().skeletonize.pruning.rule, PruningRule::kPersistence);
  const Parsed curve = Parse("skeletonize a.off -o a.swc --pruning persistence");
  EXPECT_THAT(curve.err, HasSubstr("isthmus-curve"));
}

TEST(ArgumentsTest, SkeletonizeTakesAllItsOptions) {
  const Parsed parsed = Parse(
      "skeletonize a.off -o a.swc --output a.vtp --spacing 0.5 --fill winding --local --stubble "
      "literal --shell-width 2 --last-shell 9 --no-cleanup --threads 3 --progress always --timeout "
      "1.5 --json");
  const auto& arguments = parsed.as<SkeletonizeArguments>();
  EXPECT_EQ(arguments.input, "a.off");
  EXPECT_THAT(arguments.outputs, ElementsAre("a.swc", "a.vtp"));
  EXPECT_EQ(arguments.grid.spacing, 0.5);
  EXPECT_EQ(arguments.grid.fill, FillRule::kWinding);
  EXPECT_EQ(arguments.place, Place::kLocal);
  EXPECT_EQ(arguments.skeletonize.thinning.stubble, StubblePolicy::kLiteral);
  EXPECT_EQ(arguments.skeletonize.thinning.shell_width, 2);
  EXPECT_EQ(arguments.skeletonize.thinning.last_shell, 9);
  EXPECT_EQ(arguments.skeletonize.thinning.cleanup, ThinnessCleanup::kOff);
  EXPECT_EQ(arguments.common.threads, 3);
  EXPECT_EQ(arguments.common.progress, ProgressStyle::kAlways);
  EXPECT_EQ(arguments.timeout, std::chrono::milliseconds(1500));
  EXPECT_EQ(arguments.common.summary, SummaryStyle::kJson);
}

TEST(ArgumentsTest, NamingAServerOrWhatOpensOneComputesThere) {
  for (const std::vector<const char*>& words : std::vector<std::vector<const char*>>{
           {"--server", "unix:/x"}, {"--token-file", "t"}, {"--tls-ca", "c"}}) {
    std::vector<const char*> all = {"skeletonize", "a.off", "-o", "a.swc"};
    all.insert(all.end(), words.begin(), words.end());
    EXPECT_EQ(Parse(all).as<SkeletonizeArguments>().place, Place::kServer) << words.front();
  }
  EXPECT_EQ(Parse("submit a.exr -o a.swc").as<SkeletonizeArguments>().place, Place::kServer);
}

TEST(ArgumentsTest, CountsMayBeShort) {
  const auto points = [](const char* word) {
    return Parse({"voxelize", "a.off", "-o", "a.exr", "--points", word})
        .as<VoxelizeArguments>()
        .grid.points;
  };
  EXPECT_EQ(points("850k"), 850'000);
  EXPECT_EQ(points("4M"), 4'000'000);
  EXPECT_EQ(points("1e6"), 1'000'000);
  EXPECT_EQ(points("1.5e+6"), 1'500'000);
  EXPECT_EQ(points("2.25G"), 2'250'000'000);
  EXPECT_EQ(points("8589934592"), 8'589'934'592);
  for (const char* wrong :
       {"1.5", "1e", "k", "1.k", "1e-6", "1e20", "4Mk", "0x10", "1.2345k", " 1"}) {
    const Parsed parsed = Parse({"voxelize", "a.off", "-o", "a.exr", "--points", wrong});
    EXPECT_EQ(parsed.code(), ExitCode::kUsage) << wrong;
    EXPECT_THAT(parsed.err, HasSubstr("850k")) << wrong;
  }
}

TEST(ArgumentsTest, CountsOfBenchmarksMayBeShort) {
  EXPECT_EQ(Parse("bench core --points 1e6").as<BenchCoreArguments>().points, 1'000'000);
  const auto server = Parse("bench server --points 10k,2M").as<BenchServerArguments>();
  EXPECT_THAT(server.points, ElementsAre(10'000, 2'000'000));
  EXPECT_THAT(Parse("bench core --points 4k").err, HasSubstr("from 5000 to"));
}

TEST(ArgumentsTest, LabelsMayBeRanges) {
  const auto arguments = Parse("labels a.tif -o a.vtp --label 3-5,9").as<LabelsArguments>();
  EXPECT_THAT(arguments.image.labels, ElementsAre(3, 4, 5, 9));
}

TEST(ArgumentsTest, SwcTakesAStep) {
  const auto step = [](std::vector<const char*> words) {
    words.insert(words.begin(), {"skeletonize", "a.off", "-o", "a.swc"});
    return Parse(words).as<SkeletonizeArguments>().swc.step;
  };
  EXPECT_EQ(step({}), std::nullopt);
  EXPECT_EQ(step({"--swc-step", "0"}), 0);
  EXPECT_EQ(step({"--swc-step", "2.5"}), 2.5);
}

TEST(ArgumentsTest, VoxelsHaveOneSizeOrThree) {
  const auto spacing = [](const char* size) {
    return Parse({"skeletonize", "--voxel-size", size, "a.tif", "-o", "a.swc"})
        .as<SkeletonizeArguments>()
        .image.open.spacing;
  };
  EXPECT_EQ(spacing("0.5"), (std::array{0.5, 0.5, 0.5}));
  EXPECT_EQ(spacing("1,2,2.5e-9"), (std::array{1.0, 2.0, 2.5e-9}));
}

TEST(ArgumentsTest, OutputsMayHaveCommasInTheirNames) {
  const Parsed parsed = Parse("skeletonize a.off -o a,b.swc -o ,.vtp");
  EXPECT_THAT(parsed.as<SkeletonizeArguments>().outputs, ElementsAre("a,b.swc", ",.vtp"));
  EXPECT_THAT(Parse({"convert", "a.json", "-o", "a.swc, b.csv"}).err,
              HasSubstr("write -o a.swc -o b.csv\n"));
}

TEST(ArgumentsTest, ErrorsNameTheHelpThatHelps) {
  EXPECT_EQ(Parse("bench core --thread 2").err,
            "bccskel: error: core has no option --thread; did you mean --threads?\n"
            "bccskel: hint: see bccskel bench core --help\n");
  EXPECT_EQ(
      Parse("view").err,
      "bccskel: error: RESULT and --output are required\nbccskel: hint: see bccskel view --help\n");
  EXPECT_EQ(Parse("dance").err,
            "bccskel: error: there is no command dance\nbccskel: hint: see bccskel --help\n");
  EXPECT_EQ(Parse("info a.nrrd --label 1 --threshold 3").err,
            "bccskel: error: --label and --threshold exclude each other\n");
}

TEST(ArgumentsTest, DefaultsSuitAUserOfThisMachine) {
  const Parsed parsed = Parse("skeletonize a.off -o a.swc");
  const auto& arguments = parsed.as<SkeletonizeArguments>();
  EXPECT_EQ(arguments.place, Place::kLocal);
  EXPECT_EQ(arguments.server.address, "127.0.0.1:50051");
  EXPECT_EQ(arguments.timeout, std::chrono::hours(1));
  EXPECT_EQ(arguments.common.threads, 0);
  EXPECT_EQ(arguments.common.summary, SummaryStyle::kText);
  EXPECT_EQ(arguments.common.progress, ProgressStyle::kAuto);
  EXPECT_EQ(arguments.grid.points, std::nullopt);
}

TEST(ArgumentsTest, OtherCommandsTakeTheirs) {
  EXPECT_EQ(Parse("voxelize a.off -o a.exr --points 9").as<VoxelizeArguments>().grid.points, 9);
  const Parsed submit = Parse("submit a.exr -o a.swc --server unix:/s");
  EXPECT_EQ(submit.as<SkeletonizeArguments>().accepted, AcceptedInput::kVolumeOnly);
  EXPECT_EQ(submit.as<SkeletonizeArguments>().server.address, "unix:/s");
  EXPECT_EQ(Parse("info a.off").as<InfoArguments>().file, "a.off");
  const Parsed generate = Parse("generate knot -o a.bccb --seed 4 --noise 0.01 --points 10000");
  EXPECT_EQ(generate.as<GenerateArguments>().shape, Shape::kKnot);
  EXPECT_EQ(generate.as<GenerateArguments>().options.seed, 4);
}

TEST(ArgumentsTest, TakesNoPruningWhereNothingIsPruned) {
  const Parsed parsed = Parse("skeletonize a.off -o a.swc --kind surface --pruning none");
  EXPECT_EQ(parsed.as<SkeletonizeArguments>().skeletonize.pruning.rule, PruningRule::kNone);
}

TEST(ArgumentsTest, LabelsAreComputedHereWhetherThatIsAskedForOrNot) {
  EXPECT_EQ(Parse("labels a.tif -o a.vtp --local").as<LabelsArguments>().input, "a.tif");
}

TEST(ArgumentsTest, BenchCoreTakesADistance) {
  EXPECT_EQ(Parse("bench core").as<BenchCoreArguments>().distance, std::nullopt);
  EXPECT_EQ(Parse("bench core --distance chamfer").as<BenchCoreArguments>().distance,
            DistanceKind::kChamfer);
}

TEST(ArgumentsTest, HelpAndVersionGoToStandardOutput) {
  for (const char* command : {"voxelize", "submit", "skeletonize", "info", "generate"}) {
    const Parsed parsed = Parse({command, "--help"});
    EXPECT_EQ(parsed.code(), ExitCode::kOk);
    EXPECT_THAT(parsed.out, HasSubstr("Exit codes: 0 success"));
    EXPECT_EQ(parsed.err, "");
  }
  EXPECT_THAT(Parse("--version").out, testing::MatchesRegex("bccskel [0-9]+\\.[0-9]+.*\n"));
}

TEST(ArgumentsTest, HelpIsACommand) {
  const std::vector<std::vector<const char*>> commands = {{}, {"info"}, {"bench", "core"}};
  for (std::vector<const char*> words : commands) {
    std::vector<const char*> after = words;
    after.push_back("--help");
    words.insert(words.begin(), "help");
    const Parsed parsed = Parse(words);
    EXPECT_EQ(parsed.code(), ExitCode::kOk);
    EXPECT_EQ(parsed.err, "");
    EXPECT_EQ(parsed.out, Parse(after).out);
  }
}

TEST(ArgumentsTest, HelpNamesTheWordsAnOptionTakes) {
  const std::string help = Parse("skeletonize --help").out;
  EXPECT_THAT(help, HasSubstr("--stubble keep-two|literal|none"));
  EXPECT_THAT(help, HasSubstr("--fill auto|parity|winding"));
  EXPECT_THAT(help, HasSubstr("--progress auto|always|never"));
}

TEST(ArgumentsTest, EndingsMayBeInCapitals) {
  for (const char* line :
       {"view a.json -o a.HTML", "render a.json -o a.PNG", "render a.json -o a.Svg",
        "reconstruct a.json --object a.off -o a.EXR", "generate ball -o a.BCCB",
        "skeletonize a.tif -o a.SWC --branch-image a.NRRD"}) {
    const Parsed parsed = Parse(line);
    EXPECT_TRUE(std::holds_alternative<Arguments>(parsed.arguments)) << line << ": " << parsed.err;
  }
}

TEST(ArgumentsTest, TheInputIsNotOverwritten) {
  const test::TemporaryFolder folder;
  const std::string volume = folder / "a.exr", other = folder / "./a.exr";
  std::ofstream(volume) << "bytes";
  for (const char* command : {"submit", "skeletonize"}) {
    const Parsed parsed = Parse({command, volume.c_str(), "-o", other.c_str()});
    EXPECT_EQ(parsed.code(), ExitCode::kUsage);
    EXPECT_THAT(parsed.err, HasSubstr("would be overwritten"));
  }
}

TEST(ArgumentsTest, EveryCommandWithAServerTakesWhatLetsTheUserIn) {
  const std::vector<const char*> options = {
      "--server",  "host:1",     "--tls-ca",     "ca.pem", "--tls-cert",       "me.pem",
      "--tls-key", "me-key.pem", "--token-file", "token",  "--plaintext-token"};
  const auto server_of = [&](std::vector<const char*> words, auto server) {
    words.insert(words.end(), options.begin(), options.end());
    return server(Parse(words));
  };
  const std::vector<ServerArguments> all = {
      server_of({"submit", "a.exr", "-o", "a.swc"},
                [](const Parsed& parsed) { return parsed.as<SkeletonizeArguments>().server; }),
      server_of({"probe"}, [](const Parsed& parsed) { return parsed.as<ProbeArguments>().server; }),
      server_of({"top"}, [](const Parsed& parsed) { return parsed.as<TopArguments>().server; }),
      server_of({"bench", "server"},
                [](const Parsed& parsed) { return parsed.as<BenchServerArguments>().server; })};
  for (const ServerArguments& server : all) {
    EXPECT_EQ(server.address, "host:1");
    EXPECT_EQ(server.tls_ca, "ca.pem");
    EXPECT_EQ(server.tls_certificate, "me.pem");
    EXPECT_EQ(server.tls_key, "me-key.pem");
    EXPECT_EQ(server.token_file, "token");
    EXPECT_EQ(server.plaintext_token, client::Endpoint::PlaintextToken::kAllow);
  }
}

TEST(ArgumentsTest, BenchServerTakesListsAndRefusesWhatIsOutOfBounds) {
  const Parsed parsed =
      Parse("bench server --clients 1,8 --points 5000,90000 --encoding bricks --seconds 0.5");
  const auto& arguments = parsed.as<BenchServerArguments>();
  EXPECT_THAT(arguments.clients, ElementsAre(1, 8));
  EXPECT_THAT(arguments.points, ElementsAre(5000u, 90000u));
  EXPECT_EQ(arguments.encoding, VolumeEncoding::kBricks);
  EXPECT_EQ(arguments.duration, std::chrono::milliseconds(500));
  EXPECT_EQ(arguments.shape, "ball");
  EXPECT_EQ(arguments.method, ThinningMethod::kSymmetric);
  const auto chosen =
      Parse("bench server --shape horse --method directional").as<BenchServerArguments>();
  EXPECT_EQ(chosen.shape, "horse");
  EXPECT_EQ(chosen.method, ThinningMethod::kDirectional);
  EXPECT_FALSE(chosen.distance.has_value());
  for (const char* clients : {"0", "1025", "many"}) {
    EXPECT_EQ(Parse({"bench", "server", "--clients", clients}).code(), ExitCode::kUsage);
  }
}

}  // namespace
}  // namespace bccskel::cli
