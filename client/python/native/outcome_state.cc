#include "client/python/native/outcome_state.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <cstring>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "client/python/native/job.h"
#include "client/result_bytes.h"
#include "core/io/volume_decoder.h"
#include "core/io/volume_encoder.h"

namespace bccskel::python {
namespace {

namespace py = pybind11;

py::object VolumeState(const std::shared_ptr<const Volume>& volume) {
  if (volume == nullptr) return py::none();
  return py::bytes(Value(EncodeVolume(
      *volume, {.encoding = VolumeEncoding::kBricks, .compression = VolumeCompression::kZstd})));
}

std::shared_ptr<const Volume> VolumeOfState(const py::object& state) {
  if (state.is_none()) return nullptr;
  const auto bytes = state.cast<std::string>();
  return std::make_shared<const Volume>(
      Value(DecodeVolume(VolumeEncoding::kBricks, std::string_view(bytes))));
}

[[noreturn]] void Refuse(const char* what) {
  throw py::value_error(std::string("damaged pickle of a skeleton: ") + what);
}

template <typename Enum>
Enum EnumOf(int number, Enum last) {
  if (number < 0 || number > static_cast<int>(last)) Refuse("an unknown option");
  return static_cast<Enum>(number);
}

using RootState = std::tuple<int, WorldPoint, std::vector<uint32_t>>;

py::object StateOfRoot(const std::optional<RootChoice>& root) {
  if (!root.has_value()) return py::none();
  return py::cast(RootState(static_cast<int>(root->rule), root->point, root->nodes));
}

std::optional<RootChoice> RootOfState(const py::object& state, const SkeletonGraph& graph) {
  if (state.is_none()) return std::nullopt;
  const auto [rule, point, nodes] = state.cast<RootState>();
  RootChoice root = {EnumOf(rule, RootChoice::Rule::kNodes), point, nodes};
  if (!CheckRootChoice(root, graph).ok()) Refuse("a root that is no node");
  return root;
}

using GridState = std::tuple<int32_t, int32_t, int32_t, std::array<double, 3>,
                             std::array<double, 3>, std::array<double, 9>>;

py::object StateOfGrid(const std::optional<MaskGrid>& grid) {
  if (!grid.has_value()) return py::none();
  const Placement& placement = grid->placement;
  return py::cast(GridState(grid->nx, grid->ny, grid->nz, placement.spacing, placement.origin,
                            placement.direction));
}

std::optional<MaskGrid> GridOfState(const py::object& state) {
  if (state.is_none()) return std::nullopt;
  const auto [nx, ny, nz, spacing, origin, direction] = state.cast<GridState>();
  const MaskGrid grid = {nx, ny, nz, {spacing, origin, direction}};
  if (!CheckMaskGrid(grid).ok()) Refuse("its grid");
  return grid;
}

// Adjacency, points; of a sampling: weights, points per voxel.
using SamplingState = std::tuple<int, double>;
using MaskState = std::tuple<int, int, std::optional<SamplingState>>;

MaskState StateOfMask(const MaskOptions& mask) {
  std::optional<SamplingState> sampling;
  if (mask.sampling.has_value()) {
    sampling = {static_cast<int>(mask.sampling->weights), mask.sampling->points_per_voxel};
  }
  return {static_cast<int>(mask.adjacency), static_cast<int>(mask.points), sampling};
}

MaskOptions MaskOfState(const MaskState& state) {
  const auto& [adjacency, points, sampling] = state;
  MaskOptions mask = {.adjacency = EnumOf(adjacency, MaskAdjacency::k6),
                      .points = EnumOf(points, VoxelPoints::kSixteen)};
  if (sampling.has_value()) {
    const auto& [weights, per_voxel] = *sampling;
    mask.sampling = {EnumOf(weights, MaskWeights::kTrilinear), per_voxel};
  }
  return mask;
}

// Runs: shape (n, 4), z, y, begin, end.
using Runs = py::array_t<int32_t, py::array::c_style | py::array::forcecast>;
using LabelState =
    std::tuple<uint64_t, uint64_t, std::array<int32_t, 3>, std::array<int32_t, 3>, Runs>;

py::object StateOfLabel(const std::shared_ptr<const LabeledObject>& label) {
  if (label == nullptr) return py::none();
  static_assert(sizeof(VoxelRun) == 4 * sizeof(int32_t));
  Runs runs({static_cast<py::ssize_t>(label->runs.size()), py::ssize_t{4}});
  std::memcpy(runs.mutable_data(), label->runs.data(), static_cast<size_t>(runs.nbytes()));
  return py::cast(LabelState(label->label, label->voxels, label->box.low, label->box.high, runs));
}

bool IsIn(const VoxelRun& run, const MaskGrid& grid) {
  return run.z >= 0 && run.z < grid.nz && run.y >= 0 && run.y < grid.ny && run.begin >= 0 &&
         run.begin <= run.end && run.end <= grid.nx;
}

// Needs: the grid of the outcome.
std::shared_ptr<const LabeledObject> LabelOfState(const py::object& state,
                                                  const std::optional<MaskGrid>& grid) {
  if (state.is_none()) return nullptr;
  const auto [label, voxels, low, high, runs] = state.cast<LabelState>();
  if (runs.ndim() != 2 || runs.shape(1) != 4) {
    throw py::type_error("the runs of a label have 4 columns");
  }
  auto object = std::make_shared<LabeledObject>();
  object->label = label;
  object->voxels = voxels;
  object->box = {low, high};
  object->runs.resize(static_cast<size_t>(runs.shape(0)));
  const auto rows = runs.unchecked<2>();
  for (py::ssize_t n = 0; n < rows.shape(0); ++n) {
    const VoxelRun run = {rows(n, 0), rows(n, 1), rows(n, 2), rows(n, 3)};
    if (!grid.has_value() || !IsIn(run, *grid)) Refuse("a label outside of its image");
    object->runs[static_cast<size_t>(n)] = run;
  }
  return object;
}

using ReadState =
    std::tuple<std::string, std::string, std::vector<std::pair<std::string, std::string>>>;

py::object StateOfRead(const std::optional<view::ResultFacts>& read) {
  if (!read.has_value()) return py::none();
  return py::cast(ReadState(read->world, read->unit, read->options));
}

std::optional<view::ResultFacts> ReadOfState(const py::object& state,
                                             const SkeletonizeResult& result) {
  if (state.is_none()) return std::nullopt;
  auto [world, unit, options] = state.cast<ReadState>();
  return view::ResultFacts{.method = result.method,
                           .algorithm_version = result.algorithm_version,
                           .world = std::move(world),
                           .unit = std::move(unit),
                           .options = std::move(options),
                           .steps = result.preparing,
                           .certificate = result.certificate,
                           .object_points = result.object_points};
}

}  // namespace

py::dict StateOf(const Outcome& outcome) {
  py::dict state;
  state["result"] = py::bytes(Value(client::ToBytes(outcome.result)));
  state["sampled"] = outcome.result.certificate.sampled;  // which servers report as an option
  state["root"] = StateOfRoot(outcome.root);
  state["warnings"] = outcome.warnings;
  state["voxels"] = outcome.voxels;
  state["object"] = VolumeState(outcome.object);
  state["grid"] = StateOfGrid(outcome.grid);
  state["mask"] = StateOfMask(outcome.mask);
  state["label"] = StateOfLabel(outcome.label);
  state["read"] = StateOfRead(outcome.read);
  if (outcome.document != nullptr) state["document"] = py::bytes(*outcome.document);
  return state;
}

std::shared_ptr<Outcome> OutcomeOfState(const py::dict& state) {
  auto outcome = std::make_shared<Outcome>();
  outcome->result = Value(client::ResultFromBytes(state["result"].cast<std::string>()));
  outcome->result.certificate.sampled = state["sampled"].cast<bool>();
  outcome->root = RootOfState(state["root"], outcome->result.graph);
  outcome->warnings = state["warnings"].cast<std::vector<std::string>>();
  outcome->voxels = state["voxels"].cast<uint64_t>();
  outcome->object = VolumeOfState(state["object"]);
  outcome->grid = GridOfState(state["grid"]);
  outcome->mask = MaskOfState(state["mask"].cast<MaskState>());
  outcome->label = LabelOfState(state["label"], outcome->grid);
  outcome->read = ReadOfState(state["read"], outcome->result);
  if (outcome->read.has_value()) {
    outcome->document = std::make_shared<const std::string>(state["document"].cast<std::string>());
  }
  return outcome;
}

}  // namespace bccskel::python
