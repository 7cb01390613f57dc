#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/str_replace.h"
#include "client/export/atomic_file.h"
#include "client/export/graph_formats.h"
#include "core/exec/status_macros.h"
#include "core/lattice/length_unit.h"

namespace bccskel::exporting {
namespace {

constexpr std::string_view kKind = "neuroglancer_skeletons";

std::string InfoText() {
  return "{\"@type\":\"" + std::string(kKind) +
         "\",\n\"transform\":[1,0,0,0,0,1,0,0,0,0,1,0],\n\"vertex_attributes\":[{\"id\":\"radius\","
         "\"data_type\":\"float32\",\"num_components\":1}]}\n";
}

void Append(std::string& bytes, uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(word >> shift & 0xff);
}

// Builds the file of one segment.
struct Segment {
  std::string positions;
  std::string edges;
  std::string radii;
  uint32_t vertices = 0;

  // Scaled to nanometers. Returns the vertex's number.
  uint32_t AddVertex(const WorldPoint& at, double radius, double scale) {
    for (const double along : at) {
      Append(positions, std::bit_cast<uint32_t>(static_cast<float>(along * scale)));
    }
    Append(radii, std::bit_cast<uint32_t>(static_cast<float>(radius * scale)));
    return vertices++;
  }
  void AddEdge(uint32_t from, uint32_t to) {
    Append(edges, from);
    Append(edges, to);
  }
  std::string Bytes() const {
    std::string bytes;
    Append(bytes, vertices);
    Append(bytes, static_cast<uint32_t>(edges.size() / 8));
    return bytes + positions + edges + radii;
  }
};

bool FitsFloat(const CurvePoint& point, double scale) {
  const auto fits = [scale](double value) {
    return std::abs(value * scale) <= std::numeric_limits<float>::max();
  };
  return std::ranges::all_of(point.at, fits) && fits(point.radius);
}

class Composer {
 public:
  Composer(const SkeletonGraph& graph, const PrecomputedOptions& options,
           const std::stop_token& stop)
      : graph_(graph),
        options_(options),
        stop_(stop),
        scale_(NanometersOf(options.world.unit).value_or(1)),
        vertex_of_node_(graph.nodes.size()) {}

  absl::StatusOr<std::map<uint64_t, Segment>> Run() && {
    std::vector<CurvePoint> places;  // of nodes
    for (const SkeletonNode& node : graph_.nodes) {
      places.push_back({graph_.PositionOf(node.at), graph_.RadiusOf(node.at)});
    }
    std::vector<std::vector<CurvePoint>> curves;
    for (const SkeletonEdge& edge : graph_.edges) {
      if (stop_.stop_requested()) break;
      curves.push_back(SampledCurve(graph_, edge, options_.sampling));
      // The only kind of node that a smooth curve moves.
      const bool moves = graph_.nodes[edge.source].kind == NodeKind::kLoop;
      if (moves) places[edge.source].at = curves.back().front().at;
    }
    for (size_t n = 0; n < places.size(); ++n) BCCSKEL_RETURN_IF_ERROR(AddNode(n, places[n]));
    for (size_t n = 0; n < curves.size() && !stop_.stop_requested(); ++n) {
      BCCSKEL_RETURN_IF_ERROR(AddCurve(n, curves[n]));
    }
    return std::move(segments_);
  }

 private:
  static uint64_t LabelOf(const std::vector<uint64_t>& labels, size_t row) {
    return labels.empty() ? 1 : labels[row];
  }

  absl::StatusOr<uint32_t> AddVertex(uint64_t label, const CurvePoint& point) {
    if (FitsFloat(point, scale_)) return segments_[label].AddVertex(point.at, point.radius, scale_);
    return absl::InvalidArgumentError("the skeleton's coordinates in nm do not fit a float32");
  }

  absl::Status AddNode(size_t node, const CurvePoint& place) {
    BCCSKEL_ASSIGN_OR_RETURN(vertex_of_node_[node],
                             AddVertex(LabelOf(options_.labels.of_nodes, node), place));
    return absl::OkStatus();
  }

  absl::Status AddCurve(size_t edge, const std::vector<CurvePoint>& curve) {
    const uint64_t label = LabelOf(options_.labels.of_edges, edge);
    uint32_t last = vertex_of_node_[graph_.edges[edge].source];
    for (size_t n = 1; n + 1 < curve.size(); ++n) {
      BCCSKEL_ASSIGN_OR_RETURN(const uint32_t next, AddVertex(label, curve[n]));
      segments_[label].AddEdge(last, next);
      last = next;
    }
    segments_[label].AddEdge(last, vertex_of_node_[graph_.edges[edge].target]);
    return absl::OkStatus();
  }

