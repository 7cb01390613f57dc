#ifndef BCCSKEL_CLIENT_CLI_ARGUMENTS_H_
#define BCCSKEL_CLIENT_CLI_ARGUMENTS_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/call_options.h"
#include "client/cli/console.h"
#include "client/cli/image_options.h"
#include "client/endpoint.h"
#include "client/export/point_forest.h"
#include "client/view/render/picture.h"
#include "core/import/shapes/shapes.h"
#include "core/import/voxelize/voxelize.h"
#include "core/io/volume_header.h"
#include "core/pipeline/skeletonize.h"
#include "core/skeleton/tree_order.h"
#include "core/volume/layer_part.h"

namespace CLI {
class App;
}  // namespace CLI

namespace bccskel::cli {

// Arguments of all commands.
struct CommonArguments {
  SummaryStyle summary = SummaryStyle::kText;
  int threads = 0;  // 0: all of the machine, or the server's choice
  ProgressStyle progress = ProgressStyle::kAuto;
};

// The server and the credentials for it. Paths of files, as given.
struct ServerArguments {
  std::string address = "127.0.0.1:50051";
  std::string tls_ca;
  std::string tls_certificate;
  std::string tls_key;
  std::string token_file;  // empty: BCCSKEL_TOKEN_FILE names it
  client::Endpoint::PlaintextToken plaintext_token = client::Endpoint::PlaintextToken::kRefuse;
};

struct VoxelizeArguments {
  CommonArguments common;
  std::string input;
  std::string output;
  VoxelizeOptions grid;  // of a mesh
  ImageArguments image;
};

// Where to compute.
enum class Place { kServer, kLocal };

// Whether `submit` waits for the result, or prints the job's name and ends.
enum class Waiting { kForResult, kDetach };

// `submit` is `skeletonize` with volumes as the only input and a server as the only place.
enum class AcceptedInput { kAll, kVolumeOnly };

// The input of skeletons, how they are computed and where.
struct ComputeArguments {
  CommonArguments common;
  std::string input;
  std::vector<std::string> outputs;
  ImageArguments image;
  SkeletonizeOptions skeletonize;
  std::optional<RootChoice> root;  // where the order of trees begins
  exporting::CurveSampling swc;    // of SWC files
  Place place = Place::kServer;
  ServerArguments server;
  std::chrono::milliseconds timeout = std::chrono::hours(1);
};

struct SkeletonizeArguments : ComputeArguments {
  AcceptedInput accepted = AcceptedInput::kAll;
  VoxelizeOptions grid;  // of a mesh
  SkeletonImages images;
  Waiting waiting = Waiting::kForResult;
  client::ThinVolume thin_volume = client::ThinVolume::kOmit;  // for a detached job
  LayerPart part;  // the part of the object that this process reads
};

// The skeleton of each label of an image: those that `image` names, or all. An output with
// exporting::kLabelPlace is one file per label.
struct LabelsArguments : ComputeArguments {
  uint64_t min_voxels = 1;
};

struct InfoArguments {
  CommonArguments common;
  std::string file;
  ImageArguments image;
};

// A JSON result, the mesh, volume or image that it was made from, and the output made from both.
struct ResultArguments {
  CommonArguments common;
  std::string result;
  std::string object;
  VoxelizeOptions grid;  // of a mesh
  ImageArguments image;
  std::string output;
};

struct ViewArguments : ResultArguments {};

struct ConvertArguments {
  CommonArguments common;
  std::string result;
  std::vector<std::string> outputs;
  std::optional<RootChoice> root;
  std::optional<std::string> unit;  // instead of that of the result
  exporting::CurveSampling swc;
};

struct RenderArguments : ResultArguments {
  view::PictureOptions picture;
};

struct ReconstructArguments : ResultArguments {};

struct GenerateArguments {
  CommonArguments common;
  std::string output;
  Shape shape = Shape::kBall;
  ShapeOptions options;
};

// Jobs that a server keeps.
struct JobsArguments {
  CommonArguments common;
  ServerArguments server;
  int limit = 50;
};

struct JobArguments {
  CommonArguments common;
  ServerArguments server;
  std::string job;
};

// What happens to a job when its user stops waiting.
enum class OnInterrupt { kCancel, kLeave };

struct WaitingArguments {
  std::chrono::milliseconds timeout = std::chrono::hours(1);
  ProgressStyle progress = ProgressStyle::kAuto;
  OnInterrupt on_interrupt = OnInterrupt::kCancel;
};

struct WatchArguments {
  JobArguments job;
  WaitingArguments waiting;
};

struct CancelArguments {
  JobArguments job;
};

struct DeleteArguments {
  JobArguments job;
};

struct FetchArguments {
  JobArguments job;
  WaitingArguments waiting;
  std::vector<std::string> outputs;
  exporting::CurveSampling swc;  // of SWC files
  std::string object;            // the volume that was submitted; empty: not available
};

// Checks whether the server is ready for calls.
struct ProbeArguments {
  CommonArguments common;
  ServerArguments server;
  std::string service;  // empty: the whole server
  std::chrono::milliseconds timeout = std::chrono::seconds(5);
};

enum class TopRepeat { kForever, kOnce };

struct TopArguments {
  CommonArguments common;
  ServerArguments server;
  TopRepeat repeat = TopRepeat::kForever;
  std::chrono::milliseconds interval = std::chrono::seconds(1);
};

struct BenchServerArguments {
  CommonArguments common;
  ServerArguments server;
  std::string shape = "ball";  // one of kBenchObjects
  ThinningMethod method = ThinningMethod::kSymmetric;
  std::optional<DistanceKind> distance;  // none: as for BenchCoreArguments
  std::vector<int> clients = {1, 2, 4, 8};
  std::vector<uint64_t> points = {10'000, 850'000};
  VolumeEncoding encoding = VolumeEncoding::kRawPlanes;
  std::chrono::milliseconds duration = std::chrono::seconds(5);  // of each combination
};

struct BenchCoreArguments {
  CommonArguments common;
  std::string shape = "ball";  // one of kBenchObjects
  std::string object;          // a file, instead
  uint64_t points = 850'000;
  ThinningMethod method = ThinningMethod::kDirectional;
  std::optional<DistanceKind> distance;  // none: chamfer as in the paper, for symmetric Euclidean
  int repeat = 11;                       // warm runs
  std::string instruction_set;           // empty: the best
};

using Arguments = std::variant<VoxelizeArguments, SkeletonizeArguments, LabelsArguments,
                               InfoArguments, ViewArguments, ConvertArguments, RenderArguments,
                               ReconstructArguments, GenerateArguments, BenchCoreArguments,
                               BenchServerArguments, ProbeArguments, TopArguments, JobsArguments,
                               WatchArguments, CancelArguments, DeleteArguments, FetchArguments>;

// Each adds the options of one command, in the command's own file.
void AddVoxelize(CLI::App& command, VoxelizeArguments& arguments);
void AddSkeletonize(CLI::App& command, SkeletonizeArguments& arguments);
void AddSubmit(CLI::App& command, SkeletonizeArguments& arguments);
void AddLabels(CLI::App& command, LabelsArguments& arguments);
void AddInfo(CLI::App& command, InfoArguments& arguments);
void AddView(CLI::App& command, ViewArguments& arguments);
void AddRender(CLI::App& command, RenderArguments& arguments);
void AddConvert(CLI::App& command, ConvertArguments& arguments);
void AddReconstruct(CLI::App& command, ReconstructArguments& arguments);
void AddGenerate(CLI::App& command, GenerateArguments& arguments);
void AddBenchCore(CLI::App& command, BenchCoreArguments& arguments);
void AddBenchServer(CLI::App& command, BenchServerArguments& arguments);
void AddJobs(CLI::App& command, JobsArguments& arguments);
void AddWatch(CLI::App& command, WatchArguments& arguments);
void AddCancel(CLI::App& command, CancelArguments& arguments);
void AddDelete(CLI::App& command, DeleteArguments& arguments);
void AddFetch(CLI::App& command, FetchArguments& arguments);
void AddProbe(CLI::App& command, ProbeArguments& arguments);
void AddTop(CLI::App& command, TopArguments& arguments);

// Each runs one command, prints its output and returns the exit code.
ExitCode Run(const VoxelizeArguments& arguments, const std::stop_token& stop);
ExitCode Run(const SkeletonizeArguments& arguments, const std::stop_token& stop);
ExitCode Run(const LabelsArguments& arguments, const std::stop_token& stop);
ExitCode Run(const InfoArguments& arguments, const std::stop_token& stop);
ExitCode Run(const ViewArguments& arguments, const std::stop_token& stop);
ExitCode Run(const RenderArguments& arguments, const std::stop_token& stop);
ExitCode Run(const ConvertArguments& arguments, const std::stop_token& stop);
ExitCode Run(const ReconstructArguments& arguments, const std::stop_token& stop);
ExitCode Run(const GenerateArguments& arguments, const std::stop_token& stop);
ExitCode Run(const BenchCoreArguments& arguments, const std::stop_token& stop);
ExitCode Run(const BenchServerArguments& arguments, const std::stop_token& stop);
ExitCode Run(const JobsArguments& arguments, const std::stop_token& stop);
ExitCode Run(const WatchArguments& arguments, const std::stop_token& stop);
ExitCode Run(const CancelArguments& arguments, const std::stop_token& stop);
ExitCode Run(const DeleteArguments& arguments, const std::stop_token& stop);
ExitCode Run(const FetchArguments& arguments, const std::stop_token& stop);
ExitCode Run(const ProbeArguments& arguments, const std::stop_token& stop);
ExitCode Run(const TopArguments& arguments, const std::stop_token& stop);

// Work that several processes do together. Empty: this process or a server does it alone.
struct SharedWork {
  // Generates this process's part of the object instead of reading it; may be null.
  std::function<absl::StatusOr<Volume>(const exec::Context& context)> make;
  // Skeletonize() of all parts. Replaces the part with the whole object.
  std::function<absl::StatusOr<SkeletonizeResult>(Volume& object, const SkeletonizeOptions& options,
                                                  const exec::Context& context)>
      compute;
};
// Runs `skeletonize` as the one of several processes that writes and reports.
ExitCode RunShared(const SharedWork& work, const SkeletonizeArguments& arguments,
                   const std::stop_token& stop);
// Loads the part of the input for another of these processes. For meshes and OpenEXR files it is
// empty.
absl::StatusOr<Volume> LoadPart(const SkeletonizeArguments& arguments,
                                const exec::Context& context);

// Checks that the certificates and the token for a server can be read. Errors: as EndpointOf().
absl::Status CheckServerFiles(const Arguments& arguments);

// Checks that the command's output files can be written, before hours of work. Errors: as
// CheckWritable(), for the first that cannot.
absl::Status CheckOutputs(const Arguments& arguments);

// Checks that the arguments are consistent. Errors: INVALID_ARGUMENT.
absl::Status Validate(const Arguments& arguments);

// Parses the command line. If nothing is left to do (--help, --version, a usage error), prints the
// text and returns the exit code.
std::variant<Arguments, ExitCode> ParseArguments(int argc, const char* const* argv);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_ARGUMENTS_H_
