#ifndef BCCSKEL_CLIENT_EXPORT_GRAPH_FORMATS_H_
#define BCCSKEL_CLIENT_EXPORT_GRAPH_FORMATS_H_

#include <optional>
#include <stop_token>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/export/graph_context.h"
#include "client/export/method_facts.h"
#include "client/export/point_forest.h"
#include "client/export/sampled_curve.h"
#include "client/export/text.h"
#include "client/export/world.h"
#include "core/skeleton/skeleton_graph.h"
#include "core/skeleton/tree_order.h"

// The writers of the formats that hold a graph alone, each in a file of its own; skeleton_file.h
// chooses between them.

namespace bccskel::exporting {

struct SwcOptions {
  CurveSampling sampling = {};
  MethodFacts facts = {};     // of the header, which states world and unit only if these do
  std::stop_token stop = {};  // ends early; the text is then incomplete
};

// SWC: `id type x y z radius parent`, one tree per component (see PointForest), from the roots of
// the order, or else from the deepest node of each component.
// Types: 1 the roots of an order of thickest nodes, 6 end, 5 junction, 0 everything else. World
// coordinates and units, rounded to a ten-thousandth of the smallest spacing.
Document WriteSwc(const SkeletonGraph& graph, const std::optional<TreeOrder>& order = std::nullopt,
                  const SwcOptions& options = {});

// VTK XML PolyData, version 1.0, ASCII. Lines are smooth curves inside the object.
// Cells:       one vertex per node without edges, then one polyline per edge.
// Point data:  radius (world units), distance (lattice units), node_kind (0 inside an edge, else
//              1 end, 2 junction, 3 loop, 4 isolated, 5 closed surface); lattice (the lattice
//              point, in world coordinates).
// Cell data:   edge_id (-1 for vertices); length, mean_radius, min_radius, max_radius (world
//              units), tortuosity (0 for closed curves); label, where labels are given; with an
//              order of trees generation and strahler (-1 for vertices and for edges that close
//              loops), along (1 where the line runs away from its root, else 0), root_distance (of
//              the end nearer to the root, world units).
// Field data:  how it was made, a string for each of the facts.
std::string VtpText(const SkeletonGraph& graph, const GraphContext& context = {});

// GraphML, one undirected graph with self loops and parallel edges.
// Nodes: kind, x, y, z, radius, component; loops and cavities where a closed surface has them.
// Edges: length, mean_radius, min_radius, max_radius, tortuosity (not of closed curves),
//         points ("x y z radius; x y z radius; ...").
// Both: label, where labels are given; a string, since GraphML's long is too short for 64 bits
//         without a sign.
// With an order of trees: of nodes root, parent and root_distance; of edges proximal, generation
//         and strahler, or closes_loop. Roots have no parent.
// Graph: how it was made, a string for each of the facts.
// World coordinates and units throughout.
std::string GraphMlText(const SkeletonGraph& graph, const GraphContext& context = {});

// Wavefront OBJ: one `l` element per edge, its smooth curve, one `p` element per isolated node.
// World coordinates; OBJ cannot hold radii. Comments hold the facts of the context.
std::string ObjText(const SkeletonGraph& graph, const GraphContext& context = {});

// CSV, a row per edge below a row of names; the names are those of skan where skan has them.
//   label                               where labels are given
//   skeleton_id                         connected component, from 0
//   branch_id                           edge of the graph, from 0
//   node_id_src, node_id_dst            nodes of the graph, from 0
//   branch_type                         0 end to end, 1 junction to end, 2 junction to junction,
//                                       3 closed curve without junction
//   branch_distance                     length of the smooth curve
//   euclidean_distance                  straight distance between the nodes
//   tortuosity                          their ratio; empty where the nodes are one place
//   mean_radius, min_radius, max_radius
//   coord_src_x .. coord_dst_z          places of the nodes
//   pruning_level                       empty for branches that are never pruned
//   generation, strahler                with an order of trees; empty where an edge closes a loop
//   world, unit                         those of the facts of the context, the same in each row
// World coordinates and units. Isolated nodes and closed surfaces have no row.
std::string BranchTableText(const SkeletonGraph& graph, const GraphContext& context = {});

// 3D Slicer's markups, schema 1.0.3: an open or closed curve per edge, named "branch N" or, with
// labels, "label L branch N", with its length and radii as measurements. Coordinates are RAS or
// LPS, as in `world`, in mm; any other is taken as LPS and in mm, which the note states.
Document WriteMarkups(const SkeletonGraph& graph, const GraphContext& context, const World& world);

// Binary glTF 2.0: a tube per edge as thick as the object, colored by radius. Nodes are named as by
// BranchName(), with the figures of the branch as extras, and are children of the node "skeleton",
// which moves them to the world: glTF's y axis, up, is the world's z, unless the world's is y as
// well. World units. The extras of "skeleton" hold the facts of the context. More than 20,000 edges
// are one mesh, of the node "branches", and a note says so. Errors: RESOURCE_EXHAUSTED for more
// than 4 GiB.
absl::StatusOr<Document> WriteGlb(const SkeletonGraph& graph, const GraphContext& context = {},
                                  const World& world = {});

struct PrecomputedOptions {
  GraphLabels labels = {};  // one segment each; without labels the only segment is 1
  World world = {};
  CurveSampling sampling = {};
};

// Neuroglancer's precomputed skeletons, unsharded: FOLDER/info, and for each segment FOLDER/ID with
// its nodes, then the points of its smooth curves, the edges between them, and the attribute
// radius. Coordinates and radii in nanometers, float32, little-endian; loops stay. Creates the
// folder if missing; keeps files of other segments.
// Returns what the format could not hold, as a sentence for the user; empty if it held everything.
// Errors: ALREADY_EXISTS if info describes anything but such skeletons; INVALID_ARGUMENT
//         (coordinates too large for a float32); those of WriteFileAtomically().
absl::StatusOr<std::string> WritePrecomputed(const std::string& folder, const SkeletonGraph& graph,
                                             const PrecomputedOptions& options = {},
                                             const std::stop_token& stop = {});

// Whether WritePrecomputed() can begin; leaves no trace. Errors: as above.
absl::Status CheckPrecomputedFolder(const std::string& folder);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_GRAPH_FORMATS_H_
