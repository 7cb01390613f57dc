#ifndef BCCSKEL_CLIENT_EXPORT_TUBE_H_
#define BCCSKEL_CLIENT_EXPORT_TUBE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/export/graph_context.h"
#include "client/export/picture/curve_colors.h"
#include "client/export/sampled_curve.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

struct TubeVertex {
  std::array<float, 3> position;
  std::array<float, 3> normal;
  uint32_t color;  // linear; r, g, b, a from the lowest byte on
};

// A closed surface around a curve: the center of a cap, rings of vertices, the center of the other
// cap.
struct Tube {
  std::vector<TubeVertex> vertices;
  size_t sides = 0;

  // Whether a float32 holds all coordinates.
  bool IsFinite() const;
  // Of the triangles, if the tube's vertices are numbered from `first_vertex` on. They follow from
  // the number of vertices.
  std::vector<uint32_t> Corners(uint32_t first_vertex) const;
};

// Tubes as thick as the object around a graph's edges, colored by radius or label.
class TubeMaker {
 public:
  // Vertices are relative to `center`. Graphs of very many edges have tubes with fewer sides.
  TubeMaker(const WorldPoint& center, const SkeletonGraph& graph, const GraphLabels& labels);

  size_t sides() const { return turns_.size(); }

  // Rings that twist no more than the curve, and a cap at each end; nothing around no points.
  Tube Around(const SkeletonEdge& edge, const std::vector<CurvePoint>& curve) const;

 private:
  using Vector = std::array<float, 3>;
  struct Turn {
    float cosine;
    float sine;
  };

  static std::vector<Turn> TurnsOfRing(size_t tubes);
  Vector PlaceOf(const CurvePoint& p) const;
  void AddVertex(const Vector& position, const Vector& normal, double radius, Tube& tube) const;
  void AddRing(const CurvePoint& p, const Vector& side, const Vector& other, Tube& tube) const;

  const WorldPoint center_;
  const RadiusRange range_;
  const std::array<uint32_t, kRadiusColors> colors_;
  const std::vector<uint32_t> label_colors_;  // by node; none if the graph is of one object
  const std::vector<Turn> turns_;
};

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_TUBE_H_
