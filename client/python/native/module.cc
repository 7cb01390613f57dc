#include <grpc/support/log.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/synchronization/mutex.h"
#include "client/cli/option_values.h"
#include "client/python/native/array_source.h"
#include "client/python/native/compute.h"
#include "client/python/native/job.h"
#include "client/python/native/skeleton_class.h"
#include "core/exec/status_macros.h"
#include "core/import/image/gray_levels.h"
#include "core/import/image/open_image.h"
#include "core/import/mesh/mesh_file.h"
#include "core/io/volume_file.h"
#include "core/lattice/length_unit.h"
#include "core/version/version.h"

// The functions that the package's Python files call: coordinates in the order x, y, z, arrays in
// the order [z, y, x], options as texts.

namespace bccskel::python {
namespace {

namespace py = pybind11;
using Options = std::vector<std::pair<std::string, std::optional<std::string>>>;
using Server = std::shared_ptr<client::SkeletonizeClient>;
using Triple = std::array<double, 3>;

cli::OptionSet SetOf(const std::string& name) {
  if (name == "mesh") return cli::OptionSet::kMesh;
  if (name == "labels") return cli::OptionSet::kLabels;
  return name == "file" ? cli::OptionSet::kFile : cli::OptionSet::kMask;
}

std::vector<cli::NamedOption> Named(const Options& options) {
  std::vector<cli::NamedOption> named;
  for (const auto& [name, value] : options) named.push_back({name, value});
  return named;
}

// Needs: three axes and a type that ParseVoxelType() knows, in this machine's byte order.
ArrayView ViewOf(const py::array& array) {
  ArrayView view = {.data = static_cast<const std::byte*>(array.data()),
                    .type = Value(ParseVoxelType(py::str(py::object(array.dtype())))),
                    .shape = {},
                    .strides = {}};
  for (size_t axis = 0; axis < 3; ++axis) {
    view.shape[axis] = array.shape(static_cast<py::ssize_t>(axis));
    view.strides[axis] = array.strides(static_cast<py::ssize_t>(axis));
  }
  return view;
}

// The settings of a call from Python.
struct Call {
  Server server;
  int threads = 0;
  double timeout = 0;  // seconds; 0: none
  py::object progress = py::none();