  const SkeletonGraph& graph_;
  const PrecomputedOptions& options_;
  const std::stop_token& stop_;
  const double scale_;
  std::vector<uint32_t> vertex_of_node_;
  std::map<uint64_t, Segment> segments_;
};

// Files that appear in a folder only when all are written: a writer may fail or be stopped.
class FolderFiles {
 public:
  explicit FolderFiles(std::string folder)
      : folder_(std::move(folder)), drafts_(folder_ + "/.partXXXXXX") {}
  FolderFiles(const FolderFiles&) = delete;
  FolderFiles& operator=(const FolderFiles&) = delete;
  ~FolderFiles() {
    for (const std::string& name : names_) ::unlink((drafts_ + "/" + name).c_str());
    ::rmdir(drafts_.c_str());
    if (is_new_) ::rmdir(folder_.c_str());  // unless it has files
  }

  // Creates the folder if missing.
  absl::Status Begin() {
    is_new_ = ::mkdir(folder_.c_str(), 0777) == 0;
    if ((is_new_ || errno == EEXIST) && ::mkdtemp(drafts_.data()) != nullptr) {
      return absl::OkStatus();
    }
    return absl::ErrnoToStatus(errno, "cannot write to the folder " + folder_);
  }

  absl::Status Add(const std::string& name, std::string_view bytes, const std::stop_token& stop) {
    names_.push_back(name);
    absl::Status status = WriteFileAtomically(drafts_ + "/" + name, bytes, stop);
    if (status.ok()) return status;
    return absl::Status(status.code(), absl::StrReplaceAll(status.message(), {{drafts_, folder_}}));
  }

  // In the order of Add(). Call it once.
  absl::Status Commit() {
    for (const std::string& name : names_) {
      if (std::rename((drafts_ + "/" + name).c_str(), (folder_ + "/" + name).c_str()) != 0) {
        return absl::ErrnoToStatus(errno, "cannot write " + folder_ + "/" + name);
      }
    }
    return absl::OkStatus();
  }

 private:
  const std::string folder_;
  std::string drafts_;  // a folder in it
  bool is_new_ = false;
  std::vector<std::string> names_;
};

std::string NoteOf(const SkeletonGraph& graph, const World& world) {
  std::string note = NoteOnUnit(world, "nanometers");
  if (!graph.sheets.empty()) {
    note += std::string(note.empty() ? "" : "; ") + std::to_string(graph.sheets.size()) +
            " points of sheets are left out";
  }
  return note;
}

std::string WithoutSlashes(std::string path) {
  while (path.size() > 1 && path.ends_with('/')) path.pop_back();
  return path;
}

// Protects the info file of a volume from being overwritten.
absl::Status CheckInfo(const std::string& info) {
  std::ifstream file(info, std::ios::binary);
  if (!file.is_open()) return absl::OkStatus();
  std::string text(1 << 16, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (text.find(kKind) != text.npos) return absl::OkStatus();
  return absl::AlreadyExistsError("cannot write " + info +
                                  ": exists and does not describe skeletons");
}

}  // namespace

absl::StatusOr<std::string> WritePrecomputed(const std::string& folder, const SkeletonGraph& graph,
                                             const PrecomputedOptions& options,
                                             const std::stop_token& stop) {
  const std::string path = WithoutSlashes(folder);
  BCCSKEL_RETURN_IF_ERROR(CheckInfo(path + "/info"));
  BCCSKEL_ASSIGN_OR_RETURN(const auto segments, Composer(graph, options, stop).Run());
  FolderFiles files(path);
  BCCSKEL_RETURN_IF_ERROR(files.Begin());
  for (const auto& [label, segment] : segments) {
    BCCSKEL_RETURN_IF_ERROR(files.Add(std::to_string(label), segment.Bytes(), stop));
  }
  BCCSKEL_RETURN_IF_ERROR(files.Add("info", InfoText(), stop));
  BCCSKEL_RETURN_IF_ERROR(files.Commit());
  return NoteOf(graph, options.world);
}

absl::Status CheckPrecomputedFolder(const std::string& folder) {
  const std::string path = WithoutSlashes(folder);
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return CheckWritable(path);
  BCCSKEL_RETURN_IF_ERROR(CheckInfo(path + "/info"));
  return CheckWritable(path + "/info");
}

}  // namespace bccskel::exporting
