#include "client/python/native/skeleton_class.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "client/cli/console.h"
#include "client/cli/file_writers.h"
#include "client/cli/option_values.h"
#include "client/export/atomic_file.h"
#include "client/export/label_paths.h"
#include "client/export/labeled_graph.h"
#include "client/export/method_facts.h"
#include "client/export/picture/caption.h"
#include "client/export/skeleton_file.h"
#include "client/python/native/compute.h"
#include "client/python/native/edge_images.h"
#include "client/python/native/job.h"
#include "client/python/native/outcome_state.h"
#include "client/view/render/subject_picture.h"
#include "core/certificate/describe_changes.h"
#include "core/exec/status_macros.h"
#include "core/pipeline/notes.h"
#include "core/pipeline/option_words.h"
#include "core/skeleton/node_kind_name.h"
#include "core/skeleton/skeleton_figures.h"

namespace bccskel::python {
namespace {

namespace py = pybind11;

py::array_t<double> PointsArray(const std::vector<WorldPoint>& points) {
  const auto rows = static_cast<py::ssize_t>(points.size());
  return py::array_t<double>({rows, py::ssize_t{3}}, rows == 0 ? nullptr : points.front().data());
}

template <typename T>
py::array_t<T> Array(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

template <typename Items, typename Of>
auto ArrayOf(const Items& items, Of of) {
  std::vector<std::decay_t<decltype(of(items.front()))>> values;
  values.reserve(items.size());
  for (const auto& item : items) values.push_back(of(item));
  return Array(values);
}

py::dict NodesOf(const SkeletonGraph& graph) {
  std::vector<WorldPoint> positions;
  py::list kinds;
  for (const SkeletonNode& node : graph.nodes) {
    positions.push_back(graph.PositionOf(node.at));
    kinds.append(py::str(std::string(NodeKindName(node.kind))));
  }
  py::dict nodes;
  nodes["positions"] = PointsArray(positions);
  nodes["kinds"] = kinds;
  nodes["radii"] = ArrayOf(graph.nodes, [&](const auto& node) { return graph.RadiusOf(node.at); });
  nodes["components"] =
      ArrayOf(ComponentsOf(graph).of_node, [](uint32_t n) { return static_cast<int64_t>(n); });
  return nodes;
}

py::dict FiguresDict(const SkeletonGraph& graph, const std::vector<EdgeFigures>& figures) {
  py::dict dict;
  dict["length"] = ArrayOf(figures, [](const auto& f) { return f.length; });
  dict["tortuosity"] = ArrayOf(figures, [](const auto& f) {
    return f.tortuosity.value_or(std::numeric_limits<double>::quiet_NaN());
  });
  dict["mean_radius"] = ArrayOf(figures, [](const auto& f) { return f.mean_radius; });
  dict["min_radius"] = ArrayOf(figures, [](const auto& f) { return f.min_radius; });
  dict["max_radius"] = ArrayOf(figures, [](const auto& f) { return f.max_radius; });
  dict["pruning_level"] =
      ArrayOf(graph.edges, [](const SkeletonEdge& edge) { return edge.pruning_level; });
  return dict;
}

// All edges: their ends, and their curves and radii concatenated, split at `offsets`.
py::dict EdgesOf(const SkeletonGraph& graph) {
  std::vector<WorldPoint> points;
  std::vector<double> radii;
  std::vector<int64_t> offsets = {0};
  std::vector<EdgeFigures> figures;
  std::vector<int64_t> ends;
  for (const SkeletonEdge& edge : graph.edges) {
    const std::vector<WorldPoint> curve = SmoothCurve(graph, edge);
    points.insert(points.end(), curve.begin(), curve.end());
    for (const SkeletonPoint& p : graph.PointsOf(edge)) radii.push_back(graph.RadiusOf(p));
    offsets.push_back(static_cast<int64_t>(points.size()));
    figures.push_back(FiguresOf(graph, edge, curve));
    ends.insert(ends.end(), {edge.source, edge.target});
  }
  py::dict edges;
  edges["ends"] = Array(ends).reshape({py::ssize_t{-1}, py::ssize_t{2}});
  edges["points"] = PointsArray(points);
  edges["radii"] = Array(radii);
  edges["offsets"] = Array(offsets);
  edges["figures"] = FiguresDict(graph, figures);
  return edges;
}

// Points on no edge.
py::dict SheetsOf(const SkeletonGraph& graph) {
  std::vector<WorldPoint> points;
  for (const SkeletonPoint& p : graph.sheets) points.push_back(graph.PositionOf(p));
  py::dict sheets;
  sheets["points"] = PointsArray(points);
  sheets["radii"] = ArrayOf(graph.sheets, [&](const auto& p) { return graph.RadiusOf(p); });
  return sheets;
}

py::dict BettiDict(const BettiNumbers& betti) {
  py::dict dict;
  dict["components"] = betti.components;
  dict["loops"] = betti.loops;
  dict["cavities"] = betti.cavities;
  return dict;
}

// As in a JSON result, and whether the topology was kept.
py::dict CertificateDict(const Certificate& certificate) {
  py::dict dict;
  dict["topology_kept"] = certificate.TopologyKept() && certificate.MaskKept();
  if (certificate.mask.has_value()) dict["mask"] = BettiDict(*certificate.mask);
  if (certificate.unprepared.has_value()) dict["unprepared"] = BettiDict(*certificate.unprepared);
  dict["input"] = BettiDict(certificate.input);
  dict["skeleton"] = BettiDict(certificate.skeleton);
  dict["sampled"] = certificate.sampled;
  dict["simple_points_left"] = certificate.simple_points_left;
  return dict;
}

// A number if the whole text is one, else the text.
py::object NumberOrText(const std::string& text) {
  double number = 0;
  if (absl::SimpleAtod(text, &number)) return py::float_(number);
  return py::str(text);
}

py::dict OptionsDict(const Outcome& outcome) {
  py::dict dict;
  if (outcome.read.has_value()) {
    for (const auto& [name, value] : outcome.read->options) {
      dict[py::str(name)] = NumberOrText(value);
    }
    return dict;
  }
  for (const OptionFact& fact : FactsOf(outcome.result.options)) {
    const bool number = fact.type == OptionFact::Type::kNumber;
    dict[fact.name] =
        number ? py::object(py::float_(py::str(fact.value))) : py::object(py::str(fact.value));
  }
  return dict;
}

// Seconds.
py::dict TimingsDict(const StageTimings& timings) {
  const auto seconds = [](StageTimings::Duration time) {
    return std::chrono::duration<double>(time).count();
  };
  py::dict dict;
  for (const Stage& stage : kStages) dict[stage.name] = seconds(timings.*stage.time);
  dict["total"] = seconds(timings.total);
  return dict;
}

std::vector<std::string> WithOptionNames(std::vector<std::string> messages) {
  for (std::string& message : messages) message = cli::WithOptionNames(message);
  return messages;
}

// The positions in the trees; None if none were requested.
py::object OrderOf(const Outcome& outcome) {
  const auto trees = exporting::OrderOf(outcome.result.graph, outcome.root);
  if (!trees.has_value()) return py::none();
  const TreeOrder& order = *trees;
  const auto number = [](uint32_t n) { return n == kNoRow ? int64_t{-1} : int64_t{n}; };
  py::dict dict;
  dict["roots"] = ArrayOf(order.roots, number);
  dict["parent"] = ArrayOf(order.nodes, [&](const NodeOrder& n) { return number(n.parent); });
  dict["root_distance"] = ArrayOf(order.nodes, [](const NodeOrder& n) { return n.root_distance; });
  dict["proximal"] = ArrayOf(order.edges, [&](const EdgeOrder& e) { return number(e.proximal); });
  const auto of_tree = [&order](uint32_t EdgeOrder::*figure) {
    return ArrayOf(order.edges, [figure](const EdgeOrder& e) {
      return e.proximal == kNoRow ? std::numeric_limits<double>::quiet_NaN() : e.*figure;
    });
  };
  dict["generation"] = of_tree(&EdgeOrder::generation);
  dict["strahler"] = of_tree(&EdgeOrder::strahler);
  return dict;
}

// What a file states besides the skeleton.
struct Saying {
  std::string title;
  exporting::World world;
  exporting::CurveSampling swc;
};

using exporting::SkeletonFormat;

// As `bccskel convert`.
absl::StatusOr<std::string> SaveRead(const Outcome& outcome, const std::string& path,
                                     const Saying& saying, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const SkeletonFormat format, exporting::SkeletonFormatOf(path));
  if (format == SkeletonFormat::kVolume) {
    return absl::InvalidArgumentError(
        "a result that was read has no lattice points; compute it again with skeletonize()");
  }
  if (format == SkeletonFormat::kJson || exporting::ShowsObject(format)) {
    BCCSKEL_ASSIGN_OR_RETURN(const view::ResultDocument document,
                             view::ParseResultDocument(*outcome.document, context.stop));
    BCCSKEL_ASSIGN_OR_RETURN(const std::string text,
                             view::ComposeDocument(format, saying.title, document, context));
    BCCSKEL_RETURN_IF_ERROR(exporting::WriteFileAtomically(path, text, context.stop));
    return std::string();
  }
  return exporting::WriteGraphFile(
      path,
      {.graph = outcome.result.graph,
       .context = {.labels = {},
                   .facts = exporting::MethodFactsOf(*outcome.read),
                   .order = exporting::OrderOf(outcome.result.graph, outcome.root, context.stop),
                   .exec = context},
       .world = saying.world,
       .swc = saying.swc});
}

absl::StatusOr<std::string> SaveIn(const Outcome& outcome, const std::string& path,
                                   const Saying& saying, const std::stop_token& stop) {
  BCCSKEL_ASSIGN_OR_RETURN(const SkeletonFormat format, exporting::SkeletonFormatOf(path));
  if (format == SkeletonFormat::kVolume && outcome.result.thin.PointCount() == 0 &&
      outcome.result.skeleton_points > 0) {
    return absl::UnimplementedError("servers do not send the lattice points of labels");
  }
  const bool many = outcome.result.graph.points.size() > 50'000;  // else threads start too slowly
  cli::LocalTeam team(many || exporting::ShowsObject(format) ? 0 : 1, stop);
  if (outcome.read.has_value()) return SaveRead(outcome, path, saying, team.context());
  auto object = std::make_shared<const Volume>();
  if (exporting::ShowsObject(format)) {
    BCCSKEL_ASSIGN_OR_RETURN(object, outcome.Object());
  }
  const exporting::Subject subject = {.result = outcome.result,
                                      .object = *object,
                                      .title = saying.title,
                                      .context = team.context(),
                                      .root = outcome.root,
                                      .world = saying.world,
                                      .swc = saying.swc,
                                      .draw = view::DrawSubject};
  return exporting::WriteSkeletonFile(path, subject);
}

// What the format could not hold; empty if it held everything.
std::string Save(const Outcome& outcome, const std::string& path, const std::string& title,
                 const std::string& world, const std::string& unit,
                 const std::optional<double>& swc_step) {
  if (swc_step.has_value() && !(*swc_step >= 0)) {
    throw py::value_error(absl::StrCat("swc_step ", *swc_step, ": must be 0 or more"));
  }
  const Saying saying = {title, {world, unit}, {.step = swc_step}};
  return RunFor(py::none(), [&](Job& job) { return SaveIn(outcome, path, saying, job.stop()); });
}

// Shape: [z, y, x] of the mask's grid.
py::array_t<uint32_t> Draw(const Outcome& outcome, EdgeImage kind) {
  const SparseImage image = RunFor(py::none(), [&](Job& job) {
    cli::LocalTeam team(0, job.stop());
    return ImageOf(outcome, kind, team.context());
  });
  py::array_t<uint32_t> array({outcome.grid->nz, outcome.grid->ny, outcome.grid->nx});
  std::fill_n(array.mutable_data(), array.size(), 0);
  for (const auto& [voxels, value] : image) {
    std::fill(array.mutable_data(voxels.z, voxels.y, voxels.begin),
              array.mutable_data(voxels.z, voxels.y, 0) + voxels.end, value);
  }
  return array;
}

// Shape (nodes, 3): x, y, z. Needs: a grid.
py::array_t<int64_t> NodeVoxelsOf(const Outcome& outcome) {
  const auto voxels = RunFor(py::none(), [&](Job& job) {
    cli::LocalTeam team(1, job.stop());
    return VoxelsOfNodes(outcome, team.context());
  });
  py::array_t<int64_t> array({static_cast<py::ssize_t>(voxels.size()), py::ssize_t{3}});
  int64_t* to = array.mutable_data();
  for (const auto& voxel : voxels) to = std::ranges::copy(voxel, to).out;
  return array;
}

using LabelList = std::vector<std::pair<uint64_t, std::shared_ptr<Outcome>>>;

absl::Status WriteEachLabel(const std::string& path, const LabelList& labels,
                            const exporting::World& world, const std::stop_token& stop) {
  // Each picture is drawn by all threads.
  cli::FileWriters writers(exporting::ShowsObject(path) ? 1 : cli::FileWriters::kMostWriters);
  for (const auto& [label, outcome] : labels) {
    const auto write = [&, label = label, outcome = outcome]() -> absl::Status {
      BCCSKEL_ASSIGN_OR_RETURN(const std::string own, exporting::MakePathFor(path, label));
      return SaveIn(*outcome, own, {absl::StrCat("label ", label), world, {}}, stop).status();
    };
    BCCSKEL_RETURN_IF_ERROR(writers.Add(write));
  }
  return writers.Finish();
}

absl::StatusOr<std::string> WriteLabels(const std::string& path, const LabelList& labels,
                                        const exporting::World& world,
                                        const std::stop_token& stop) {
  BCCSKEL_RETURN_IF_ERROR(exporting::CheckLabelOutput(path));
  if (exporting::IsForEachLabel(path)) {
    BCCSKEL_RETURN_IF_ERROR(WriteEachLabel(path, labels, world, stop));
    return std::string();
  }
  exporting::LabeledSkeletons all(
      {path}, labels.empty() ? std::nullopt : labels.front().second->root, world);
  for (const auto& [label, outcome] : labels) {
    if (outcome->read.has_value()) {
      BCCSKEL_ASSIGN_OR_RETURN(const SkeletonFormat format, exporting::SkeletonFormatOf(path));
      if (format == SkeletonFormat::kJson || exporting::ShowsObject(format)) {
        return absl::InvalidArgumentError(
            "JSON, pictures and pages of labels need their objects, which results that were read "
            "do not contain; compute them again with skeletonize_labels()");
      }
    }
    const Outcome& first = *labels.front().second;
    if (outcome->result.graph.placement != first.result.graph.placement) {
      return absl::InvalidArgumentError("the skeletons belong to images with different placements");
    }
    all.Add(label, outcome->voxels, outcome->result, stop);
  }
  cli::LocalTeam team(all.ShowsObjects() ? 0 : 1, stop);
  if (all.ShowsObjects()) {
    const auto object = [&](size_t n) { return labels[n].second->Object(); };
    BCCSKEL_RETURN_IF_ERROR(all.AddObjects(object, team.context()));
  }
  return exporting::WriteLabeledFile(
      path, all,
      {exporting::Counted(labels.size(), "label", "labels"), team.context(), view::DrawSubject});
}

// What the format could not hold; empty if it held everything.
std::string SaveLabels(const std::string& path, const LabelList& labels, const std::string& world,
                       const std::string& unit) {
  return RunFor(py::none(), [&](Job& job) {
    return WriteLabels(path, labels, {world, unit}, job.stop());
  });
}

}  // namespace

void AddSkeletonClass(py::module_& module) {
  const auto graph = [](const Outcome& outcome) -> const SkeletonGraph& {
    return outcome.result.graph;
  };
  module.def("save_labels", &SaveLabels);
  py::class_<Outcome, std::shared_ptr<Outcome>>(module, "Outcome")
      .def(py::pickle(&StateOf, &OutcomeOfState))
      .def("nodes", [graph](const Outcome& o) { return NodesOf(graph(o)); })
      .def("edges", [graph](const Outcome& o) { return EdgesOf(graph(o)); })
      .def("sheets", [graph](const Outcome& o) { return SheetsOf(graph(o)); })
      .def("order", &OrderOf)
      .def("node_voxels", &NodeVoxelsOf)
      .def("curve_image", [](const Outcome& o) { return Draw(o, EdgeImage::kCurves); })
      .def("branch_image", [](const Outcome& o) { return Draw(o, EdgeImage::kBranches); })
      .def("save", &Save, py::arg("path"), py::arg("title"), py::arg("world"), py::arg("unit"),
           py::arg("swc_step"))
      .def_property_readonly("certificate",
                             [](const Outcome& o) { return CertificateDict(o.result.certificate); })
      .def_property_readonly("verdict",
                             [](const Outcome& o) { return VerdictInWords(o.result.certificate); })
      .def_property_readonly("options", &OptionsDict)
      .def_property_readonly("timings",
                             [](const Outcome& o) { return TimingsDict(o.result.timings); })
      .def_property_readonly("notes",
                             [](const Outcome& o) { return WithOptionNames(NotesOn(o.result)); })
      .def_property_readonly("warnings",
                             [](const Outcome& o) { return WithOptionNames(o.warnings); })
      .def_property_readonly("voxels", &Outcome::KnownVoxels)
      .def_property_readonly("method", [](const Outcome& o) { return o.result.method; })
      .def_property_readonly("sha256", [](const Outcome& o) { return o.result.sha256; });
}

}  // namespace bccskel::python