  Run RunIn(Job& job) const {
    Run run = {.server = server, .threads = threads, .stop = job.stop(), .on_progress = {}};
    run.on_progress = [&job](uint64_t done, uint64_t total) { job.Report({done, total}); };
    if (timeout > 0) run.timeout = std::chrono::milliseconds(static_cast<int64_t>(1000 * timeout));
    return run;
  }
};

// Runs `compute(run)`, which returns an absl::StatusOr, as a job.
template <typename Compute>
auto RunCall(const Call& call, const Compute& compute) {
  return RunFor(call.progress, [&](Job& job) {
    const Run run = call.RunIn(job);
    return compute(run);
  });
}

std::shared_ptr<Outcome> Mask(const py::array& array, const Placement& placement,
                              const Options& options, const Call& call) {
  const auto arguments = Value(cli::ReadNamedOptions(cli::OptionSet::kMask, Named(options)));
  const ArraySource source = Value(ArraySource::Create(ViewOf(array), placement));
  return std::make_shared<Outcome>(
      RunCall(call, [&](const Run& run) { return SkeletonizeMask(source, arguments, run); }));
}

using Vertices = py::array_t<double, py::array::c_style>;
using Triangles = py::array_t<uint32_t, py::array::c_style>;

// Needs: finite vertices, indices of them.
TriangleMesh MeshOf(const Vertices& vertices, const Triangles& triangles) {
  TriangleMesh mesh;
  mesh.vertices.resize(static_cast<size_t>(vertices.shape(0)));
  mesh.triangles.resize(static_cast<size_t>(triangles.shape(0)));
  for (size_t n = 0; n < mesh.vertices.size(); ++n) {
    std::memcpy(mesh.vertices[n].data(), vertices.data(n, 0), sizeof mesh.vertices[n]);
  }
  for (size_t n = 0; n < mesh.triangles.size(); ++n) {
    std::memcpy(mesh.triangles[n].data(), triangles.data(n, 0), sizeof mesh.triangles[n]);
  }
  return mesh;
}

std::shared_ptr<Outcome> Mesh(const Vertices& vertices, const Triangles& triangles,
                              const Options& options, const Call& call) {
  const auto arguments = Value(cli::ReadNamedOptions(cli::OptionSet::kMesh, Named(options)));
  const TriangleMesh mesh = MeshOf(vertices, triangles);
  return std::make_shared<Outcome>(
      RunCall(call, [&](const Run& run) { return SkeletonizeMesh(mesh, arguments, run); }));
}

using Lattice = std::shared_ptr<Volume>;

// Options: those of a mesh.
std::shared_ptr<Outcome> LatticeSkeleton(const Lattice& lattice, const Options& options,
                                         const Call& call) {
  const auto arguments = Value(cli::ReadNamedOptions(cli::OptionSet::kMesh, Named(options)));
  return std::make_shared<Outcome>(
      RunCall(call, [&](const Run& run) { return SkeletonizeVolume(*lattice, arguments, run); }));
}

Lattice ReadLattice(const std::string& path) {
  return std::make_shared<Volume>(RunFor(py::none(), [&](Job& job) {
    exec::Context context;
    context.stop = job.stop();
    return ReadVolumeFile(path, {}, context);
  }));
}

// Shape (points, 3): x, y, z of the lattice.
py::array_t<int32_t> PointsOf(const Volume& volume) {
  py::array_t<int32_t> array({static_cast<py::ssize_t>(volume.PointCount()), py::ssize_t{3}});
  int32_t* to = array.mutable_data();
  volume.ForEachPoint([&to](LatticePoint p) {
    for (int32_t along : {p.x, p.y, p.z}) *to++ = along;
  });
  return array;
}

// Needs, for a server: a contiguous array of unsigned numbers.
LabelOutcomes Labels(const py::array& array, const Placement& placement, const Options& options,
                     const Call& call) {
  const auto arguments = Value(cli::ReadLabelsOptions(Named(options)));
  const ArraySource source = Value(ArraySource::Create(ViewOf(array), placement));
  if (call.server == nullptr) {
    return RunCall(call, [&](const Run& run) { return SkeletonizeImage(source, arguments, run); });
  }
  const ImageSize size = source.info().size;
  const client::LabelVolume image = {
      .grid = {size.nx, size.ny, size.nz, placement},
      .label_bytes = static_cast<int>(array.itemsize()),
      .voxels = {static_cast<const std::byte*>(array.data()), static_cast<size_t>(array.nbytes())}};
  return RunCall(
      call, [&](const Run& run) { return SkeletonizeOnServer(source, image, arguments, run); });
}

// Otsu's, if the values look like gray levels.
std::optional<double> GrayThreshold(const py::array& array) {
  ArraySource source = Value(ArraySource::Create(ViewOf(array), {}));
  const ImageSize size = source.info().size;
  return RunFor(py::none(), [&](Job& job) -> absl::StatusOr<std::optional<double>> {
    exec::Context context;
    context.stop = job.stop();
    GrayLevels levels(size);
    for (int32_t z = 0; z < size.nz; ++z) {
      BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
      BCCSKEL_ASSIGN_OR_RETURN(const ImageSlice slice, source.NextSlice());
      levels.Add(slice);
    }
    return levels.Threshold();
  });
}

absl::Status ReadInto(ImageSource& source, std::byte* to, const exec::Context& context) {
  for (int32_t z = 0; z < source.info().size.nz; ++z) {
    BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
    BCCSKEL_ASSIGN_OR_RETURN(const ImageSlice slice, source.NextSlice());
    std::visit(
        [&](const auto& values) {
          std::memcpy(to, values.data(), values.size_bytes());
          to += values.size_bytes();
        },
        slice.values);
  }
  return absl::OkStatus();
}

// (array [z, y, x], placement, unit, world)
py::tuple ReadImage(const std::string& path, const Options& options) {
  const auto arguments = Value(cli::ReadNamedOptions(cli::OptionSet::kFile, Named(options)));
  const auto source = Value(OpenImage(path, arguments.image.open));
  const ImageInfo& info = source->info();
  const py::array array(py::dtype(std::string(VoxelTypeName(info.type))),
                        std::vector<py::ssize_t>{info.size.nz, info.size.ny, info.size.nx});
  auto* const to = static_cast<std::byte*>(const_cast<void*>(array.data()));
  RunJob(py::none(), [&](Job& job) {
    exec::Context context;
    context.stop = job.stop();
    const absl::Status read = ReadInto(*source, to, context);
    return absl::Status(read.code(), absl::StrCat("image '", path, "': ", read.message()));
  });
  return py::make_tuple(array, info.placement, info.unit, info.world);
}

// (outcome, world, unit); the texts are empty if the document does not state them.
py::tuple ReadJson(const std::string& path) {
  const auto outcome = std::make_shared<Outcome>(
      RunFor(py::none(), [&](Job& job) { return ReadResult(path, job.stop()); }));
  const auto known = [](const std::string& text) { return text == "unknown" ? "" : text; };
  return py::make_tuple(outcome, known(outcome->read->world), known(outcome->read->unit));
}

// (vertices, triangles)
py::tuple ReadMesh(const std::string& path) {
  const TriangleMesh mesh = RunFor(py::none(), [&](Job&) { return ReadMeshFile(path); });
  const auto rows = [](size_t n) { return static_cast<py::ssize_t>(n); };
  const py::array_t<double> vertices({rows(mesh.vertices.size()), rows(3)},
                                     mesh.vertices.front().data());
  const py::array_t<uint32_t> triangles({rows(mesh.triangles.size()), rows(3)},
                                        mesh.triangles.front().data());
  return py::make_tuple(vertices, triangles);
}

// Errors: ValueError for what is no unit of length.
std::string CheckedUnit(const std::string& name) {
  if (NanometersOf(name).has_value()) return UnitNamed(name);
  throw py::value_error("unit " + name + ": must be a unit of length, such as nm, um, mm, cm or m");
}

Server ConnectTo(const client::Endpoint& endpoint) {
  return std::make_shared<client::SkeletonizeClient>(Value(client::MakeGrpcStub(endpoint)));
}

py::dict Describe(const client::Endpoint& endpoint, double timeout) {
  const std::chrono::milliseconds most(static_cast<int64_t>(1000 * timeout));
  using Description = absl::StatusOr<client::ServerDescription>;
  const auto description = RunFor(py::none(), [&](Job&) -> Description {
    BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<client::Stub> stub, client::MakeGrpcStub(endpoint));
    return client::SkeletonizeClient(std::move(stub)).Describe(most);
  });
  py::dict dict;
  dict["server_version"] = description.server_version;
  dict["algorithm_version"] = description.algorithm_version;
  return dict;
}

client::Endpoint MakeEndpoint(const std::string& address, const std::string& token,
                              const std::array<std::string, 3>& tls, bool plaintext_token) {
  client::Endpoint endpoint = {.address = address,
                               .tls = {.ca = tls[0], .certificate = tls[1], .key = tls[2]},
                               .token = token};
  if (plaintext_token) {
    endpoint.plaintext_token = client::Endpoint::PlaintextToken::kAllow;
  }
  return endpoint;
}

void AddValues(py::module_& module) {
  py::class_<Placement>(module, "Placement")
      .def(py::init(
          [](const Triple& spacing, const Triple& origin, const std::array<double, 9>& direction) {
            return Placement{spacing, origin, direction};
          }))
      .def_readonly("spacing", &Placement::spacing)
      .def_readonly("origin", &Placement::origin)
      .def_readonly("direction", &Placement::direction);
  py::class_<Volume, std::shared_ptr<Volume>>(module, "Volume")
      .def("points", &PointsOf)
      .def_property_readonly("placement", [](const Volume& v) { return v.placement(); });
  py::enum_<client::ConnectionFault>(module, "ConnectionFault")
      .value("NO_SERVER", client::ConnectionFault::kNoServer)
      .value("SERVER_HAS_NO_TLS", client::ConnectionFault::kServerHasNoTls)
      .value("NOT_TRUSTED", client::ConnectionFault::kNotTrusted)
      .value("MAY_WANT_TLS", client::ConnectionFault::kMayWantTls);
  py::class_<client::Endpoint>(module, "Endpoint").def(py::init(&MakeEndpoint));
  py::class_<client::SkeletonizeClient, Server>(module, "Server").def(py::init(&ConnectTo));
  py::class_<Call>(module, "Call")
      .def(py::init([](Server server, int threads, double timeout, py::object progress) {
        return Call{std::move(server), threads, timeout, std::move(progress)};
      }));
}

void AddFunctions(py::module_& module) {
  module.def("option_names", [](const std::string& set) { return cli::OptionNames(SetOf(set)); });
  module.def("is_flag", [](const std::string& set, const std::string& name) {
    return cli::IsFlag(SetOf(set), name);
  });
  module.def("is_mesh", [](const std::string& path) {
    return IsMeshPath(path) || (!IsImagePath(path) && BeginsLikeMesh(path));
  });
  module.def("is_image",
             [](const std::string& path) { return IsImagePath(path) || BeginsLikeImage(path); });
  module.def("skeletonize_mask", &Mask);
  module.def("skeletonize_mesh", &Mesh);
  module.def("skeletonize_labels", &Labels);
  module.def("checked_unit", &CheckedUnit);
  module.def("gray_threshold", &GrayThreshold);
  module.def("read_image", &ReadImage);
  module.def("read_mesh", &ReadMesh);
  module.def("read_result", &ReadJson);
  module.def("read_lattice", &ReadLattice);
  module.def("skeletonize_lattice", &LatticeSkeleton);
  module.def("describe_server", &Describe);
  module.def("connection_fault",
             [](const std::string& message, const std::string& address, bool tls) {
               return client::ConnectionFaultOf(
                   message, address, tls ? client::Encryption::kTls : client::Encryption::kNone);
             });
}

// gRPC logs each attempt to connect; our message says how the last one ended. Leaves a user's
// GRPC_VERBOSITY and the environment, which others read, as they are.
void SilenceGrpc() {
  constexpr int kNone = GPR_LOG_SEVERITY_ERROR + 1;
  if (std::getenv("GRPC_VERBOSITY") != nullptr) return;
  gpr_set_log_verbosity(static_cast<gpr_log_severity>(kNone));
}

}  // namespace
}  // namespace bccskel::python

PYBIND11_MODULE(_native, module) {
  // Debian's build of Abseil looks for deadlocks at every lock.
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  bccskel::python::SilenceGrpc();
  module.attr("__version__") = std::string(bccskel::Version());
  bccskel::python::AddSkeletonClass(module);
  bccskel::python::AddValues(module);
  bccskel::python::AddFunctions(module);
}
